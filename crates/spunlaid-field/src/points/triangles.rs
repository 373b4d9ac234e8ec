//! Points of a plane flow, joined to triangles: those of Delaunay, with no point in the circle through the corners of
//! a triangle.

use super::Points;
use crate::mesh::cells::Cells;
use crate::mesh::{MOST_TETRAHEDRA, Mesh};
use crate::vector;
use spade::{DelaunayTriangulation, Point2, Triangulation};
use spunlaid_ground::Vec3;

/// Tetrahedra of a mesh for each point of a plane flow: there are two triangles for each, cut into three.
const TETRAHEDRA: usize = 6;
/// Height over the longest side of a triangle whose corners lie on a straight wall but for rounding.
const FLAT: f64 = 1e-6;

impl Points {
    /// The triangles between the points of a plane flow, as a mesh. None in space, and if the points lie on one line.
    pub(crate) fn joined(&self) -> Option<Mesh> {
        let axis = self.plane_axis().filter(|_| self.points() <= MOST_TETRAHEDRA / TETRAHEDRA)?;
        let [one, other] = [(axis + 1) % 3, (axis + 2) % 3];
        let nodes = || self.sites.iter().map(|site| &site.node);
        let places = nodes().map(|node| Point2::new(node.at[one], node.at[other])).collect();
        let joined = DelaunayTriangulation::<Point2<f64>>::bulk_load_stable(places).ok()?;
        let mut faces = Cells::new();
        for face in joined.inner_faces() {
            let corners = face.vertices().map(|corner| corner.fix().index());
            if self.is_air(corners) {
                faces.push_polyhedron([&corners.map(|corner| corner as u32)[..]]);
            }
        }
        let places: Vec<_> = nodes().map(|node| vector(node.at)).collect();
        let values: Vec<_> = nodes().map(|node| node.values).collect();
        Some(Mesh::of_faces(&places, &faces, &values).ok()?.0)
    }

    /// Whether a triangle has an area, and its longest side does not span a gap between the points.
    fn is_air(&self, corners: [usize; 3]) -> bool {
        let [a, b, c] = corners.map(|corner| vector(self.sites[corner].node.at));
        let length_2 = |[one, other]: [Vec3<f64>; 2]| (other - one).dot(other - one);
        let longest = [[b, c], [c, a]]
            .into_iter()
            .fold([a, b], |longest, side| if length_2(side) > length_2(longest) { side } else { longest });
        let middle = (longest[0] + longest[1]) * 0.5;
        let mut nearest = [(0.0, 0)];
        self.tree.nearest([middle.x, middle.y, middle.z], &mut nearest);
        let [(distance_2, site)] = nearest;
        (b - a).cross(c - a).norm() > FLAT * length_2(longest)
            && distance_2 <= self.sites[site as usize].reach_2
    }
}
