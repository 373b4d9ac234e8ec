//! The cells of a mesh and their faces.

use spunlaid_ground::{Fault, FileError, Position};

spunlaid_ground::named! {
    /// The shape of a cell.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Shape {
        /// Four points.
        Tetrahedron = "a tetrahedron",
        /// Five points: those of the base in order around it, then the tip.
        Pyramid = "a pyramid",
        /// Six points, a triangular prism: those of one triangle in order around it, then the opposite ones.
        Wedge = "a wedge",
        /// Eight points: those of one face in order around it, then the opposite ones.
        Hexahedron = "a hexahedron",
        /// Ten points: those of one pentagon in order around it, then the opposite ones.
        PentagonalPrism = "a pentagonal prism",
        /// Twelve points: those of one hexagon in order around it, then the opposite ones.
        HexagonalPrism = "a hexagonal prism",
        /// Any number of faces; added with [`Cells::push_polyhedron`].
        Polyhedron = "a polyhedron",
    }
}

impl Shape {
    /// The faces, each as its corners in order around it, all seen from the same side; none for a polyhedron.
    const fn faces(self) -> &'static [&'static [usize]] {
        match self {
            Self::Tetrahedron => &[&[0, 1, 3], &[1, 2, 3], &[2, 0, 3], &[0, 2, 1]],
            Self::Pyramid => &[&[0, 3, 2, 1], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]],
            Self::Wedge => &[&[0, 1, 2], &[5, 4, 3], &[0, 3, 4, 1], &[1, 4, 5, 2], &[2, 5, 3, 0]],
            Self::Hexahedron => {
                &[&[0, 4, 7, 3], &[1, 2, 6, 5], &[0, 1, 5, 4], &[3, 7, 6, 2], &[0, 3, 2, 1], &[4, 5, 6, 7]]
            }
            Self::PentagonalPrism => &[
                &[0, 4, 3, 2, 1],
                &[5, 6, 7, 8, 9],
                &[0, 1, 6, 5],
                &[1, 2, 7, 6],
                &[2, 3, 8, 7],
                &[3, 4, 9, 8],
                &[4, 0, 5, 9],
            ],
            Self::HexagonalPrism => &[
                &[0, 5, 4, 3, 2, 1],
                &[6, 7, 8, 9, 10, 11],
                &[0, 1, 7, 6],
                &[1, 2, 8, 7],
                &[2, 3, 9, 8],
                &[3, 4, 10, 9],
                &[4, 5, 11, 10],
                &[5, 0, 6, 11],
            ],
            Self::Polyhedron => &[],
        }
    }

    /// Number of corners; 0 for a polyhedron, which has no fixed number.
    pub(crate) const fn corners(self) -> usize {
        match self {
            Self::Tetrahedron => 4,
            Self::Pyramid => 5,
            Self::Wedge => 6,
            Self::Hexahedron => 8,
            Self::PentagonalPrism => 10,
            Self::HexagonalPrism => 12,
            Self::Polyhedron => 0,
        }
    }
}

/// The cells of a mesh. Points are numbered from 0.
#[derive(Clone, Debug, Default)]
pub struct Cells {
    list: Vec<Entry>,
    /// Points of one cell after the other; for a polyhedron those of one face after the other.
    points: Vec<u32>,
    /// Number of points of each face of the polyhedra.
    faces: Vec<u32>,
}

/// Shape of a cell, and where its points begin; for a polyhedron also where its faces begin.
#[derive(Clone, Copy, Debug)]
struct Entry {
    shape: Shape,
    points: usize,
    faces: usize,
}

impl Cells {
    /// No cells.
    pub fn new() -> Self {
        Self::default()
    }

    /// How many.
    pub(crate) fn len(&self) -> usize {
        self.list.len()
    }

    /// Whether there are none.
    pub(crate) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Adds a cell.
    ///
    /// * `points` – one for each corner, in the order given at [`Shape`]
    ///
    /// # Errors
    /// When the number of points is not that of the shape's corners.
    pub fn push(&mut self, shape: Shape, points: &[u32]) -> Result<(), FileError> {
        if points.len() != shape.corners() || shape == Shape::Polyhedron {
            let name = shape.name();
            let found = points.len();
            let wanted = shape.corners();
            let place = Position::Cell(self.len() as u64 + 1);
            return Err(FileError::from(Fault::new(
                format!("{name} has {found} points and needs {wanted}"),
                "is the file complete?",
            ))
            .at(place));
        }
        self.list.push(self.next(shape));
        self.points.extend_from_slice(points);
        Ok(())
    }

