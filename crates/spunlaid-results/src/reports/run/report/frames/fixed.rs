//! A fibre of fixed length as data of the page: instants, nodes and replicates chosen to fit.

use super::data::{Data, Frames, POSITIONS};
use crate::page::words::{count, time};
use crate::reports::run::figures::swing_frequency;
use spunlaid_charts::even;
use spunlaid_fibre::Case;
use spunlaid_ground::Error;
use spunlaid_simulation::{Results, Shapes, Trajectory};

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
pub(super) fn pack(case: &Case, results: &Results) -> Result<Option<Frames>, Error> {
    let candidates: Vec<&Trajectory> =
        results.trajectories.iter().filter(|f| !f.shapes.is_empty()).take(8).collect();
    let Some(first) = candidates.first() else { return Ok(None) };
    let shapes = &first.shapes;
    let same = |t: &&&Trajectory| t.shapes.len() == shapes.len();
    let trajectories: Vec<&Trajectory> = candidates.iter().filter(same).copied().collect();
    let frequency = swing_frequency(results);
    let (choice, remarks) = choose(shapes, trajectories.len(), frequency)?;
    let (mut times, mut chosen) = (Vec::new(), Vec::new());
    for trajectory in &trajectories {
        times.clear();
        for &instant in &choice.instants {
            let shape = trajectory.shapes.get(instant)?.unwrap_or_default();
            times.push(shape.time);
            chosen.extend(choice.nodes.iter().map(|&n| shape.position.get(n).copied().unwrap_or_default()));
        }
    }
    let mut data = Data::new(case, &trajectories, times, || chosen.iter().copied());
    (data.nodes, data.frequency) = (Some(choice.nodes.len()), frequency);
    Ok(data.frames(remarks))
}

fn choose(
    shapes: &Shapes,
    trajectories: usize,
    frequency: Option<f64>,
) -> Result<(Choice, Vec<String>), Error> {
    let mut remarks = Vec::new();
    let nodes = shapes.most_nodes();
    let kept_nodes = even(nodes, NODES);
    if kept_nodes.len() < nodes {
        remarks.push(format!("{} of {} are drawn.", kept_nodes.len(), count(nodes as u64, "node")));
    }
    let most = (POSITIONS / (kept_nodes.len() * trajectories)).clamp(2, INSTANTS);
    let total = shapes.len();
    let interval = shapes.interval().unwrap_or(0.0);
    let coarsest = frequency.map(|f| 1.0 / (PER_SWING * f));
    if coarsest.is_some_and(|coarsest| interval > 4.0 * coarsest) {
        remarks.push(format!(
            "The shape of the fibre was kept only every {}, which is not often enough to follow the motion, so the \
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
            let first = shapes.get(first)?.unwrap_or_default().time;
            let last = shapes.last().unwrap_or_default().time;
            remarks.push(format!("The animation shows the last {} of {}.", time(last - first), time(last)));
        } else {
            instants = even(total, most);
            remarks.push(format!("The animation shows {} of {total} recorded shapes.", instants.len()));
        }
    }
    Ok((Choice { instants, nodes: kept_nodes }, remarks))
}
