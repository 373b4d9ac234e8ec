//! Pieces of the maps in folders of results: of equal size, in equal pixels, for webs that are seen beside each other.

use super::map::{array_head, light_table_of};
use serde_json::Value as Json;
use spunlaid_web::Map;
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Largest side of a picture [px].
const PICTURE: f64 = 1000.0;
/// Most cells of a piece.
const MOST_CELLS: f64 = 16e6;
/// Quanta of a pixel of mean weight: fine enough for any web, and a pixel may be four thousand times as heavy.
pub(crate) const MEAN: f64 = (1u32 << 20) as f64;
/// So much of a pixel may be missing by rounding.
const ROUNDING: f64 = 1e-6;

/// The map of a web, in `map.npy` of its folder.
#[derive(Clone, Debug, PartialEq)]
pub struct MapFile {
    path: PathBuf,
    /// Cells in cross and in machine direction.
    cells: [usize; 2],
    /// Side of a cell [m].
    pub cell: f64,
    /// Widths of the strips at both edges that count as no web [m].
    margins: [f64; 2],
}

impl MapFile {
    /// The map of a folder.
    ///
    /// * `web` – what `summary.json` says of the web
    ///
    /// # Errors
    /// If the folder has no such map: why, in words.
    pub fn new(folder: &Path, web: &Json) -> Result<Self, String> {
        let count = |i: usize| usize::try_from(web["cells"][i].as_u64()?).ok().filter(|count| *count > 0);
        let margin = |i: usize| web["edges"]["margins_m"][i].as_f64().unwrap_or(0.0);
        let cell = web["cell_m"].as_f64().filter(|cell| *cell > 0.0);
        let (Some(rows), Some(columns), Some(cell)) = (count(0), count(1), cell) else {
            return Err(
                "its summary.json does not say how many cells the map has, and how large they are".to_owned()
            );
        };
        let path = folder.join("map.npy");
        if !path.is_file() {
            return Err("there is no map.npy".to_owned());
        }
        Ok(Self { path, cells: [columns, rows], cell, margins: [0, 1].map(margin) })
    }

    /// Sides of the web in cross and in machine direction, without the strips at its edges [m].
    pub fn sides(&self) -> [f64; 2] {
        let [width, length] = self.cells.map(|count| count as f64 * self.cell);
        [width - self.margins[0] - self.margins[1], length]
    }

    /// The middle of the web in square pixels that are no smaller than its cells. What lies in a pixel in
    /// part counts in part. The mass is relative to the mean of the piece.
    ///
    /// * `sides` – of the piece, in cross and in machine direction, no larger than [`sides`](Self::sides) [m]
    /// * `pixel` – side of a pixel [m]
    ///
    /// # Errors
    /// If the file cannot be read, or is not the map that the summary reports of: why, in words.
    pub fn piece(&self, sides: [f64; 2], pixel: f64) -> Result<Map, String> {
        let [columns, rows] = sides.map(|side| (side / pixel + ROUNDING) as usize);
        let unreadable = |error: std::io::Error| format!("its map.npy cannot be read: {error}");
        if columns * rows == 0 {
            return Err("it is smaller than a pixel".to_owned());
        }
        let mut file = BufReader::with_capacity(1 << 20, File::open(&self.path).map_err(unreadable)?);
        let head = array_head(self.cells);
        let mut found = vec![0; head.len()];
        file.read_exact(&mut found).map_err(unreadable)?;
        if found != head {
            let [columns, rows] = self.cells;
            return Err(format!(
                "its map.npy is not the map of {columns} × {rows} cells of its summary.json"
            ));
        }
        let middle = self.sides().map(|side| 0.5 * side);
        let from = |axis: usize, count: usize| middle[axis] - 0.5 * count as f64 * pixel;
        let across =
            Lattice { cell: self.cell, from: self.margins[0] + from(0, columns), pixel, count: columns };
        let along = Lattice { cell: self.cell, from: from(1, rows), pixel, count: rows };
        let first = (along.from.max(0.0) / self.cell) as usize;
        let last = (((along.from + rows as f64 * pixel) / self.cell).ceil() as usize).min(self.cells[1]);
        let mut row = vec![0; 4 * self.cells[0]];
        file.seek(SeekFrom::Current((first * row.len()) as i64)).map_err(unreadable)?;
        let mut sums = vec![0.0; columns * rows];
        let mut of_row = vec![0.0; columns];
        for number in first..last {
            file.read_exact(&mut row).map_err(unreadable)?;
            of_row.fill(0.0);
            for (column, bytes) in row.as_chunks().0.iter().enumerate() {
                let weight = f64::from(f32::from_le_bytes(*bytes));
                across.give(column, |into, share| of_row[into] += share * weight);
            }
            along.give(number, |into, share| {
                let into = &mut sums[into * columns..][..columns];
                into.iter_mut().zip(&of_row).for_each(|(sum, weight)| *sum += share * weight);
            });
        }
        let mean = sums.iter().sum::<f64>() / sums.len() as f64;
        if !(mean.is_finite() && mean > 0.0) {
            return Err("its map.npy holds no fibre there".to_owned());
        }
        let cells = sums.iter().map(|sum| (sum / mean * MEAN).round() as u32).collect();
        Ok(Map { columns, rows, cell: pixel, quantum: 1.0, closed: [false; 2], cells })
    }

