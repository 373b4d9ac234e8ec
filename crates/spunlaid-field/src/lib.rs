//! Air flow from computational fluid dynamics, steady in time: velocity and turbulence at any place.
//!
//! ```text
//! file (VTK, table of points) → Field → sample: the air at a place → Local
//!                                     → around: with its gradients → AirAround
//! ```
//!
//! # Example
//!
//! ```
//! use spunlaid_field::{Field, Hint, Vec3};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // Plane shear between y = 0 and y = 1 m.
//! let file = tempfile::Builder::new().suffix(".csv").tempfile()?;
//! std::fs::write(file.path(), "x_m,y_m,u_m_s,v_m_s\n0,0,0,0\n2,0,0,0\n0,1,10,0\n2,1,10,0\n")?;
//!
//! let (field, warnings) = Field::read(file.path())?;
//! assert!(warnings.is_empty() && !field.has_turbulence());
//!
//! // A hint makes the next place near by quicker to find.
//! let (at, mut hint) = (Vec3::new(0.3, 0.25, 0.0), Hint::default());
//! let local = field.sample(at, &mut hint);
//! assert!(local.inside && local.velocity == Vec3::new(2.5, 0.0, 0.0));
//!
//! // The same air with its gradients: du/dy is 10 m/s over 1 m.
//! let around = field.around(at, &mut hint);
//! assert_eq!(around.gradients[1], [10.0, 0.0, 0.0, 0.0]);
//!
//! // A file that cannot be used says where and why.
//! let refusal = Field::parse(b"x_m,y_m,u_m_s,v_m_s\n0,0,0,ten\n", "shear.csv").unwrap_err();
//! assert!(refusal.to_string().starts_with("shear.csv:2: column v_m_s: \"ten\" is not a number"));
//! # Ok(())
//! # }
//! ```
//!
//! # What goes in
//!
//! A steady solution: the mean velocity [m/s] at points or in cells and, if known, the turbulent kinetic energy `k`
//! [m²/s²] with its dissipation rate `ε` [m²/s³] or the specific dissipation rate `ω` [1/s]. It comes from a file
//! ([`Field::read`]), from bytes ([`Field::parse`]) or from numbers in memory ([`Field::lattice`], [`Field::mesh`],
//! [`Field::points`]).
//!
//! | format | what is read |
//! |---|---|
//! | `.vtu`, `.vts`, `.vti`, `.vtr` | XML VTK, ASCII or binary, plain or compressed with zlib or LZ4 |
//! | `.pvtu`, `.pvts`, `.pvti`, `.pvtr`, `.vtm` | the field of all files that they list |
//! | `.vtk` | legacy VTK, versions 1 to 5 |
//! | text | one row for each point, as [`spunlaid_ground::table`] describes |
//!
//! The format is recognised from the file's content. Arrays and columns are recognised by their names, as OpenFOAM,
//! Fluent, CFX and ParaView write them; `docs/air.md` of the repository lists them. [`FieldLayout`] names others.
//! Numbers are in SI units unless a name ends with another unit, as `x_mm` does.
//!
//! # What comes out
//!
//! The air at any place, [`Local`]: velocity, `k`, `ε` and whether the place lies in the field. On a
//! [lattice](Field::lattice) it is linear in each coordinate. In a [mesh](Field::mesh) it is linear in tetrahedra.
//! Among [points](Field::points) of a plane flow it is linear in triangles, and in space a weighted mean of the nearest
//! eight. A flow that is linear in space is reproduced exactly. Outside the field it is the air at the edge. Warnings
//! say what was left out or corrected.
//!
//! **Limits.** Coordinates and values lie within ±1e30. A file is held in memory while it is read. Further memory is
//! taken only for the bytes that are there, never for what a header promises.
//!
//! The crate is the reader of fields of the simulator `spunlaid`. The same file and place give the same bits on every
//! machine. Where a message names a key of a case, `air.field_velocity`, another program sets a name of
//! [`FieldLayout`].

// Units are written in brackets, [m/s], which rustdoc would take for broken links.
#![allow(rustdoc::broken_intra_doc_links)]

mod bricks;
mod cells_of_file;
mod evenness;
mod fault;
mod holes;
mod lattice;
mod mesh;
mod node;
mod points;
mod read;
mod tree;

pub use bricks::AirAround;
use bricks::OctreeCache;
pub use cells_of_file::{BlockKind, FieldCells};
pub use evenness::{Overview, Spread};
use holes::Holes;
use lattice::Lattice;
use mesh::Mesh;
pub use mesh::cells::{Cells, Shape};
use node::Quantities;
pub use node::{FieldLayout, Values};
use points::Points;
pub use read::ReadField;
pub use spunlaid_ground::{Fault, FileError, Vec3};
use std::fmt;
use std::sync::OnceLock;

