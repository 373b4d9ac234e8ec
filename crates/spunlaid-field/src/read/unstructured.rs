//! The cells of an unstructured grid, from VTK’s lists to [`Cells`].

use crate::{Cells, Shape, fault};
use spunlaid_ground::{Fault, FileError, Position};

/// The lists.
#[derive(Default)]
pub(super) struct MeshLists {
    /// The type of each cell.
    pub(super) types: Vec<i64>,
    /// The points of all cells, one cell after the other.
    pub(super) connectivity: Vec<i64>,
    /// Where the points of each cell end in that list.
    pub(super) ends: Vec<i64>,
    pub(super) polyhedra: Polyhedra,
}

/// Where a file keeps the faces of polyhedra.
#[derive(Default)]
pub(super) enum Polyhedra {
    /// In the connectivity: the number of faces, then for each face the number of its points and the points.
    #[default]
    Inline,
    /// The same in a separate list, with the end for each cell; −1 for a cell that is no polyhedron.
    Stream { faces: Vec<i64>, ends: Vec<i64> },
    /// Four lists: the points of all faces, the end of each face, the faces of all cells, the end of each cell.
    Table { points: Vec<i64>, ends: Vec<i64>, faces: Vec<i64>, cell_ends: Vec<i64> },
}

/// The cells that have a volume or, if none has, the faces of a plane flow, each as a cell with this face only.
#[derive(Default)]
pub(super) struct MeshParts {
    pub(super) cells: Cells,
    /// The index of each in the file's list.
    pub(super) places: Vec<usize>,
    /// Whether they are faces.
    pub(super) are_faces: bool,
    /// Number of vertices, lines and faces that were left out.
    pub(super) flat: u64,
    /// Number of cells of which only the corners are used.
    pub(super) higher_order: u64,
}

/// How VTK's types of cells are treated.
enum CellType {
    /// A point, a line, or a face of no use.
    Flat,
    /// A face whose corners stand in order around it.
    Polygon,
    Pixel,
    /// A strip of triangles, each of which shares two points with the one before.
    Strip,
    /// Its corners, of this number, come before the other points.
    HigherOrderFace(usize),
    Voxel,
    Linear(Shape),
    /// The corners come before the other points.
    HigherOrder(Shape),
    Polyhedron,
}

fn kind(number: i64) -> Option<CellType> {
    Some(match number {
        0..=4 | 21 | 35 | 68 | 75 => CellType::Flat,
        5 | 7 | 9 => CellType::Polygon,
        6 => CellType::Strip,
        8 => CellType::Pixel,
        22 | 34 | 69 | 76 => CellType::HigherOrderFace(3),
        23 | 28 | 30 | 70 | 77 => CellType::HigherOrderFace(4),
        // A quadratic polygon has a point on each of its edges.
        36 => CellType::HigherOrderFace(0),
        10 => CellType::Linear(Shape::Tetrahedron),
        11 => CellType::Voxel,
        12 => CellType::Linear(Shape::Hexahedron),
        13 => CellType::Linear(Shape::Wedge),
        14 => CellType::Linear(Shape::Pyramid),
        15 => CellType::Linear(Shape::PentagonalPrism),
        16 => CellType::Linear(Shape::HexagonalPrism),
        24 | 71 | 78 => CellType::HigherOrder(Shape::Tetrahedron),
        25 | 29 | 33 | 72 | 79 => CellType::HigherOrder(Shape::Hexahedron),
        26 | 31 | 32 | 73 | 80 => CellType::HigherOrder(Shape::Wedge),
        27 | 37 | 74 | 81 => CellType::HigherOrder(Shape::Pyramid),
        42 => CellType::Polyhedron,
        _ => return None,
    })
}

impl MeshLists {
    /// The cells that have a volume, or the faces if none has.
    ///
    /// * `points` – number of points
    pub(super) fn parts(&self, points: usize) -> Result<MeshParts, FileError> {
        if self.ends.len() != self.types.len() {
            let fault = fault::count(self.ends.len(), self.types.len(), "ends of cells");
            return Err(fault.into());
        }
        let all = |add: &dyn Fn(&Self, usize, &mut MeshParts) -> Result<(), FileError>| {
            let mut parts = MeshParts::default();
            for place in 0..self.types.len() {
                let added = add(self, place, &mut parts);
                added.map_err(|error| error.at(Position::Cell(place as u64 + 1)))?;
            }
            Ok::<_, FileError>(parts)
        };
        let solid = all(&|lists, place, parts| lists.add_solid(place, points, parts))?;
        if !solid.cells.is_empty() {
            return Ok(solid);
        }
        let faces = all(&|lists, place, parts| lists.add_face(place, points, parts))?;
        Ok(MeshParts { are_faces: !faces.cells.is_empty(), flat: solid.flat, ..faces })
    }