    /// The largest [`piece`](Self::piece) that is looked at.
    ///
    /// # Errors
    /// The errors of [`piece`](Self::piece).
    pub fn whole(&self, pixel: f64) -> Result<Map, String> {
        let [width, length] = self.sides();
        self.piece([width, length.min(MOST_CELLS * pixel * pixel / width)], pixel)
    }
}

/// Cells of one size along a line, and pixels of another that begin somewhere.
struct Lattice {
    cell: f64,
    from: f64,
    pixel: f64,
    count: usize,
}

impl Lattice {
    /// Passes on the pixels in which a cell lies, with the part of a pixel that it covers.
    fn give(&self, cell: usize, mut take: impl FnMut(usize, f64)) {
        let place = |cell: usize| (cell as f64 * self.cell - self.from) / self.pixel;
        let begin = place(cell).max(0.0);
        let end = place(cell + 1).min(self.count as f64);
        let mut at = begin as usize;
        while at < self.count && (at as f64) < end {
            let share = end.min((at + 1) as f64) - begin.max(at as f64);
            if share > 0.0 {
                take(at, share);
            }
            at += 1;
        }
    }
}

/// Pictures of equal pieces of several webs, in equal pixels and equal shades.
#[derive(Clone, Debug)]
pub struct Pictures {
    /// Sides of each piece in cross and in machine direction [m].
    pub sides: [f64; 2],
    /// Side of a pixel [m].
    pub pixel: f64,
    /// By how much of the mean white is lighter and black is heavier than it.
    pub contrast: f64,
    /// The pictures as PNG, in the order of the webs.
    pub files: Vec<Vec<u8>>,
}

impl Pictures {
    /// The middle of each web, as large as the smallest of them allows.
    ///
    /// # Errors
    /// If a map cannot be read, or a web is too small: why, in words, and whose it is.
    pub fn new(maps: &[(&str, &MapFile)]) -> Result<Self, String> {
        let smallest =
            |axis: usize| maps.iter().map(|(_, map)| map.sides()[axis]).fold(f64::INFINITY, f64::min);
        let sides = [0, 1].map(smallest);
        let coarsest = maps.iter().map(|(_, map)| map.cell).fold(0.0, f64::max);
        let pixel = coarsest.max(sides[0].max(sides[1]) / PICTURE);
        let piece = |(name, map): &(&str, &MapFile)| {
            map.piece(sides, pixel).map_err(|reason| format!("{name}: {reason}"))
        };
        let pieces: Vec<Map> = maps.iter().map(piece).collect::<Result<_, _>>()?;
        let deviation = pieces.iter().map(deviation).fold(f64::MIN_POSITIVE, f64::max);
        let files = pieces.iter().map(|piece| light_table_of(piece, deviation)).collect::<Result<_, _>>()?;
        let sides =
            pieces.first().map_or(sides, |piece| [piece.columns, piece.rows].map(|n| n as f64 * pixel));
        Ok(Self { sides, pixel, contrast: 3.0 * deviation, files })
    }
}