/// Coordinates are limited to this value, so that squares of distances stay finite [m].
const FARTHEST: f64 = 1e3 * node::LARGEST;

/// A place that lies less than this share of the extent beyond a side of the field's box lies on that side [-].
const ROUNDING: f64 = 1e-9;

/// The air in a part of space, steady in time, in SI units.
#[derive(Debug)]
pub struct Field {
    support: Support,
    turbulence: bool,
    bricks: OctreeCache,
    /// Why there is no turbulence, if it was read from a file.
    lacks: Option<Fault>,
    /// What was read from a file, and from which arrays.
    sources: Vec<(&'static str, String)>,
    /// The arrays that were named for the reading.
    layout: FieldLayout,
    /// Where its file has no numbers.
    holes: Option<Holes>,
    /// The name of a coordinate that has a unit.
    measured_coordinate: Option<String>,
    /// How much the velocity changes along x, y and z, once it is known.
    changes: OnceLock<[f64; 3]>,
}

/// How the points with the values are arranged.
#[derive(Debug)]
enum Support {
    Lattice(Lattice),
    Mesh(Mesh),
    /// Points of a plane flow, with the triangles between them.
    Joined(Mesh),
    Points(Points),
}

impl Support {
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        match self {
            Self::Lattice(lattice) => lattice.bounds(),
            Self::Mesh(mesh) | Self::Joined(mesh) => mesh.bounds(),
            Self::Points(points) => points.bounds(),
        }
    }

    /// The place itself, or the one on the side of the box that it lies beyond by rounding: a plane of places
    /// at the end of the field is in it.
    fn rounded(&self, at: [f64; 3]) -> [f64; 3] {
        let (low, high) = self.bounds();
        [0, 1, 2].map(|i| {
            let within = at[i].clamp(low[i], high[i]);
            if (within - at[i]).abs() <= ROUNDING * (high[i] - low[i]) { within } else { at[i] }
        })
    }

    fn sample(&self, at: [f64; 3], hint: &mut Hint) -> (Quantities, bool) {
        match self {
            Self::Lattice(lattice) => lattice.sample(at),
            Self::Mesh(mesh) | Self::Joined(mesh) => mesh.sample(at, hint),
            Self::Points(points) => points.sample(at),
        }
    }

    /// Calls `with` for the points in a box where the values may be extreme. Points beside it may be among them.
    fn points_in_box(&self, low: [f64; 3], high: [f64; 3], with: impl FnMut([f64; 3], &Quantities)) {
        match self {
            Self::Lattice(lattice) => lattice.points_in_box(low, high, with),
            Self::Mesh(mesh) | Self::Joined(mesh) => mesh.points_in_box(low, high, with),
            Self::Points(points) => points.points_in_box(low, high, with),
        }
    }
}

/// The air at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Local {
    /// Mean velocity [m/s].
    pub velocity: Vec3<f64>,
    /// Turbulent kinetic energy `k` [m²/s²]; zero if the field has none.
    pub k: f64,
    /// Dissipation rate `ε` of the turbulent kinetic energy [m²/s³]; zero if the field has none.
    pub epsilon: f64,
    /// Whether the point lies in the field. Outside, the values are those of its edge.
    pub inside: bool,
}

/// Remembers where a point was found, so that the next one near by is found in a few steps.
///
/// It saves time. It changes a result at most by rounding, where a point lies on the face between two cells, even if
/// it comes from another field.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hint(u32);

impl Field {
    /// A field on a lattice whose points are all combinations of three rows of coordinates; between them the
    /// values are linear in each coordinate.
    ///
    /// If a row has one point, the field does not change in that direction. Outside, the field has the values of
    /// the nearest point of the lattice's box.
    ///
    /// * `axes` – coordinates along x, y and z, each increasing [m]
    /// * `values` – at the points; x changes fastest, z slowest
    ///
    /// # Errors
    /// When coordinates do not increase, or values are too few, too many or not finite.
    pub fn lattice(axes: [Vec<f64>; 3], values: &Values) -> Result<Self, FileError> {
        let count = axes.iter().try_fold(1usize, |product, axis| product.checked_mul(axis.len()));
        let quantities = values.check(count.unwrap_or(usize::MAX))?;
        let lattice = Lattice::new(axes, quantities)?;
        Ok(Self::new(Support::Lattice(lattice), values))
    }

