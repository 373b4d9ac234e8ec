//! A sheet of any size from a library: pieces of it, drawn at random, that fade into each other.

use super::Curtain;
use super::filling::add;
use super::library::{Library, fade_in};
use spunlaid_ground::Fault;
use spunlaid_ground::place::Inlet;
use spunlaid_ground::random::{stream, uniform};
use std::f64::consts::FRAC_PI_2;

/// Relative difference up to which two widths are the same.
const SAME: f64 = 1e-9;

/// From column to column of tiles, the part of the library by which their pieces are apart: the golden ratio spreads
/// any number of them evenly.
const APART: f64 = 0.618_033_988_749_895;

/// The filaments of a sheet, made of pieces of a library along the fibre and across.          theory.md (83h)
///
/// ```text
/// along the fibre  |‹fade›—— piece ——‹fade›|          each follows the one before, shifted and mirrored at random;
///                             |‹fade›—— piece ——‹fade›|     the variance is the same in fades and between them
/// ```
#[derive(Clone, Debug)]
pub struct Tiles<'a> {
    source: &'a Library,
    places: Vec<Inlet>,
    /// Of each filament: levels of the library with their weights.
    levels: Vec<Vec<(usize, f64)>>,
    points: usize,
    key: [u64; 2],
    /// Where the first piece begins in the library, as a part of it.
    first: f64,
    /// None of a sheet that repeats itself as the library does, which needs no fades across.
    columns: Option<Columns>,
    /// Of a piece at the points of its fade.
    fade: Vec<f32>,
}

/// Columns of tiles on the way around the sheet.
#[derive(Clone, Copy, Debug)]
struct Columns {
    count: usize,
    /// From column to column [m].
    pitch: f64,
}

/// What a tile shows of the library.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tile {
    /// First point.
    start: usize,
    /// Where its edge lies across [m].
    shift: f64,
    is_mirrored: bool,
}

impl Library {
    /// Makes a sheet.
    ///
    /// * `places` – where its filaments are fed
    /// * `around` – width of the sheet if its edges are periodic; otherwise any width that is a fade or more wider [m]
    /// * `length` – of the sheet [m]
    /// * `key` – of its random numbers: the seed of the sheet and the number of the layer
    ///
    /// # Errors
    /// If a filament hangs in a row that was not simulated.
    pub fn tiles(
        &self,
        places: Vec<Inlet>,
        around: f64,
        length: f64,
        key: [u64; 2],
    ) -> Result<Tiles<'_>, Fault> {
        let level = |place: &Inlet| {
            self.levels.around(place.y).ok_or_else(|| {
                Fault::plain(format!(
                    "a filament is {:.3} mm from the middle of the slot, where no row was simulated",
                    place.y * 1e3
                ))
            })
        };
        let levels = places.iter().map(level).collect::<Result<_, _>>()?;
        let [least, most] = self.reach();
        let points = ((length + most - least) / (self.belt_ratio * self.spacing)).ceil() as usize + 2;
        let is_equal = (around / self.turn - 1.0).abs() < SAME;
        let columns = (!is_equal).then(|| {
            let count = (around / (self.turn - self.fade_across)).ceil().max(1.0);
            Columns { count: count as usize, pitch: around / count }
        });
        let first = uniform(&mut stream([key[0], key[1], u64::MAX, u64::MAX]));
        let fade = fade_in(self.fade).collect();
        Ok(Tiles { source: self, places, levels, points, key, first, columns, fade })
    }
}

