//! The moving fibre as data of the page: instants, nodes and replicates chosen to fit, packed in 16 bits.

use super::belt;
use super::words::{count, time};
use crate::figures::swing_frequency;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use spunlaid::case::Case;
use spunlaid::ensemble::{Results, Shape, Trajectory};
use spunlaid::fibre::Root;
use spunlaid::vec3::Vec3;
use spunlaid_charts::even;

/// Most node positions in a page: 8 characters each, 3 MB in all.
pub(super) const POSITIONS: usize = 375_000;
/// Most nodes of a fibre in a picture.
const NODES: usize = 101;
/// Most instants of a picture.
const INSTANTS: usize = 2000;
/// Least instants per swing for the motion to be followed.
const PER_SWING: f64 = 16.0;

/// What the page's script draws.
pub(super) struct Frames {
    /// The data as JSON; nothing where no shapes were kept.
    pub(super) json: String,
    /// What was left out, in sentences.
    pub(super) remarks: Vec<String>,
    /// Whether it is a fed fibre above a belt.
    pub(super) fed: bool,
}

/// What `assets/frames.js` and `assets/belt.js` read.
#[derive(Serialize)]
pub(super) struct Data {
    /// Counted from 1.
    replicates: Vec<u64>,
    /// Number of nodes of a fibre of fixed length.
    #[serde(skip_serializing_if = "Option::is_none")]
    nodes: Option<usize>,
    /// [s]
    pub(super) times: Vec<f64>,
    /// A coordinate is `origin + level · step`, for x, y and z.
    origin_mm: [f64; 3],
    step_mm: [f64; 3],
    /// Of the fibre, or from the inlet to the belt.
    length_mm: f64,
    /// [m/s], zero in a vacuum.
    air_velocity: f64,
    /// [m/s²]
    gravity: f64,
    /// Whether the first node is held in place.
    held: bool,
    /// Crossing frequency of a free end [Hz].
    frequency: Option<f64>,
    /// What a fed fibre is laid on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) belt: Option<belt::Belt>,
    /// Base64 of the 16-bit levels, low byte first: per replicate, instant and node x, y, z.
    positions: String,
}

impl Data {
    /// * `points` – all positions that are drawn, in their order [m]
    pub(super) fn of<P: Iterator<Item = Vec3<f64>>>(
        case: &Case,
        trajectories: &[&Trajectory],
        times: Vec<f64>,
        points: impl Fn() -> P,
    ) -> Self {
        let (origin, step) = grid(points());
        Self {
            replicates: trajectories.iter().map(|t| t.replicate + 1).collect(),
            nodes: None,
            times,
            origin_mm: origin.map(|v| v * 1e3),
            step_mm: step.map(|v| v * 1e3),
            length_mm: 1e3 * case.line.map_or(case.fibre.length, |line| line.distance),
            air_velocity: if case.air.density > 0.0 { case.air.velocity } else { 0.0 },
            gravity: case.run.gravity,
            held: case.fibre.root != Root::Free,
            frequency: None,
            belt: None,
            positions: encode(&bytes_of(points(), origin, step)),
        }
    }

    /// What the page draws. Numbers and base64 only: nothing in it can end the script element it stands in.
    pub(super) fn frames(&self, remarks: Vec<String>) -> Option<Frames> {
        Some(Frames { json: serde_json::to_string(self).ok()?, remarks, fed: self.belt.is_some() })
    }
}

/// Which of the kept shapes are shown.
struct Choice {
    instants: Vec<usize>,
    nodes: Vec<usize>,
}

/// Chooses and packs the shapes of a run.
pub(super) fn pack(case: &Case, results: &Results) -> Option<Frames> {
    if let Some(line) = case.line {
        return belt::pack(case, line, results);
    }
    let seen: Vec<&Trajectory> =
        results.trajectories.iter().filter(|f| !f.shapes.is_empty()).take(8).collect();
    let shapes: &[Shape] = &seen.first()?.shapes;
    let same = |t: &&&Trajectory| t.shapes.len() == shapes.len();
    let trajectories: Vec<&Trajectory> = seen.iter().filter(same).copied().collect();
    let nodes = shapes.first()?.position.len();
    let frequency = swing_frequency(results);
    let (choice, remarks) = choose(shapes, nodes, trajectories.len(), frequency);
    let chosen = || {
        trajectories.iter().flat_map(|t| choice.instants.iter().map(|&i| &t.shapes[i])).flat_map(|shape| {
            choice.nodes.iter().map(|&n| shape.position.get(n).copied().unwrap_or_default())
        })
    };
    let times = choice.instants.iter().map(|&i| shapes[i].time).collect();
    let data = Data::of(case, &trajectories, times, chosen);
    Data { nodes: Some(choice.nodes.len()), frequency, ..data }.frames(remarks)
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

/// Positions as 16-bit levels, low byte first.
fn bytes_of(positions: impl Iterator<Item = Vec3<f64>>, origin: [f64; 3], step: [f64; 3]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for p in positions {
        for (value, (origin, step)) in [p.x, p.y, p.z].into_iter().zip(origin.iter().zip(step)) {
            // Saturates, and a position that is no number becomes the smallest.
            let level = ((value - origin) / step).round() as u16;
            bytes.extend_from_slice(&level.to_le_bytes());
        }
    }
    bytes
}

/// Bytes as base64.
pub(super) fn encode(bytes: &[u8]) -> String {
    STANDARD.encode(bytes)
}

/// Lowest value and step of a 16-bit grid that holds all positions, for x, y and z [m].
fn grid(positions: impl Iterator<Item = Vec3<f64>>) -> ([f64; 3], [f64; 3]) {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for p in positions {
        for (i, value) in [p.x, p.y, p.z].into_iter().enumerate().filter(|(_, v)| v.is_finite()) {
            low[i] = low[i].min(value);
            high[i] = high[i].max(value);
        }
    }
    let mut step = [1e-9; 3];
    for i in 0..3 {
        if low[i] > high[i] {
            low[i] = 0.0;
        } else if high[i] > low[i] {
            step[i] = (high[i] - low[i]) / f64::from(u16::MAX);
        }
    }
    (low, step)
}
