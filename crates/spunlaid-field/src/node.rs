//! Points with the values of the air there.

use super::fault::several_times;
use super::{fault, mean};
use spunlaid_ground::error::{by_count, counted};
use spunlaid_ground::units::shortest;
use spunlaid_ground::{Fault, FileError, Position, Vec3};
use std::cmp::Ordering;

/// A point and its values. It fills one cache line.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// [m]
    pub(super) at: [f64; 3],
    pub(super) values: Quantities,
}

/// Combines points and values after checking that the coordinates are in range.
pub(super) fn nodes(points: &[Vec3<f64>], values: Vec<Quantities>) -> Result<Vec<Node>, FileError> {
    // A list that grows would take up to twice as much.
    let mut nodes = Vec::with_capacity(points.len());
    for (point, values) in points.iter().zip(values) {
        // Adding zero turns −0 into 0, so that both count as one place.
        let at = [point.x + 0.0, point.y + 0.0, point.z + 0.0];
        check_range(&at).map_err(|fault| at_point(fault, nodes.len()))?;
        nodes.push(Node { at, values });
    }
    Ok(nodes)
}

/// The points at different places, each with the mean of the values there, and a warning where they differ.
pub(super) fn distinct(points: &[Vec3<f64>], values: &Values) -> Result<(Vec<Node>, Vec<Fault>), FileError> {
    let mut nodes = nodes(points, values.check(points.len())?)?;
    let (place_of, warning) = merge(&mut nodes)?;
    let mut number = 0..;
    nodes.retain(|_| number.next().is_some_and(|i: u32| place_of[i as usize] == i));
    Ok((nodes, warning.into_iter().collect()))
}

/// Merges points at the same place: the first of them gets the mean of their values.
///
/// Returns for each point the first point at its place, and a warning if the values of some points differed from
/// those of the first.
///
/// # Errors
/// When all points stand there several times with different air.
pub(super) fn merge(nodes: &mut [Node]) -> Result<(Vec<u32>, Option<Fault>), FileError> {
    let mut order: Vec<u32> = (0..nodes.len() as u32).collect();
    order.sort_unstable_by(|a, b| compare(&nodes[*a as usize].at, &nodes[*b as usize].at).then(a.cmp(b)));
    let mut place_of: Vec<u32> = (0..nodes.len() as u32).collect();
    let (mut differ, mut repeats) = (0, Repeats::default());
    let mut rest = order.as_slice();
    while let Some(&first) = rest.first() {
        let Node { at, values } = nodes[first as usize];
        let (group, after) = rest.split_at(rest.iter().take_while(|i| nodes[**i as usize].at == at).count());
        repeats.add(group, nodes);
        let others = group.iter().filter(|i| nodes[**i as usize].values != values).count();
        if others > 0 {
            let share = 1.0 / group.len() as f64;
            nodes[first as usize].values = mean(group.iter().map(|i| (share, &nodes[*i as usize].values)));
        }
        for i in group {
            place_of[*i as usize] = first;
        }
        differ += others as u64;
        rest = after;
    }
    repeats.check(&place_of)?;
    let warning = (differ > 0).then(|| {
        Fault::plain(format!(
            "{} {} exactly at the position of another point but {} other values; the mean of their values is used",
            counted(differ, "point"),
            by_count(differ, ("lies", "lie")),
            by_count(differ, ("has", "have")),
        ))
    });
    Ok((place_of, warning))
}

/// Velocities that differ by less than this share of the largest one are the same air, written twice [-].
const SAME_AIR: f64 = 1e-3;

/// How often places occur, and with how different air.
#[derive(Default)]
struct Repeats {
    /// Number of places that occur once, twice, ….
    places: Vec<usize>,
    fastest: f64,
    /// The two points at one place whose velocities differ most, and by how much.
    farthest: Option<([Node; 2], f64)>,
}

impl Repeats {
    /// Adds a place.
    ///
    /// * `group` – the points there
    fn add(&mut self, group: &[u32], nodes: &[Node]) {
        let length = |u: f64, v: f64, w: f64| (u * u + v * v + w * w).sqrt();
        self.places.resize(self.places.len().max(group.len()), 0);
        self.places[group.len() - 1] += 1;
        let first = nodes[group[0] as usize];
        for node in group.iter().map(|i| nodes[*i as usize]) {
            let ([u, v, w, ..], [first_u, first_v, first_w, ..]) = (node.values, first.values);
            self.fastest = self.fastest.max(length(u, v, w));
            let off = length(u - first_u, v - first_v, w - first_w);
            if off > self.farthest.map_or(0.0, |(_, most)| most) {
                self.farthest = Some(([first, node], off));
            }
        }
    }

    /// Whether the points are those of several times: each place occurs so often, or the list begins again after the
    /// last place and may end before it. Where only pieces meet, most places occur once.
    fn check(self, place_of: &[u32]) -> Result<(), FileError> {
        let Some(([one, other], off)) = self.farthest.filter(|(_, off)| *off > SAME_AIR * self.fastest)
        else {
            return Ok(());
        };
        let count = self.places.iter().sum::<usize>();
        let usual = (0..self.places.len()).max_by_key(|i| self.places[*i]).unwrap_or(0);
        // A row may be missing at some places.
        let fewer = usual.checked_sub(1).map_or(0, |fewer| self.places[fewer]);
        let each = usual > 0 && fewer <= 1.max(count / 100) && fewer + self.places[usual] == count;
        let begins = count + 1 < place_of.len()
            && place_of.iter().zip((0..count as u32).cycle()).all(|(place, number)| *place == number);
        if !each && !begins {
            return Ok(());
        }
        let speed = |node: &Node| {
            let [u, v, w, ..] = node.values;
            shortest((u * u + v * v + w * w).sqrt())
        };
        let [x, y, z] = one.at.map(shortest);
        Err(several_times(&format!(
            "has all its points several times with different air, like ({x}, {y}, {z}) m with {} and {} \
             m/s (velocities off by {} m/s)",
            speed(&one),
            speed(&other),
            shortest(off)
        ))
        .into())
    }
}