impl Tiles<'_> {
    /// A tile, from random numbers of its own. Where pieces begin is not one of them: drawn at random, a few of
    /// them would show some clouds of the library often and others never.
    fn tile(&self, row: i64, column: usize) -> Tile {
        let mut random = stream([self.key[0], self.key[1], row as u64, column as u64]);
        let mut uniform = || uniform(&mut random);
        let (points, piece) = (self.source.points, self.source.piece);
        let apart = row as f64 * piece as f64 / points as f64 + column as f64 * APART;
        Tile {
            start: ((self.first + apart).rem_euclid(1.0) * points as f64) as usize % points,
            shift: uniform() * self.source.turn,
            is_mirrored: uniform() < 0.5,
        }
    }

    /// The columns in which a filament lies, each with its place from the edge of the column [m] and with its part.
    fn columns(&self, z: f64) -> Vec<(usize, f64, f64)> {
        let Some(Columns { count, pitch }) = self.columns else { return vec![(0, z, 1.0)] };
        let turns = (z / pitch).floor();
        let column = turns.rem_euclid(count as f64) as usize;
        let at = z - turns * pitch;
        if at >= self.source.fade_across {
            return vec![(column, at, 1.0)];
        }
        let angle = FRAC_PI_2 * at / self.source.fade_across;
        vec![((column + count - 1) % count, at + pitch, libm::cos(angle)), (column, at, libm::sin(angle))]
    }
}

impl Curtain for Tiles<'_> {
    fn places(&self) -> &[Inlet] {
        &self.places
    }

    fn points(&self) -> usize {
        self.points
    }

    fn spacing(&self) -> f64 {
        self.source.spacing
    }

    fn belt_ratio(&self) -> f64 {
        self.source.belt_ratio
    }

    fn curve(&self, filament: usize, first: usize, mut into: [&mut [f32]; 2]) {
        let source = self.source;
        let place = self.places[filament];
        let around = &self.levels[filament];
        let count = into[0].len();
        for (into, mean) in into.iter_mut().zip(source.levels.mean(around)) {
            into.fill(mean as f32);
        }
        let (piece, fade) = (source.piece as i64, source.fade as i64);
        let (step, first, end) = (piece - fade, first as i64, (first + count) as i64);
        let mut values = vec![0.0_f32; count];
        // The piece before the first one ends in its fade.
        for row in (first - piece).div_euclid(step).max(-1)..=(end - 1).div_euclid(step) {
            let [from, to] = [(row * step).max(first), (row * step + piece).min(end)];
            if from >= to {
                continue;
            }
            let within = (from - row * step) as usize;
            for (column, at, part) in self.columns(place.z) {
                let tile = self.tile(row, column);
                let z = if tile.is_mirrored { tile.shift - at } else { tile.shift + at };
                let near = source.near(z, around);
                for (direction, into) in into.iter_mut().enumerate() {
                    let part = if tile.is_mirrored && direction == 1 { -part } else { part } as f32;
                    let values = &mut values[..(to - from) as usize];
                    values.fill(0.0);
                    let begin = (tile.start + within) % source.points;
                    let turn = (source.points - begin).min(values.len());
                    for (curve, weight) in &near {
                        add(&mut values[..turn], part * weight, &curve[direction][begin..]);
                        add(&mut values[turn..], part * weight, &curve[direction]);
                    }
                    self.fade(values, within);
                    let into = &mut into[(from - first) as usize..(to - first) as usize];
                    into.iter_mut().zip(values).for_each(|(sum, value)| *sum += *value);
                }
            }
        }
    }

    fn reach(&self) -> [f64; 2] {
        self.source.reach()
    }

    fn farthest(&self) -> f64 {
        let mean = |around: &Vec<(usize, f64)>| self.source.levels.mean(around)[0].abs();
        // Two pieces fade into each other along the fibre and two across: the sum of sine and cosine is √2 at
        // most, of each pair.
        self.levels.iter().map(mean).fold(0.0, f64::max) + 2.0 * self.source.farthest()
    }
}