    /// Adds a polyhedron.
    ///
    /// * `faces` – each as its points in order around it, seen from either side
    pub fn push_polyhedron<'a>(&mut self, faces: impl IntoIterator<Item = &'a [u32]>) {
        self.list.push(self.next(Shape::Polyhedron));
        for face in faces {
            self.faces.push(face.len() as u32);
            self.points.extend_from_slice(face);
        }
    }

    /// Adds a cell of another list with other numbers of its points.
    pub(crate) fn push_copy(&mut self, from: &Self, cell: usize, number: impl Fn(u32) -> u32) {
        let Entry { shape, points, faces } = from.list[cell];
        let next = from.list.get(cell + 1);
        let ends = next.map_or((from.points.len(), from.faces.len()), |next| (next.points, next.faces));
        self.list.push(self.next(shape));
        self.points.extend(from.points[points..ends.0].iter().map(|point| number(*point)));
        self.faces.extend_from_slice(&from.faces[faces..ends.1]);
    }

    /// Adds the cells of another list and adds `first` to the numbers of their points.
    pub(crate) fn append(&mut self, more: &Self, first: u32) {
        let Entry { points, faces, .. } = self.next(Shape::Polyhedron);
        let moved =
            |entry: &Entry| Entry { points: entry.points + points, faces: entry.faces + faces, ..*entry };
        self.list.extend(more.list.iter().map(moved));
        self.points.extend(more.points.iter().map(|point| point + first));
        self.faces.extend_from_slice(&more.faces);
    }

    /// Where the next cell begins.
    fn next(&self, shape: Shape) -> Entry {
        Entry { shape, points: self.points.len(), faces: self.faces.len() }
    }

    pub(super) fn is_polyhedron(&self, cell: usize) -> bool {
        self.list[cell].shape == Shape::Polyhedron
    }

    /// Calls `face` with the points of each face of a cell, in order around it.
    pub(super) fn each_face(&self, cell: usize, mut face: impl FnMut(&[u32])) {
        let Entry { shape, points, faces } = self.list[cell];
        let mut rest = &self.points[points..];
        if shape == Shape::Polyhedron {
            let end = self.list.get(cell + 1).map_or(self.faces.len(), |next| next.faces);
            for count in &self.faces[faces..end] {
                let (points, after) = rest.split_at(*count as usize);
                face(points);
                rest = after;
            }
        }
        let mut points = [0; 6];
        for corners in shape.faces() {
            for (point, corner) in points.iter_mut().zip(*corners) {
                *point = rest[*corner];
            }
            face(&points[..corners.len()]);
        }
    }

    /// Replaces the content of `list` by the points of a cell, each once, in increasing order.
    pub(crate) fn corners(&self, cell: usize, list: &mut Vec<u32>) {
        list.clear();
        self.each_face(cell, |points| list.extend_from_slice(points));
        list.sort_unstable();
        list.dedup();
    }

    /// The first cell that names a point whose number is `points` or larger, and that number.
    pub(super) fn beyond(&self, points: usize) -> Option<(usize, u32)> {
        (0..self.len()).find_map(|cell| {
            let mut wrong = None;
            self.each_face(cell, |face| {
                wrong = wrong.or_else(|| face.iter().copied().find(|point| *point as usize >= points));
            });
            wrong.map(|point| (cell, point))
        })
    }
}

/// Calls `pair` for two triangles with the same nodes and `alone` for a triangle that occurs once, with their
/// places in the list.
///
/// Triangles are grouped by their smallest node. Time and memory are proportional to the number of triangles.
pub(super) fn match_up(
    nodes: usize,
    triangles: impl Iterator<Item = [u32; 3]> + Clone,
    mut pair: impl FnMut(u32, u32),
    mut alone: impl FnMut(u32),
) {
    let mut ends = vec![0u32; nodes + 1];
    for [a, b, c] in triangles.clone() {
        ends[a.min(b).min(c) as usize + 1] += 1;
    }
    for i in 0..nodes {
        ends[i + 1] += ends[i];
    }
    // While the lists are filled, `ends[i]` moves from the start of list i to its end.
    let mut lists = vec![[0u32; 3]; ends[nodes] as usize];
    for (number, mut triangle) in triangles.enumerate() {
        triangle.sort_unstable();
        let [smallest, middle, largest] = triangle;
        let place = &mut ends[smallest as usize];
        lists[*place as usize] = [middle, largest, number as u32];
        *place += 1;
    }
    let mut start = 0;
    for end in ends.into_iter().take(nodes) {
        let list = &mut lists[start..end as usize];
        list.sort_unstable();
        let mut rest = &*list;
        while let Some((&[middle, largest, number], after)) = rest.split_first() {
            match after.first() {
                Some(&[m, l, other]) if (m, l) == (middle, largest) => {
                    pair(number, other);
                    rest = &after[1..];
                }
                _ => {
                    alone(number);
                    rest = after;
                }
            }
        }
        start = end as usize;
    }
}