    /// A field on a mesh of cells, each cut into tetrahedra within which the values are linear.
    ///
    /// Neighbours agree on how the face between them is cut, so the field is continuous. Points at the same place
    /// count as one point with the mean of their values. Outside, the field has the values of the nearest point
    /// of the mesh's surface: beyond a wall the air stands still.
    ///
    /// * `points` – [m]
    /// * `cells` – of these points
    /// * `values` – at the points
    ///
    /// # Errors
    /// When a cell names a point that does not exist, when no cell has a volume, or when values are too few, too
    /// many or not finite.
    pub fn mesh(
        points: &[Vec3<f64>],
        cells: &Cells,
        values: &Values,
    ) -> Result<(Self, Vec<Fault>), FileError> {
        let quantities = values.check(points.len())?;
        let (mesh, warnings) = Mesh::new(points, cells, quantities)?;
        Ok((Self::new(Support::Mesh(mesh), values), warnings))
    }

    /// A plane flow on a mesh of faces in the plane of two coordinates.
    ///
    /// * `faces` – each as a cell with this face only
    fn plane_mesh(
        points: &[Vec3<f64>],
        faces: &Cells,
        values: &Values,
    ) -> Result<(Self, Vec<Fault>), FileError> {
        let quantities = values.check(points.len())?;
        let (mesh, warnings) = Mesh::of_faces(points, faces, &quantities)?;
        Ok((Self::new(Support::Mesh(mesh), values), warnings))
    }

    /// The same field, with one layer of points if it is a lattice with two that are alike.
    fn thinned(mut self) -> Self {
        if let Support::Lattice(lattice) = self.support {
            self.support = Support::Lattice(lattice.thinned());
            self.bricks = OctreeCache::new(self.support.bounds());
        }
        self
    }

    /// A field of points without cells, in any order.
    ///
    /// Points that form a lattice make a [`Field::lattice`]. If all points have the same coordinate along an axis,
    /// the field does not change along it, and its values are linear in the triangles of Delaunay between the points.
    /// Otherwise the value is a weighted mean of what the nearest eight points extrapolate along their gradients,
    /// which are fitted to their neighbours. The field has the values of the nearest point outside of all points, and
    /// where that point is farther away than its own neighbours are. Points at the same place count as one point with
    /// the mean of their values.
    ///
    /// * `points` – [m]
    /// * `values` – at the points
    ///
    /// # Errors
    /// When points are too few, or values are too few, too many or not finite.
    pub fn points(points: &[Vec3<f64>], values: &Values) -> Result<(Self, Vec<Fault>), FileError> {
        let (nodes, warnings) = node::distinct(points, values)?;
        let support = match Lattice::from_points(&nodes) {
            Some(lattice) => Support::Lattice(lattice),
            None => {
                let points = Points::new(nodes)?;
                points.joined().map_or_else(|| Support::Points(points), Support::Joined)
            }
        };
        Ok((Self::new(support, values), warnings))
    }

    /// A lattice, of points in any order, or none if the points form no lattice.
    fn lattice_of_points(
        points: &[Vec3<f64>],
        values: &Values,
    ) -> Result<Option<(Self, Vec<Fault>)>, FileError> {
        let (nodes, warnings) = node::distinct(points, values)?;
        let lattice = Lattice::from_points(&nodes);
        Ok(lattice.map(|lattice| (Self::new(Support::Lattice(lattice), values), warnings)))
    }

    fn new(support: Support, values: &Values) -> Self {
        let bricks = OctreeCache::new(support.bounds());
        let (sources, layout) = (Vec::new(), FieldLayout::default());
        let turbulence = values.has_turbulence();
        let lacks = None;
        let holes = None;
        let measured_coordinate = None;
        let changes = OnceLock::new();
        Self { support, turbulence, bricks, lacks, sources, layout, holes, measured_coordinate, changes }
    }

    /// Whether the field has `k` and `ε`.
    pub const fn has_turbulence(&self) -> bool {
        self.turbulence
    }

    /// What a file lacks for `k` and `ε`, the arrays that it has, and what to do; none if they are there. The
    /// text continues after `the field`.
    pub fn why_no_turbulence(&self) -> Option<&Fault> {
        self.lacks.as_ref().filter(|_| !self.turbulence)
    }

