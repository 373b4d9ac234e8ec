//! The points of a piece of a file, and the cells that they form.

use super::unstructured::{MeshLists, MeshParts};
use crate::fault;
use spunlaid_ground::{FileError, Vec3};
use std::borrow::Cow;

/// How the points of a piece are arranged.
pub(super) enum Grid {
    /// A lattice with even steps. Its points have the indices from `first` on, and index 0 is at the origin.
    Image { origin: [f64; 3], spacing: [f64; 3], first: [f64; 3], size: [usize; 3] },
    /// A lattice with any steps.
    Lattice([Vec<f64>; 3]),
    /// A structured grid: three indices for each point, which may lie anywhere.
    Structured { size: [usize; 3], points: Vec<Vec3<f64>> },
    /// Points anywhere, without cells.
    Scattered(Vec<Vec3<f64>>),
    /// Points anywhere, with cells.
    Unstructured { points: Vec<Vec3<f64>>, parts: MeshParts, cells: usize },
}

impl Grid {
    pub(super) fn unstructured(points: Vec<Vec3<f64>>, listed: &MeshLists) -> Result<Self, FileError> {
        let parts = listed.parts(points.len())?;
        Ok(Self::Unstructured { points, parts, cells: listed.types.len() })
    }

    /// Number of points along each axis, if the grid has axes.
    fn size(&self) -> Option<[usize; 3]> {
        match self {
            Self::Image { size, .. } | Self::Structured { size, .. } => Some(*size),
            Self::Lattice(axes) => Some([0, 1, 2].map(|i| axes[i].len())),
            Self::Unstructured { .. } | Self::Scattered(_) => None,
        }
    }

    /// Numbers of points and of cells.
    pub(super) fn counts(&self) -> Result<(usize, usize), FileError> {
        match self {
            Self::Unstructured { points, cells, .. } => Ok((points.len(), *cells)),
            Self::Scattered(points) => Ok((points.len(), 0)),
            _ => {
                let size = self.size().unwrap_or_default();
                Ok((counted(size)?, counted(size.map(|n| n.saturating_sub(1).max(1)))?))
            }
        }
    }

    /// All points.
    pub(super) fn points(&self) -> Cow<'_, [Vec3<f64>]> {
        match self {
            Self::Scattered(points) | Self::Structured { points, .. } | Self::Unstructured { points, .. } => {
                Cow::Borrowed(points)
            }
            Self::Image { .. } | Self::Lattice(_) => {
                self.axes().iter().flat_map(combinations).collect::<Vec<_>>().into()
            }
        }
    }

    /// Calls a function with each cell and the numbers of its corners.
    pub(super) fn each_cell(&self, mut cell: impl FnMut(usize, &[u32])) {
        let mut corners = Vec::new();
        let Some([nx, ny, nz]) = self.size() else {
            if let Self::Unstructured { parts, .. } = self {
                for (i, place) in parts.places.iter().enumerate() {
                    parts.cells.corners(i, &mut corners);
                    cell(*place, &corners);
                }
            }
            return;
        };
        let [mx, my, mz] = [nx, ny, nz].map(|n| n.saturating_sub(1).max(1));
        for number in 0..mx * my * mz {
            let x = number % mx;
            let y = number / mx % my;
            let z = number / mx / my;
            corners.clear();
            // In order around each of two opposite faces. A grid that is one point thick has only one.
            for k in z..(z + 2).min(nz) {
                for (i, j) in [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)] {
                    if i < nx && j < ny {
                        corners.push((i + nx * (j + ny * k)) as u32);
                    }
                }
            }
            if corners.len() == 4 && nz > 1 {
                // Two rows, not around the face.
                corners.swap(2, 3);
            }
            cell(number, &corners);
        }
    }

    /// The places of some points, or the middles of some cells [m].
    ///
    /// * `numbers` – in increasing order
    pub(super) fn places(&self, of_cells: bool, numbers: &[usize]) -> Vec<Vec3<f64>> {
        if of_cells {
            let (mut corners_of, mut all) = (Vec::new(), Vec::new());
            self.each_cell(|cell, corners| {
                if numbers.binary_search(&cell).is_ok() {
                    all.extend(corners.iter().map(|corner| *corner as usize));
                    corners_of.push(corners.len());
                }
            });
            let places = self.places(false, &all);
            let mut rest = places.as_slice();
            let middle = |count: usize| {
                let (own, after) = rest.split_at(count);
                rest = after;
                own.iter().fold(Vec3::default(), |sum, at| sum + *at) * (1.0 / count.max(1) as f64)
            };
            return corners_of.into_iter().map(middle).collect();
        }
        let points = self.points();
        numbers.iter().map(|i| points[*i]).collect()
    }

    /// Turns values at cells into values at points: each point gets the mean of the cells around it that `hold` air.
    pub(super) fn to_points(
        &self,
        values: &[f64],
        components: usize,
        points: usize,
        holds: impl Fn(usize) -> bool,
    ) -> Vec<f64> {
        let mut sums = vec![0.0; points * components];
        let mut around = vec![0u32; points];
        self.each_cell(|cell, corners| {
            for corner in corners.iter().map(|corner| *corner as usize).filter(|_| holds(cell)) {
                around[corner] += 1;
                for i in 0..components {
                    sums[corner * components + i] += values[cell * components + i];
                }
            }
        });
        for (sums, around) in sums.chunks_exact_mut(components).zip(around) {
            sums.iter_mut().for_each(|sum| *sum /= f64::from(around.max(1)));
        }
        sums
    }

    /// The axes of a lattice.
    pub(super) fn axes(&self) -> Option<[Vec<f64>; 3]> {
        match self {
            // A point that two pieces share must come out with the same bits in both.
            Self::Image { origin, spacing, first, size } => Some([0, 1, 2].map(|axis| {
                let at = |i: usize| origin[axis] + (first[axis] + i as f64) * spacing[axis];
                (0..size[axis]).map(at).collect()
            })),
            Self::Lattice(axes) => Some(axes.clone()),
            _ => None,
        }
    }
}

/// The points of a lattice, those along x first.
pub(super) fn combinations([x, y, z]: &[Vec<f64>; 3]) -> impl Iterator<Item = Vec3<f64>> {
    let row = move |y: f64, z: f64| x.iter().map(move |&x| Vec3::new(x, y, z));
    z.iter().flat_map(move |&z| y.iter().flat_map(move |&y| row(y, z)))
}

/// The product, if that many points can be numbered.
pub(super) fn counted(size: [usize; 3]) -> Result<usize, FileError> {
    let product = size.iter().try_fold(1usize, |product, n| product.checked_mul(*n));
    let product = product.filter(|product| u32::try_from(*product).is_ok());
    product.ok_or_else(|| fault::too_many(u32::MAX.into(), "points").into())
}

/// Turns rows of three numbers into vectors.
pub(super) fn vectors(numbers: &[f64]) -> Vec<Vec3<f64>> {
    numbers.chunks_exact(3).map(|v| Vec3::new(v[0], v[1], v[2])).collect()
}