impl Tiles<'_> {
    /// Lowers what lies in the fades of a piece.
    ///
    /// * `first` – number of the first value in the piece
    fn fade(&self, values: &mut [f32], first: usize) {
        let (piece, fade) = (self.source.piece, self.source.fade);
        for (i, value) in values.iter_mut().enumerate() {
            let at = first + i;
            if at < fade {
                *value *= self.fade[at];
            } else if at >= piece - fade {
                // The cosine of a fade is its sine from the other end.
                *value *= self.fade[piece - 1 - at];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::FlownCurves;
    use super::super::synthetic::{BELT_RATIO, Field, SPACING, row, slot};
    use super::*;

    const MEMORY: f64 = 0.9;

    fn field() -> Field {
        Field { memory: MEMORY, points: 3000, ..Field::default() }
    }

    fn whole(curtain: &dyn Curtain, filament: usize) -> [Vec<f32>; 2] {
        in_blocks(curtain, filament, curtain.points())
    }

    fn in_blocks(curtain: &dyn Curtain, filament: usize, block: usize) -> [Vec<f32>; 2] {
        let mut curve = [0, 1].map(|_| vec![0.0; curtain.points()]);
        for first in (0..curtain.points()).step_by(block) {
            let end = (first + block).min(curtain.points());
            curtain.curve(filament, first, curve.each_mut().map(|values| &mut values[first..end]));
        }
        curve
    }

    /// Mean product of two series, of which one begins later.
    fn product(a: &[f32], b: &[f32], lag: usize) -> f64 {
        let pairs = a.iter().zip(&b[lag..]);
        pairs.map(|(a, b)| f64::from(*a) * f64::from(*b)).sum::<f64>() / (a.len() - lag) as f64
    }

    /// A sheet three times as wide as the library and six times as long has the variance, the distribution
    /// and the correlations of the field.
    #[test]
    fn stat_a_sheet_of_tiles_has_the_moments_of_its_library() {
        let field = field();
        let (simulated, around) = (field.simulated(row(field.turn, 64)), 0.41);
        let library = Library::new(&simulated, 2).unwrap();
        let places = row(around, 82);
        let length = 6.0 * field.points as f64 * SPACING * BELT_RATIO;
        let tiles = library.tiles(places, around, length, [3, 0]).unwrap();
        let curves: Vec<_> = (0..82).map(|filament| whole(&tiles, filament)).collect();
        let of_flown = |d: usize| {
            (0..64).map(|i| product(simulated.deviations(i, d), simulated.deviations(i, d), 0)).sum::<f64>()
                / 64.0
        };
        for d in 0..2 {
            let all: Vec<f64> = curves.iter().flat_map(|curve| &curve[d]).map(|x| f64::from(*x)).collect();
            let moment = |power: i32| all.iter().map(|x| x.powi(power)).sum::<f64>() / all.len() as f64;
            let variance = moment(2);
            assert!((variance / of_flown(d) - 1.0).abs() < 0.03, "{variance} {}", of_flown(d));
            let kurtosis = moment(4) / (variance * variance);
            // All of the library is shown, with its own chance; fades make its values more normal.
            let fourth =
                (0..64).flat_map(|i| simulated.deviations(i, d)).map(|x| f64::from(*x).powi(4)).sum::<f64>();
            let of_library = fourth / (64 * field.points) as f64 / of_flown(d).powi(2);
            assert!((kurtosis - of_library).abs() < 0.1, "{kurtosis} {of_library}");
            // Of a normal distribution 15.87 % lie beyond the standard deviation.
            let beyond = all.iter().filter(|x| **x > variance.sqrt()).count() as f64 / all.len() as f64;
            assert!((beyond - 0.1587).abs() < 0.006, "{beyond}");
            // Along: a fade takes a little of what is common at both of its ends.
            for lag in [1, 3, 7] {
                let found = curves.iter().map(|curve| product(&curve[d], &curve[d], lag)).sum::<f64>() / 82.0;
                let expected = MEMORY.powi(lag as i32);
                assert!((found / variance - expected).abs() < 0.03, "{lag}: {} {expected}", found / variance);
            }
            // Across, at 5 and 10 mm, also where columns of tiles fade into each other.
            for step in [1, 2] {
                let pairs = (0..82).map(|i| product(&curves[i][d], &curves[(i + step) % 82][d], 0));
                let found = pairs.sum::<f64>() / 82.0 / variance;
                let expected = (-0.5 * (step as f64 * 5e-3 / field.scales[0]).powi(2)).exp();
                assert!((found - expected).abs() < 0.03, "{step}: {found} {expected}");
            }
        }
    }

    /// Points in fades vary as much as those between them.
    #[test]
    fn stat_a_fade_keeps_the_variance() {
        let field = field();
        let simulated = field.simulated(row(field.turn, 64));
        let library = Library::new(&simulated, 2).unwrap();
        let length = 12.0 * field.points as f64 * SPACING * BELT_RATIO;
        let tiles = library.tiles(row(0.3, 50), 0.3, length, [1, 0]).unwrap();
        let mut squares = [[0.0, 0.0]; 2];
        for filament in 0..50 {
            for (i, x) in whole(&tiles, filament)[0].iter().enumerate() {
                let is_faded = i % (library.piece - library.fade) < library.fade;
                let [sum, count] = &mut squares[usize::from(is_faded)];
                *sum += f64::from(*x).powi(2);
                *count += 1.0;
            }
        }
        let [between, within] = squares.map(|[sum, count]| sum / count);
        assert!((within / between - 1.0).abs() < 0.06, "{within} {between}");
    }

    /// Pieces that began anywhere within the library showed its ends half as often as its middle, and any part of
    /// it at random.
    #[test]
    fn invariant_each_part_of_a_library_is_shown_as_often() {
        let field = Field { points: 300, ..field() };
        let places = row(field.turn, 64);
        let mut curves = field.curves(&places);
        let stronger = curves.iter_mut().flat_map(|curve| curve.iter_mut().take(75));
        stronger.for_each(|point| *point = point.map(|x| 3.0 * x));
        let simulated = field.flown_of(places, &curves);
        let library = Library::new(&simulated, 1).unwrap();
        let length = 12.0 * field.points as f64 * SPACING * BELT_RATIO;
        let tiles = library.tiles(row(0.41, 41), 0.41, length, [3, 0]).unwrap();
        let square = |curve: &[f32]| product(curve, curve, 0);
        let found = (0..41).map(|i| square(&whole(&tiles, i)[0])).sum::<f64>() / 41.0;
        let expected = (0..64).map(|i| square(simulated.deviations(i, 0))).sum::<f64>() / 64.0;
        // The fade from the end to the begin takes a fifth of what is stronger from 14 of its 75 points.
        assert!((found / expected - 1.0).abs() < 0.08, "{found} {expected}");
    }

    /// What is true of a curtain and of its mirror image is true of its tiles: here, the deviation across is
    /// the slope of that along the machine.
    #[test]
    fn invariant_what_holds_in_a_curtain_and_in_its_mirror_image_holds_in_tiles() {
        let field = field();
        let [sine, cosine] = [0, 1].map(|seed| Field { seed, ..field }.curves(&row(field.turn, 1)).remove(0));
        let wave = 4.0 * std::f64::consts::TAU / field.turn;
        let curve = |place: &Inlet| -> Vec<[f64; 2]> {
            let (sin, cos) = (wave * place.z).sin_cos();
            let point = |(a, b): (&[f64; 2], &[f64; 2])| [a[0] * sin + b[0] * cos, a[0] * cos - b[0] * sin];
            sine.iter().zip(&cosine).map(point).collect()
        };
        let places = row(field.turn, 64);
        let curves: Vec<_> = places.iter().map(curve).collect();
        let library = Library::new(&field.flown_of(places, &curves), 1).unwrap();
        let apart = 1e-3;
        let around = [0.05, 0.05 + apart].map(|z| Inlet { y: 0.0, z });
        let tiles = library.tiles(around.to_vec(), field.turn, 5.0, [9, 0]).unwrap();
        let [one, other] = [0, 1].map(|filament| whole(&tiles, filament));
        let (mut off, mut squares) = (0.0, 0.0);
        for i in 0..tiles.points() {
            let slope = f64::from(other[0][i] - one[0][i]) / apart / wave;
            let across = 0.5 * f64::from(other[1][i] + one[1][i]);
            off += (slope - across).powi(2);
            squares += across.powi(2);
        }
        assert!(off / squares < 0.01, "{}", off / squares);
    }

    #[test]
    fn identical_bits_in_blocks_of_any_size_and_after_a_turn() {
        let field = field();
        let simulated = field.simulated(slot(field.turn, 64, 10e-3));
        let library = Library::new(&simulated, 3).unwrap();
        let around = 0.5;
        let place = Inlet { y: 1.3e-3, z: 0.25 };
        let places = vec![place, Inlet { z: place.z + around, ..place }];
        let tiles = |key| library.tiles(places.clone(), around, 0.5, key).unwrap();
        let curve = whole(&tiles([1, 0]), 0);
        for block in [1, 37, 1024] {
            assert!(in_blocks(&tiles([1, 0]), 0, block) == curve, "{block}");
        }
        for (a, b) in curve.concat().iter().zip(whole(&tiles([1, 0]), 1).concat()) {
            assert!((a - b).abs() < 1e-7, "{a} {b}");
        }
        assert!(whole(&tiles([2, 0]), 0) != curve && whole(&tiles([1, 1]), 0) != curve);
    }

    /// Between the levels of a slot and the columns of the lattice the library is the filling, in deep slots too.
    #[test]
    fn limit_a_lattice_gives_what_a_filling_gives() {
        for (scales, depth) in [([8e-3, 8e-3], 12e-3), ([8e-3, 4e-3], 36e-3)] {
            lattice_is_filling(Field { scales, points: 300, ..field() }, depth);
        }
    }

    fn lattice_is_filling(field: Field, depth: f64) {
        let simulated = field.simulated(slot(field.turn, 300, depth));
        let library = Library::new(&simulated, 2).unwrap();
        let wanted = slot(field.turn, 31, 0.9 * depth);
        let filled = simulated.fill(wanted.clone(), 2).compute(2);
        let (mut off, mut squares) = (0.0, 0.0);
        for (place, curve) in wanted.iter().zip(&filled) {
            let around = library.levels.around(place.y).unwrap();
            let near = library.near(place.z, &around);
            let mean = library.levels.mean(&around);
            for d in 0..2 {
                // The end of the library fades into its first points.
                for (i, expected) in
                    curve[d].iter().enumerate().take(library.points).skip(library.fade).step_by(7)
                {
                    let sum: f32 = near.iter().map(|(curve, weight)| weight * curve[d][i]).sum();
                    off += (f64::from(sum - expected) + mean[d]).powi(2);
                    squares += f64::from(*expected).powi(2);
                }
            }
        }
        assert!(off / squares < 2e-3, "{}", off / squares);
    }

    #[test]
    fn rejects_libraries_whose_pieces_would_know_each_other() {
        let field = field();
        let message = |simulated: &FlownCurves| Library::new(simulated, 1).unwrap_err().to_string();
        let curves = field.curves(&row(field.turn, 32));
        let cut = FlownCurves::new(row(field.turn, 32), None, SPACING, BELT_RATIO, &curves).unwrap();
        assert!(message(&cut).contains("web.edges = \"periodic\""), "{}", message(&cut));
        let short = Field { points: 60, ..field }.simulated(row(field.turn, 32));
        assert!(message(&short).contains("of fibre or more"), "{}", message(&short));
        let narrow = Field { turn: 0.04, ..field }.simulated(row(0.04, 20));
        assert!(message(&narrow).contains("simulate a width of"), "{}", message(&narrow));
        let simulated = field.simulated(row(field.turn, 32));
        let library = Library::new(&simulated, 1).unwrap();
        let elsewhere = vec![Inlet { y: 5e-3, z: 0.0 }];
        let fault = library.tiles(elsewhere, 0.3, 0.5, [0, 0]).unwrap_err().to_string();
        assert!(fault.contains("5.000 mm"), "{fault}");
    }
}