    fn kind(&self, place: usize) -> Result<CellType, Fault> {
        let number = self.types[place];
        kind(number).ok_or_else(|| {
            Fault::new(
                format!("is of VTK type {number}, which is not supported"),
                "write tetrahedra, voxels, hexahedra, wedges, pyramids or polyhedra",
            )
        })
    }

    fn add_face(&self, place: usize, points: usize, parts: &mut MeshParts) -> Result<(), FileError> {
        let own = part(&self.connectivity, &self.ends, place)?;
        let mut face: Vec<u32> = own.iter().map(|point| checked(*point, points)).collect::<Result<_, _>>()?;
        let mut push = |face: &[u32]| {
            if face.len() > 2 {
                parts.cells.push_polyhedron([face]);
                parts.places.push(place);
            }
        };
        match self.kind(place)? {
            CellType::Polygon => push(&face),
            CellType::Pixel => {
                if let [_, _, third, fourth] = face.as_mut_slice() {
                    std::mem::swap(third, fourth);
                }
                push(&face);
            }
            CellType::Strip => face.windows(3).for_each(push),
            CellType::HigherOrderFace(corners) => {
                face.truncate(if corners == 0 { face.len() / 2 } else { corners });
                push(&face);
                parts.higher_order += 1;
            }
            _ => {}
        }
        Ok(())
    }

    fn add_solid(&self, place: usize, points: usize, parts: &mut MeshParts) -> Result<(), FileError> {
        let own = part(&self.connectivity, &self.ends, place)?;
        let corners =
            |cell: &[i64]| cell.iter().map(|point| checked(*point, points)).collect::<Result<Vec<u32>, _>>();
        match self.kind(place)? {
            CellType::Flat
            | CellType::Polygon
            | CellType::Pixel
            | CellType::Strip
            | CellType::HigherOrderFace(_) => {
                parts.flat += 1;
                return Ok(());
            }
            CellType::Linear(shape) => parts.cells.push(shape, &corners(own)?)?,
            CellType::Voxel => {
                let mut corners = corners(own)?;
                if corners.len() == Shape::Hexahedron.corners() {
                    // Its points are listed in rows, not around the face.
                    corners.swap(2, 3);
                    corners.swap(6, 7);
                }
                parts.cells.push(Shape::Hexahedron, &corners)?;
            }
            CellType::HigherOrder(shape) => {
                let taken = own.len().min(shape.corners());
                parts.cells.push(shape, &corners(&own[..taken])?)?;
                parts.higher_order += 1;
            }
            CellType::Polyhedron => {
                let faces = self.faces(place, own)?;
                let faces: Vec<Vec<u32>> = faces.into_iter().map(corners).collect::<Result<_, _>>()?;
                parts.cells.push_polyhedron(faces.iter().map(Vec::as_slice));
            }
        }
        parts.places.push(place);
        Ok(())
    }

    /// The faces of a polyhedron.
    ///
    /// * `own` – its entries in the connectivity
    fn faces<'a>(&'a self, place: usize, own: &'a [i64]) -> Result<Vec<&'a [i64]>, Fault> {
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

/// Reads the faces from a list: the number of faces, then for each face the number of its points and the points.
fn stream(entries: &[i64]) -> Result<Vec<&[i64]>, Fault> {
    let cut_off = || Fault::cut_off("the faces of a polyhedron");
    let (count, mut rest) = entries.split_first().ok_or_else(cut_off)?;
    let mut faces = Vec::new();
    for _ in 0..*count {
        let (length, after) = rest.split_first().ok_or_else(cut_off)?;
        let length = usize::try_from(*length).map_err(|_| cut_off())?;
        let (face, after) = after.split_at_checked(length).ok_or_else(cut_off)?;
        faces.push(face);
        rest = after;
    }
    Ok(faces)
}

/// The part of a list at `place`, given the ends of all parts.
fn part<'a>(list: &'a [i64], ends: &[i64], place: usize) -> Result<&'a [i64], Fault> {
    let end = ends.get(place).copied().ok_or_else(|| Fault::cut_off("where each cell or face ends"))?;
    let start = if place == 0 { 0 } else { ends[place - 1] };
    between(list, start, end)
}

fn between(list: &[i64], start: i64, end: i64) -> Result<&[i64], Fault> {
    let range = usize::try_from(start).ok().zip(usize::try_from(end).ok());
    match range.and_then(|(start, end)| list.get(start..end)) {
        Some(part) => Ok(part),
        None if end < start => Err(Fault::not_increasing(start as f64, end as f64)),
        None => {
            Err(fault::count(list.len(), usize::try_from(end).unwrap_or(usize::MAX), "entries in its list"))
        }
    }
}

fn checked(point: i64, points: usize) -> Result<u32, Fault> {
    let known = u32::try_from(point).ok().filter(|number| (*number as usize) < points);
    known.ok_or_else(|| fault::no_point(point, points))
}