/// Standard deviation of the basis weight over its mean.
fn deviation(map: &Map) -> f64 {
    let squares = map.cells.iter().map(|cell| (f64::from(*cell) / MEAN - 1.0).powi(2));
    (squares.sum::<f64>() / map.cells.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reports::web::files::map::array;
    use serde_json::json;

    /// A map of whole numbers in a folder of its own.
    fn map_file(columns: usize, rows: usize, margins: [f64; 2]) -> (tempfile::TempDir, MapFile, Vec<f64>) {
        let cells: Vec<u32> = (0..columns * rows).map(|i| 3 + (i * i % 7) as u32).collect();
        let map = Map { columns, rows, cell: 0.5, quantum: 0.25, closed: [true; 2], cells: cells.clone() };
        let folder = tempfile::tempdir().unwrap();
        array(&map, File::create(folder.path().join("map.npy")).unwrap()).unwrap();
        let web = json!({ "cells": [rows, columns], "cell_m": 0.5, "edges": { "margins_m": margins } });
        let file = MapFile::new(folder.path(), &web).unwrap();
        (folder, file, cells.into_iter().map(f64::from).collect())
    }

    #[test]
    fn a_piece_in_its_own_cells_is_the_middle_of_the_map() {
        let (_folder, file, cells) = map_file(12, 9, [1.0, 0.5]);
        assert_eq!(file.sides(), [4.5, 4.5]);
        let piece = file.piece([3.5, 2.5], 0.5).unwrap();
        assert_eq!([piece.columns, piece.rows], [7, 5]);
        // Two columns of the margin, one of the nine between the margins, and two rows come before it.
        let of_map: Vec<f64> = (0..35).map(|i| cells[(2 + i / 7) * 12 + 3 + i % 7]).collect();
        let mean = of_map.iter().sum::<f64>() / 35.0;
        for (found, wanted) in piece.cells.iter().zip(of_map) {
            assert!((f64::from(*found) / MEAN - wanted / mean).abs() < 1e-6, "{found} {wanted}");
        }
    }

    #[test]
    fn pixels_share_the_cells_between_them_and_keep_the_mass() {
        // Pixels of one and a half cells: each third column is shared by halves.
        let (_folder, file, cells) = map_file(6, 6, [0.0; 2]);
        let piece = file.whole(0.75).unwrap();
        assert_eq!([piece.columns, piece.rows], [4, 4]);
        let at = |row: usize, column: usize| cells[row * 6 + column];
        let corner = at(0, 0) + 0.5 * (at(0, 1) + at(1, 0)) + 0.25 * at(1, 1);
        let mean = cells.iter().sum::<f64>() / 16.0;
        assert!((f64::from(piece.cells[0]) / MEAN - corner / mean).abs() < 1e-6, "{piece:?}");
        let total = piece.total() as f64 / MEAN;
        assert!((total - 16.0).abs() < 1e-4, "{total}");
    }

    #[test]
    fn rejects_a_map_that_is_missing_or_another_one() {
        let (folder, file, _) = map_file(6, 6, [0.0; 2]);
        let other = MapFile { cells: [6, 7], ..file.clone() };
        assert!(other.whole(0.5).unwrap_err().contains("is not the map of 6 × 7 cells"));
        std::fs::write(folder.path().join("map.npy"), array_head([6, 6])).unwrap();
        assert!(file.whole(0.5).unwrap_err().contains("its map.npy cannot be read"));
        assert!(MapFile::new(folder.path(), &json!({})).unwrap_err().contains("summary.json"));
        std::fs::remove_file(folder.path().join("map.npy")).unwrap();
        let web = json!({ "cells": [6, 6], "cell_m": 0.5 });
        assert_eq!(MapFile::new(folder.path(), &web).unwrap_err(), "there is no map.npy");
    }

    #[test]
    fn pictures_of_different_webs_have_one_scale_and_one_shade() {
        let (_one, fine, _) = map_file(40, 60, [0.0; 2]);
        let (_other, coarse, _) = map_file(16, 12, [0.0; 2]);
        let coarse = MapFile { cell: 1.0, ..coarse };
        let pictures = Pictures::new(&[("fine", &fine), ("coarse", &coarse)]).unwrap();
        assert_eq!((pictures.sides, pictures.pixel), ([16.0, 12.0], 1.0));
        let sizes = pictures.files.iter().map(|file| {
            let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
            let mut levels = vec![0; 16 * 12];
            reader.next_frame(&mut levels).unwrap();
            (reader.info().size(), levels)
        });
        let pictures: Vec<((u32, u32), Vec<u8>)> = sizes.collect();
        assert!(pictures.iter().all(|(size, _)| *size == (16, 12)));
        // The means of four cells scatter less, and so do their shades.
        let spread = |levels: &[u8]| levels.iter().max().unwrap() - levels.iter().min().unwrap();
        assert!(spread(&pictures[0].1) < spread(&pictures[1].1), "{pictures:?}");
    }
}
