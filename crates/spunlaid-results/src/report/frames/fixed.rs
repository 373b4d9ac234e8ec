//! A fibre of fixed length as data of the page: instants, nodes and replicates chosen to fit.

use super::data::{Data, Frames, POSITIONS};
use crate::figures::swing_frequency;
use crate::report::words::{count, time};
use spunlaid::case::Case;
use spunlaid::ensemble::{Results, Shape, Trajectory};
use spunlaid_charts::even;

/// Most nodes of a fibre in a picture.
const NODES: usize = 101;
/// Most instants of a picture.
const INSTANTS: usize = 2000;
/// Least instants per swing for the motion to be followed.
const PER_SWING: f64 = 16.0;

/// Which of the kept shapes are shown.
struct Choice {
    instants: Vec<usize>,
    nodes: Vec<usize>,
}

/// Chooses and packs the shapes of a run of fibres of fixed length.
pub(super) fn pack(case: &Case, results: &Results) -> Option<Frames> {
    let candidates: Vec<&Trajectory> =
        results.trajectories.iter().filter(|f| !f.shapes.is_empty()).take(8).collect();
    let shapes: &[Shape] = &candidates.first()?.shapes;
    let same = |t: &&&Trajectory| t.shapes.len() == shapes.len();
    let trajectories: Vec<&Trajectory> = candidates.iter().filter(same).copied().collect();
    let nodes = shapes.first()?.position.len();
    let frequency = swing_frequency(results);
    let (choice, remarks) = choose(shapes, nodes, trajectories.len(), frequency);
    let chosen = || {
        trajectories.iter().flat_map(|t| choice.instants.iter().map(|&i| &t.shapes[i])).flat_map(|shape| {
            choice.nodes.iter().map(|&n| shape.position.get(n).copied().unwrap_or_default())
        })
    };
    let times = choice.instants.iter().map(|&i| shapes[i].time).collect();
    let mut data = Data::new(case, &trajectories, times, chosen);
    (data.nodes, data.frequency) = (Some(choice.nodes.len()), frequency);
    data.frames(remarks)
}

fn choose(
    shapes: &[Shape],
    nodes: usize,
    trajectories: usize,
    frequency: Option<f64>,
) -> (Choice, Vec<String>) {
    let mut remarks = Vec::new();
    let kept_nodes = even(nodes, NODES);
    if kept_nodes.len() < nodes {
        remarks.push(format!("{} of {} are drawn.", kept_nodes.len(), count(nodes as u64, "node")));
    }
    let most = (POSITIONS / (kept_nodes.len() * trajectories)).clamp(2, INSTANTS);
    let total = shapes.len();
    let interval = if total > 1 { shapes[1].time - shapes[0].time } else { 0.0 };
    let coarsest = frequency.map(|f| 1.0 / (PER_SWING * f));
    if coarsest.is_some_and(|coarsest| interval > 4.0 * coarsest) {
        remarks.push(format!(
            "The shape of the fibre was kept only every {}, which is too seldom to follow the swings, so the \
             animation jumps.",
            time(interval)
        ));
    }
    let mut instants: Vec<usize> = (0..total).collect();
    if total > most {
        let stride = total.div_ceil(most);
        let followed = coarsest.map_or(stride, |c| ((c / interval) as usize).max(1));
        if followed < stride {
            let first = total - ((most - 1) * followed + 1);
            instants = (first..total).step_by(followed).collect();
            remarks.push(format!(
                "The animation shows the last {} of {}.",
                time(shapes[total - 1].time - shapes[first].time),
                time(shapes[total - 1].time)
            ));
        } else {
            instants = even(total, most);
            remarks.push(format!("The animation shows {} of {total} recorded shapes.", instants.len()));
        }
    }
    (Choice { instants, nodes: kept_nodes }, remarks)
}