    /// What was read from a file, and the names of its arrays: `("velocity", "Ux, Uy, Uz")`. Empty for a
    /// field from numbers.
    pub fn sources(&self) -> &[(&'static str, String)] {
        &self.sources
    }

    /// The arrays that were named when the file was read.
    pub const fn layout(&self) -> &FieldLayout {
        &self.layout
    }

    /// The name of a coordinate whose unit its file reports, `x_mm`. None if the file leaves the unit open.
    pub fn measured_coordinate(&self) -> Option<&str> {
        self.measured_coordinate.as_deref()
    }

    /// The lowest and the highest coordinates [m].
    pub fn bounds(&self) -> (Vec3<f64>, Vec3<f64>) {
        let (low, high) = self.support.bounds();
        (vector(low), vector(high))
    }

    /// The memory that the field takes now [bytes]. It grows while places are looked up with [`Field::around`], by
    /// 1 GiB at most.
    pub fn memory(&self) -> usize {
        let support = match &self.support {
            Support::Lattice(lattice) => lattice.memory(),
            Support::Mesh(mesh) | Support::Joined(mesh) => mesh.memory(),
            Support::Points(points) => points.memory(),
        };
        support + self.bricks.memory() + self.holes.as_ref().map_or(0, Holes::memory)
    }

    /// Estimate of the memory that reading the field took, without that of its file [bytes].
    pub fn memory_while_made(&self) -> usize {
        // Measured: points, cells and values are there as they were read, sorted, and as they are kept.
        match &self.support {
            Support::Lattice(lattice) => 2 * lattice.memory(),
            Support::Mesh(mesh) | Support::Joined(mesh) => 3 * mesh.memory(),
            Support::Points(points) => 2 * points.memory(),
        }
    }

    /// The air at a point.
    ///
    /// * `at` – [m]; if a coordinate is NaN, the air stands still
    /// * `hint` – where the last point was found; set to where this one is found. Only meshes use it
    pub fn sample(&self, at: Vec3<f64>, hint: &mut Hint) -> Local {
        let Some(at) = self.looked_at(at) else { return Local::default() };
        let (values, inside) = self.support.sample(at, hint);
        let [u, v, w, k, epsilon] = values;
        Local { velocity: Vec3::new(u, v, w), k: k.max(0.0), epsilon: epsilon.max(0.0), inside }
    }

    /// The air around a point, linear in space: its value and gradients at the point, and how far these may be used.
    ///
    /// It comes from lattices of values that are sampled once and kept for the life of the field. They are made as
    /// fine as needed: within its reach the error is estimated to be a thousandth of the largest velocity near by,
    /// and up to eight times that in layers thinner than a thousandth of the field.
    /// Where the field is too rough for that, it is [`Field::sample`] with a reach of zero. The result does not depend
    /// on what was looked up before, except for [`Field::sample`]'s hint.
    ///
    /// * `at` – [m]
    /// * `hint` – as of [`Field::sample`]
    pub fn around(&self, at: Vec3<f64>, hint: &mut Hint) -> AirAround {
        let at = self.looked_at(at);
        at.map_or_else(AirAround::default, |at| self.bricks.around(at, hint, &self.support))
    }

    /// Where the field is looked at for a point [m]; None if a coordinate is NaN.
    fn looked_at(&self, at: Vec3<f64>) -> Option<[f64; 3]> {
        let at = [at.x, at.y, at.z].map(|x| x.clamp(-FARTHEST, FARTHEST));
        at.iter().all(|x| !x.is_nan()).then(|| self.support.rounded(at))
    }

    /// The direction along which the air is the same in a plane flow: 0, 1, 2 for x, y, z. None if the flow
    /// is in space.
    pub fn plane_axis(&self) -> Option<usize> {
        match &self.support {
            Support::Lattice(lattice) => lattice.plane_axis(),
            Support::Mesh(mesh) | Support::Joined(mesh) => mesh.plane_axis(),
            Support::Points(points) => points.plane_axis(),
        }
    }

    /// The kind of field and its size.
    pub fn describe(&self) -> Description {
        match &self.support {
            Support::Lattice(lattice) => Description::Lattice { points: lattice.points() },
            Support::Mesh(mesh) => Description::Mesh { points: mesh.points(), cells: mesh.cells() },
            Support::Joined(mesh) => Description::Points { points: mesh.points() },
            Support::Points(points) => Description::Points { points: points.points() },
        }
    }
}

/// The kind of a field and its size; prints as `a mesh of 3120 points and 2400 cells`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Description {
    /// A lattice.
    Lattice {
        /// Points along x, y and z.
        points: [usize; 3],
    },
    /// A mesh.
    Mesh {
        /// Points of its cells.
        points: usize,
        /// Cells with a volume.
        cells: usize,
    },
    /// Points without cells.
    Points {
        /// How many.
        points: usize,
    },
}

impl fmt::Display for Description {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Lattice { points: [x, y, z] } => write!(f, "a structured grid of {x} × {y} × {z} points"),
            Self::Mesh { points, cells } => write!(f, "a mesh of {points} points and {cells} cells"),
            Self::Points { points } => write!(f, "{points} scattered points"),
        }
    }
}

const fn vector([x, y, z]: [f64; 3]) -> Vec3<f64> {
    Vec3::new(x, y, z)
}

/// The weighted sum of the values at some nodes.
fn mean<'a>(nodes: impl Iterator<Item = (f64, &'a Quantities)>) -> Quantities {
    let mut sum = Quantities::default();
    for (weight, values) in nodes {
        for (sum, value) in sum.iter_mut().zip(values) {
            *sum += weight * value;
        }
    }
    sum
}
