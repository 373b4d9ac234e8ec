//! The cells of a field: where they are, how large they are, and in which one a place lies.

use super::{Field, Hint, Support, vector};
use spunlaid_ground::Vec3;

/// The cells of a field, numbered from 0 in the order of its file without those that were left out.
///
/// All numbers are in the coordinates of the field.
#[derive(Debug)]
pub struct FieldCells<'a> {
    field: &'a Field,
    blocks: Blocks,
}

/// Cells as simple bodies, of which each cell has one or more: boxes of a lattice, tetrahedra of a mesh.
#[derive(Debug)]
pub(super) struct Blocks {
    pub(super) kind: BlockKind,
    pub(super) points: Vec<[f64; 3]>,
    /// The points of one body after the other.
    pub(super) corners: Vec<u32>,
    /// The end of the bodies of each cell.
    pub(super) ends: Vec<u32>,
    /// Volume of each cell; of the unit depth in a lattice that is one point thick.
    pub(super) volumes: Vec<f64>,
    pub(super) centres: Vec<[f64; 3]>,
    /// How far the cells reach along the direction in which the air of a plane flow is the same.
    pub(super) depth: Option<f64>,
}

/// What the bodies are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlockKind {
    /// Rectangles along two axes, with four corners: rows of the first axis.
    Pixel,
    /// Boxes along three axes, with eight corners: rows of the first axis, then of the second.
    Voxel,
    /// Tetrahedra.
    Tetrahedron,
}

impl BlockKind {
    /// Number of corners.
    pub(crate) const fn corners(self) -> usize {
        match self {
            Self::Pixel | Self::Tetrahedron => 4,
            Self::Voxel => 8,
        }
    }
}

impl Field {
    /// Its cells; none of points without cells, and of a lattice that is a single row of points.
    pub fn cells(&self) -> Option<FieldCells<'_>> {
        let blocks = match &self.support {
            Support::Lattice(lattice) => lattice.blocks()?,
            Support::Mesh(mesh) => mesh.blocks(),
            Support::Joined(_) | Support::Points(_) => return None,
        };
        Some(FieldCells { field: self, blocks })
    }
}

impl FieldCells<'_> {
    /// How many.
    pub fn count(&self) -> usize {
        self.blocks.ends.len()
    }

    /// The cell in which a place lies; None outside of the field.
    pub fn find(&self, at: Vec3<f64>, hint: &mut Hint) -> Option<usize> {
        let at = self.field.looked_at(at)?;
        match &self.field.support {
            Support::Lattice(lattice) => lattice.cell(at),
            Support::Mesh(mesh) => {
                let body = mesh.locate(mesh.in_plane(at), hint)?.0;
                Some(self.blocks.ends.partition_point(|end| *end <= body))
            }
            Support::Joined(_) | Support::Points(_) => None,
        }
    }

    /// Volume of a cell. In a plane flow it reaches as far in the third direction as [`FieldCells::depth`] says.
    pub fn volume(&self, cell: usize) -> f64 {
        self.blocks.volumes[cell]
    }

    /// Middle of a cell.
    pub fn centre(&self, cell: usize) -> Vec3<f64> {
        vector(self.blocks.centres[cell])
    }

    /// How far the cells reach along the direction in which the air of a plane flow is the same: the thickness of a
    /// mesh, or one unit. None if the flow is in space.
    pub fn depth(&self) -> Option<f64> {
        self.blocks.depth
    }

    /// The corners of all bodies of which the cells are made, in the order of the cells.
    pub fn points(&self) -> impl Iterator<Item = Vec3<f64>> {
        self.blocks.points.iter().map(|at| vector(*at))
    }

    /// What these bodies are.
    pub fn kind(&self) -> BlockKind {
        self.blocks.kind
    }

    /// The numbers of the corners of each body, and its cell.
    pub fn bodies(&self) -> impl Iterator<Item = (&[u32], usize)> {
        let bodies = self.blocks.corners.chunks_exact(self.blocks.kind.corners());
        bodies
            .enumerate()
            .map(|(body, corners)| (corners, self.blocks.ends.partition_point(|end| *end as usize <= body)))
    }
}
