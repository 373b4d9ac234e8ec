//! Points with the values of the air there.

use super::mean;
use super::values::{Quantities, Values, at_point, check_range};
use crate::error::{Fault, FileError, by_count, counted};
use crate::vec3::Vec3;
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
    let (place_of, warning) = merge(&mut nodes);
    let mut number = 0..;
    nodes.retain(|_| number.next().is_some_and(|i: u32| place_of[i as usize] == i));
    Ok((nodes, warning.into_iter().collect()))
}

/// Merges points at the same place: the first of them gets the mean of their values.
///
/// Returns for each point the first point at its place, and a warning if the values of some points differed from
/// those of the first.
pub(super) fn merge(nodes: &mut [Node]) -> (Vec<u32>, Option<Fault>) {
    let mut order: Vec<u32> = (0..nodes.len() as u32).collect();
    order.sort_unstable_by(|a, b| compare(&nodes[*a as usize].at, &nodes[*b as usize].at).then(a.cmp(b)));
    let mut place_of: Vec<u32> = (0..nodes.len() as u32).collect();
    let mut differ = 0;
    let mut rest = order.as_slice();
    while let Some(&first) = rest.first() {
        let Node { at, values } = nodes[first as usize];
        let (group, after) = rest.split_at(rest.iter().take_while(|i| nodes[**i as usize].at == at).count());
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
    let warning = (differ > 0).then(|| {
        Fault::plain(format!(
            "{} {} exactly at the place of another point but {} other values; the mean of their values is used",
            counted(differ, "point"),
            by_count(differ, ("lies", "lie")),
            by_count(differ, ("has", "have")),
        ))
    });
    (place_of, warning)
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