/// Orders points by z, then y, then x.
pub(super) fn compare(a: &[f64; 3], b: &[f64; 3]) -> Ordering {
    a[2].total_cmp(&b[2]).then(a[1].total_cmp(&b[1])).then(a[0].total_cmp(&b[0]))
}

/// The lowest and the highest coordinates.
pub(super) fn bounding_box(points: impl Iterator<Item = [f64; 3]>) -> ([f64; 3], [f64; 3]) {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for point in points {
        for ((low, high), x) in low.iter_mut().zip(&mut high).zip(point) {
            (*low, *high) = (low.min(x), high.max(x));
        }
    }
    (low, high)
}

/// Largest coordinate [m] and largest value [SI] that are accepted. Larger ones make volumes and squares overflow.
pub(super) const LARGEST: f64 = 1e30;

/// `C_µ` of the k-ε model. The dissipation rate is `ε = C_µ k ω`                 Wilcox 1988.
pub(super) const C_MU: f64 = 0.09;

/// Velocity along x, y and z [m/s], `k` [m²/s²] and `ε` [m²/s³] at a point.
pub(super) type Quantities = [f64; 5];

/// The values of a field at its points, in SI units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Values {
    /// Mean velocity [m/s].
    pub velocity: Vec<Vec3<f64>>,
    /// Turbulent kinetic energy `k` [m²/s²]; empty if it is not known.
    pub k: Vec<f64>,
    /// Dissipation rate `ε` [m²/s³]; empty if it is not known.
    pub epsilon: Vec<f64>,
}

impl Values {
    /// Whether both `k` and `ε` are there.
    pub(crate) fn has_turbulence(&self) -> bool {
        !self.k.is_empty() && !self.epsilon.is_empty()
    }

    /// Adds values of further points.
    pub(super) fn append(&mut self, mut more: Self) {
        self.velocity.append(&mut more.velocity);
        self.k.append(&mut more.k);
        self.epsilon.append(&mut more.epsilon);
    }

    /// The values point by point, after checking that there is one for each of `points`.
    pub(super) fn check(&self, points: usize) -> Result<Vec<Quantities>, FileError> {
        let lengths = [
            ("velocity", self.velocity.len(), false),
            ("k", self.k.len(), true),
            ("epsilon", self.epsilon.len(), true),
        ];
        for (array, found, optional) in lengths {
            if found != points && !(optional && found == 0) {
                let fault = fault::count(found, points, "values");
                return Err(FileError::from(fault).array(array));
            }
        }
        let turbulent = self.has_turbulence();
        if turbulent {
            let decay =
                self.k.iter().zip(&self.epsilon).filter(|(k, _)| **k > 0.0).map(|(_, epsilon)| *epsilon);
            if decay.clone().next().is_some() && decay.clone().all(|epsilon| epsilon == 0.0) {
                let fault = Fault::new(
                    format!(
                        "is zero at all {} points at which k is above zero, so the eddies would be infinitely long",
                        decay.count()
                    ),
                    "write the ε or ω of the solution, or leave out k, and give turbulence_intensity, \
                    length_scale and cutoff_frequency in the case",
                );
                return Err(FileError::from(fault).array("epsilon"));
            }
        }
        let mut quantities = Vec::with_capacity(points);
        for (i, velocity) in self.velocity.iter().enumerate() {
            let [k, epsilon] = if turbulent { [self.k[i], self.epsilon[i]] } else { [0.0; 2] };
            let values = [velocity.x, velocity.y, velocity.z, k, epsilon];
            check_range(&values).map_err(|fault| at_point(fault, i))?;
            quantities.push(values);
        }
        Ok(quantities)
    }
}

/// Checks that numbers are finite and small enough to compute with.
pub(super) fn check_range(numbers: &[f64]) -> Result<(), Fault> {
    match numbers.iter().find(|number| number.is_nan() || number.abs() > LARGEST) {
        None => Ok(()),
        Some(number) => Err(Fault::new(
            format!("{} is not a number between −{LARGEST:e} and {LARGEST:e}", shortest(*number)),
            "correct the value, or leave out points without one",
        )),
    }
}

/// The fault of a point, counted from 0.
pub(super) fn at_point(fault: Fault, point: usize) -> FileError {
    FileError::from(fault).at(Position::Point(point as u64 + 1))
}

/// Which arrays of a file are the velocity and the turbulence. A quantity without a name here is found by its
/// usual names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FieldLayout {
    /// Velocity: one array of three components, or two or three arrays of one, with commas between them.
    pub velocity: Option<String>,
    /// Turbulent kinetic energy `k`.
    pub k: Option<String>,
    /// Dissipation rate `ε`.
    pub epsilon: Option<String>,
    /// Specific dissipation rate `ω`.
    pub omega: Option<String>,
}
