//! The cells of an unstructured grid, from VTK’s lists to [`Cells`].

use crate::error::{FieldFault, FileError, FileFault, FilePlace};
use crate::field::{Cells, Shape};

/// The lists.
#[derive(Default)]
pub(super) struct Listed {
    /// The type of each cell.
    pub(super) types: Vec<i64>,
    /// The points of all cells, one cell after the other.
    pub(super) connectivity: Vec<i64>,
    /// Where those of each cell end.
    pub(super) ends: Vec<i64>,
    pub(super) polyhedra: Polyhedra,
}

/// Where the faces of polyhedra are.
#[derive(Default)]
pub(super) enum Polyhedra {
    /// In the place of their points: the number of faces, then of each face the number of points and they.
    #[default]
    Inline,
    /// The same in a list of its own, and where it ends for each cell; −1 where there is none.
    Stream { faces: Vec<i64>, ends: Vec<i64> },
    /// The points of all faces, where those of each face end, the faces of all cells, where those of each cell
    /// end.
    Table { points: Vec<i64>, ends: Vec<i64>, faces: Vec<i64>, cell_ends: Vec<i64> },
}

/// Cells with an inside.
#[derive(Default)]
pub(super) struct Solid {
    pub(super) cells: Cells,
    /// The place of each in the lists.
    pub(super) places: Vec<usize>,
    /// Vertices, lines and faces that were left out.
    pub(super) flat: u64,
    /// Cells of which only the corners are taken.
    pub(super) higher_order: u64,
}

/// What VTK’s types of cells are here.
enum Kind {
    Flat,
    Voxel,
    Linear(Shape),
    /// The corners come before the other points.
    HigherOrder(Shape),
    Polyhedron,
}

fn kind(number: i64) -> Option<Kind> {
    Some(match number {
        0..=9 | 21..=23 | 28 | 30 | 34..=36 | 68..=70 | 75..=77 => Kind::Flat,
        10 => Kind::Linear(Shape::Tetrahedron),
        11 => Kind::Voxel,
        12 => Kind::Linear(Shape::Hexahedron),
        13 => Kind::Linear(Shape::Wedge),
        14 => Kind::Linear(Shape::Pyramid),
        15 => Kind::Linear(Shape::PentagonalPrism),
        16 => Kind::Linear(Shape::HexagonalPrism),
        24 | 71 | 78 => Kind::HigherOrder(Shape::Tetrahedron),
        25 | 29 | 33 | 72 | 79 => Kind::HigherOrder(Shape::Hexahedron),
        26 | 31 | 32 | 73 | 80 => Kind::HigherOrder(Shape::Wedge),
        27 | 37 | 74 | 81 => Kind::HigherOrder(Shape::Pyramid),
        42 => Kind::Polyhedron,
        _ => return None,
    })
}

impl Listed {
    /// The cells with an inside.
    ///
    /// * `points` – how many there are
    pub(super) fn solid(&self, points: usize) -> Result<Solid, FileError> {
        if self.ends.len() != self.types.len() {
            let fault =
                FieldFault::Count { found: self.ends.len(), wanted: self.types.len(), of: "ends of cells" };
            return Err(fault.into());
        }
        let mut solid = Solid::default();
        for place in 0..self.types.len() {
            let added = self.add(place, points, &mut solid);
            added.map_err(|error| error.at(FilePlace::Cell(place as u64 + 1)))?;
        }
        Ok(solid)
    }

    fn add(&self, place: usize, points: usize, solid: &mut Solid) -> Result<(), FileError> {
        let number = self.types[place];
        let own = part(&self.connectivity, &self.ends, place)?;
        let corners =
            |of: &[i64]| of.iter().map(|point| checked(*point, points)).collect::<Result<Vec<u32>, _>>();
        match kind(number).ok_or(FieldFault::CellType { kind: number })? {
            Kind::Flat => {
                solid.flat += 1;
                return Ok(());
            }
            Kind::Linear(shape) => solid.cells.push(shape, &corners(own)?)?,
            Kind::Voxel => {
                let mut corners = corners(own)?;
                if corners.len() == Shape::Hexahedron.corners() {
                    // Its points go in rows, not around.
                    corners.swap(2, 3);
                    corners.swap(6, 7);
                }
                solid.cells.push(Shape::Hexahedron, &corners)?;
            }
            Kind::HigherOrder(shape) => {
                let taken = own.len().min(shape.corners());
                solid.cells.push(shape, &corners(&own[..taken])?)?;
                solid.higher_order += 1;
            }
            Kind::Polyhedron => {
                let faces = self.faces(place, own)?;
                let faces: Vec<Vec<u32>> = faces.into_iter().map(corners).collect::<Result<_, _>>()?;
                solid.cells.push_polyhedron(faces.iter().map(Vec::as_slice));
            }
        }
        solid.places.push(place);
        Ok(())
    }

    /// The faces of a polyhedron.
    ///
    /// * `own` – its entries in the connectivity
    fn faces<'a>(&'a self, place: usize, own: &'a [i64]) -> Result<Vec<&'a [i64]>, FileFault> {
        match &self.polyhedra {
            Polyhedra::Inline => stream(own),
            Polyhedra::Stream { faces, ends } => {
                let start =
                    ends[..place.min(ends.len())].iter().rev().find(|end| **end >= 0).copied().unwrap_or(0);
                let end = ends.get(place).copied().unwrap_or(-1);
                stream(between(faces, start, end)?)
            }
            Polyhedra::Table { points, ends, faces, cell_ends } => {
                let own = part(faces, cell_ends, place)?;
                let face = |face: &i64| part(points, ends, usize::try_from(*face).unwrap_or(usize::MAX));
                own.iter().map(face).collect()
            }
        }
    }
}

/// From the number of faces, and of each face the number of points and they, to the faces.
fn stream(entries: &[i64]) -> Result<Vec<&[i64]>, FileFault> {
    const WANTED: FileFault = FileFault::CutOff { wanted: "the faces of a polyhedron" };
    let (count, mut rest) = entries.split_first().ok_or(WANTED)?;
    let mut faces = Vec::new();
    for _ in 0..*count {
        let (length, after) = rest.split_first().ok_or(WANTED)?;
        let length = usize::try_from(*length).map_err(|_| WANTED)?;
        let (face, after) = after.split_at_checked(length).ok_or(WANTED)?;
        faces.push(face);
        rest = after;
    }
    Ok(faces)
}

/// The part of a list that belongs to one of several things, by where their parts end.
fn part<'a>(list: &'a [i64], ends: &[i64], place: usize) -> Result<&'a [i64], FileFault> {
    let end = ends.get(place).copied().ok_or(FileFault::CutOff { wanted: "where each cell or face ends" })?;
    let start = if place == 0 { 0 } else { ends[place - 1] };
    between(list, start, end)
}

fn between(list: &[i64], start: i64, end: i64) -> Result<&[i64], FileFault> {
    let range = usize::try_from(start).ok().zip(usize::try_from(end).ok());
    match range.and_then(|(start, end)| list.get(start..end)) {
        Some(part) => Ok(part),
        None if end < start => Err(FileFault::NotIncreasing { before: start as f64, after: end as f64 }),
        None => Err(FieldFault::Count {
            found: list.len(),
            wanted: usize::try_from(end).unwrap_or(usize::MAX),
            of: "entries in its list",
        }
        .into()),
    }
}

fn checked(point: i64, points: usize) -> Result<u32, FileFault> {
    let known = u32::try_from(point).ok().filter(|number| (*number as usize) < points);
    known.ok_or_else(|| FieldFault::NoPoint { point, points }.into())
}
