//! Plane flows: meshes of faces in a plane, and meshes that are one cell thick. The air is the same along the
//! third direction.

use super::Mesh;
use super::cells::{Cells, Shape};
use crate::node::{Node, Quantities, bounding_box};
use spunlaid_ground::{Fault, FileError, Vec3};

/// Coordinates that differ by less than this share of the extent count as equal.
const ROUNDING: f64 = 1e-9;
/// The same of values, as a share of the largest of their kind. Single precision has more digits.
const ALIKE: f64 = 1e-5;
/// Fewest rows of points along the axes of the plane. With fewer, nothing reports the plane from the third direction.
const FEWEST: usize = 3;

/// The plane of a plane flow.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// The direction along which the air is the same: 0, 1, 2 for x, y, z.
    pub(super) axis: usize,
    /// Where the plane is [m].
    pub(super) level: f64,
}

impl Mesh {
    /// A mesh of the faces of a plane flow. Each becomes a cell between two planes.
    ///
    /// * `faces` – each as a cell with this face only
    pub(crate) fn of_faces(
        points: &[Vec3<f64>],
        faces: &Cells,
        values: &[Quantities],
    ) -> Result<(Self, Vec<Fault>), FileError> {
        let (low, high) = bounding_box(points.iter().map(|at| [at.x, at.y, at.z]));
        let extent = [0, 1, 2].map(|axis| high[axis] - low[axis]);
        let largest = extent.into_iter().fold(0.0, f64::max);
        let Some(axis) = (0..3).find(|axis| extent[*axis] <= ROUNDING * largest) else {
            return Err(tilted(faces.len()).into());
        };
        let level = 0.5 * (low[axis] + high[axis]);
        let area: f64 = (0..3).filter(|other| *other != axis).map(|other| extent[other]).product();
        let half = 0.5 * (area / faces.len().max(1) as f64).sqrt();
        let count = points.len() as u32;
        let layer = |side: f64| points.iter().map(move |at| on_level(*at, axis, level + side * half));
        let both: Vec<Vec3<f64>> = layer(-1.0).chain(layer(1.0)).collect();
        let cells = prisms(faces, count)?;
        let plane = Some(Plane { axis, level });
        let (mesh, warnings) = Self::cut(&both, &cells, [values, values].concat(), plane)?;
        Ok((Self { points: points.len(), ..mesh }, warnings))
    }
}

/// The cells between two planes, the points of the second of which are numbered from `count` on.
fn prisms(faces: &Cells, count: u32) -> Result<Cells, FileError> {
    let mut cells = Cells::new();
    for face in 0..faces.len() {
        let mut near = Vec::new();
        faces.each_face(face, |points| near.extend_from_slice(points));
        let far: Vec<u32> = near.iter().map(|point| point + count).collect();
        let all = [&*near, &*far].concat();
        match near.len() {
            3 => cells.push(Shape::Wedge, &all)?,
            4 => cells.push(Shape::Hexahedron, &all)?,
            sides => {
                let side = |i: usize| {
                    let next = (i + 1) % sides;
                    vec![near[i], near[next], far[next], far[i]]
                };
                let around: Vec<Vec<u32>> = (0..sides).map(side).collect();
                cells.push_polyhedron(
                    [near.as_slice(), &far].into_iter().chain(around.iter().map(Vec::as_slice)),
                );
            }
        }
    }
    Ok(cells)
}

/// The plane of a mesh that is one cell thick and has the same air on both sides; none of another mesh.
pub(super) fn plane_of(nodes: &[Node]) -> Option<Plane> {
    let levels = [0, 1, 2].map(|axis| few_levels(nodes, axis));
    let mut thin = (0..3).filter(|axis| levels[*axis].len() == 2);
    let axis = thin.next()?;
    let others = levels.iter().filter(|levels| levels.len() >= FEWEST).count();
    if thin.next().is_some() || others != 2 {
        return None;
    }
    let [low, high] = [levels[axis][0], levels[axis][1]];
    let level = 0.5 * (low + high);
    let mut order: Vec<&Node> = nodes.iter().collect();
    let [one, other] = [(axis + 1) % 3, (axis + 2) % 3];
    let key = |node: &Node| [node.at[one], node.at[other], node.at[axis]];
    order.sort_unstable_by(|a, b| {
        let (a, b) = (key(a), key(b));
        a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2]))
    });
    order.dedup_by(|a, b| a.at == b.at);
    let largest = nodes.iter().fold(Quantities::default(), |most, node| {
        std::array::from_fn(|i| f64::max(most[i], node.values[i].abs()))
    });
    // The components of the velocity are as large as the largest of them.
    let speed = largest[0].max(largest[1]).max(largest[2]);
    let largest = [speed, speed, speed, largest[3], largest[4]];
    let alike = |pair: &[&Node]| match pair {
        [near, far] => {
            near.at[one] == far.at[one]
                && near.at[other] == far.at[other]
                && near.at[axis] < level
                && level < far.at[axis]
                && (0..5).all(|i| (near.values[i] - far.values[i]).abs() <= ALIKE * largest[i])
        }
        _ => false,
    };
    order.chunks(2).all(alike).then_some(Plane { axis, level })
}

/// The fault of a mesh that is a slice of a flow around an axis, as OpenFOAM computes it: all its points lie in two
/// planes that meet in the axis, a few degrees apart.
pub(super) fn wedge(nodes: &[Node]) -> Option<Fault> {
    /// The sine of the widest slice, and of the angle between points of one plane.
    const WIDEST: f64 = 0.35;
    const SAME: f64 = 1e-4;
    (0..3).find_map(|axis| {
        let [one, other] = [(axis + 1) % 3, (axis + 2) % 3];
        let radius = |node: &Node| node.at[one].hypot(node.at[other]);
        let largest = nodes.iter().map(radius).fold(0.0, f64::max);
        let sine = |a: &[f64; 2], b: &[f64; 2]| a[0] * b[1] - a[1] * b[0];
        let is_same = |a: &[f64; 2], b: &[f64; 2]| sine(a, b).abs() < SAME && a[0] * b[0] + a[1] * b[1] > 0.0;
        let (mut directions, mut radii) = (Vec::<[f64; 2]>::new(), Vec::<f64>::new());
        for node in nodes.iter().filter(|node| radius(node) > 1e-3 * largest) {
            let radius = radius(node);
            let direction = [node.at[one] / radius, node.at[other] / radius];
            if !directions.iter().any(|known| is_same(known, &direction)) {
                directions.push(direction);
            }
            if radii.len() < FEWEST && radii.iter().all(|known| (known - radius).abs() > SAME * largest) {
                radii.push(radius);
            }
            if directions.len() > 2 {
                return None;
            }
        }
        let [first, second] = &directions[..] else { return None };
        let is_narrow = first[0] * second[0] + first[1] * second[1] > 0.0;
        let width = if is_narrow { sine(first, second).abs() } else { WIDEST };
        (radii.len() >= FEWEST && width < WIDEST).then(|| {
            let letter = ["x", "y", "z"][axis];
            Fault::new(
                format!("is a slice of {:.0}° of a flow around {letter}, which is not read", width.to_degrees()),
                format!(
                    "turn it around {letter} to the whole circle (ParaView: Rotational Extrusion of one side, or \
                     Angular Periodic Filter) and write that"
                ),
            )
        })
    })
}

/// The different coordinates of points along an axis, up to three of them.
fn few_levels(nodes: &[Node], axis: usize) -> Vec<f64> {
    let (low, high) = bounding_box(nodes.iter().map(|node| node.at));
    let rounding = ROUNDING * (high[axis] - low[axis]);
    let mut levels: Vec<f64> = Vec::with_capacity(FEWEST);
    for node in nodes {
        if levels.iter().all(|level| (node.at[axis] - level).abs() > rounding) {
            levels.push(node.at[axis]);
            if levels.len() == FEWEST {
                break;
            }
        }
    }
    levels.sort_unstable_by(f64::total_cmp);
    levels
}

/// The place with another coordinate along an axis.
fn on_level(mut at: Vec3<f64>, axis: usize, level: f64) -> Vec3<f64> {
    *[&mut at.x, &mut at.y, &mut at.z][axis] = level;
    at
}

/// The fault of faces that do not lie in one of the planes of the coordinates.
fn tilted(faces: usize) -> Fault {
    Fault::new(
        format!(
            "has no cells with a volume, only {faces} faces, and they do not lie in one plane across x, y or z"
        ),
        "write the interior of the flow; a plane flow may be a mesh of faces in the plane of two coordinates",
    )
}
