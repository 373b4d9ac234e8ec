//! A fed fibre above its moving belt as data of the page. Every node keeps its number in the order of feed, so that the
//! page can follow it from one instant to the next, although the number of nodes changes.

use super::data::{Belt, Data, Frames, LaidPoints, POSITIONS, encode};
use crate::page::words::{count, time};
use spunlaid_fibre::{Case, Line};
use spunlaid_ground::{Error, Vec3};
use spunlaid_simulation::{Results, Shape, Trajectory};

/// Most nodes of a fibre in the air that are drawn.
const NODES: usize = 500;
/// Instants that are wanted before another replicate is packed.
const INSTANTS: usize = 300;
/// Most replicates, instants and laid points of a replicate.
const REPLICATES: usize = 8;
const MOST_INSTANTS: usize = 1000;
const LAID: usize = 8192;
/// Length of belt that is shown behind the inlet: in distances from the inlet to the belt at least and at most, and in
/// widths of the laydown.
const SHOWN: (f64, f64) = (0.6, 3.0);
const WIDTHS: f64 = 4.0;

/// The nodes of a run that are shown: each `stride`-th in the order of feed.
struct NodeChoice<'a> {
    case: &'a Case,
    line: Line,
    stride: u64,
    /// Number of the root at the start.
    first_root: u64,
    /// Length of belt that is shown behind the inlet [m].
    shown: f64,
}

impl NodeChoice<'_> {
    /// Number of the root at a time.
    fn root(&self, time: f64) -> u64 {
        let step = (time / self.case.run.time_step).round() as u64;
        self.first_root + step / self.line.steps_per_element
    }

    /// The chosen nodes of a shape, the newest first, and the strided number of the newest.
    fn nodes(&self, trajectory: &Trajectory, instant: usize) -> Result<(u64, Vec<Vec3<f64>>), Error> {
        let Some(shape) = trajectory.shapes.get(instant)? else { return Ok((0, Vec::new())) };
        let skipped = self.root(shape.time) % self.stride;
        let nodes = shape.position.iter().skip(skipped as usize).step_by(self.stride as usize);
        Ok((self.root(shape.time) / self.stride, nodes.copied().collect()))
    }

    /// Number of the oldest node of a shape.
    fn oldest(&self, Outline { time, nodes }: Outline) -> u64 {
        (self.root(time) + 1).saturating_sub(nodes as u64)
    }

    /// Number of a laid point.
    fn number(&self, fed: f64) -> u64 {
        (fed / self.case.fibre.rest_length()).round() as u64
    }
}

/// When a shape was kept [s], and its number of nodes.
#[derive(Clone, Copy)]
struct Outline {
    time: f64,
    nodes: usize,
}

/// A replicate, and the outlines of its shapes.
type Replicate<'a> = (&'a Trajectory, Vec<Outline>);

fn outline_shapes(trajectory: &Trajectory) -> Result<Replicate<'_>, Error> {
    let outline = |shape: Shape| Outline { time: shape.time, nodes: shape.position.len() };
    let outlines = trajectory.shapes.iter().map(|shape| shape.map(outline));
    Ok((trajectory, outlines.collect::<Result<_, _>>()?))
}

/// Chooses and packs the shapes and laid points of a run of fed fibres.
pub(super) fn pack(case: &Case, line: Line, results: &Results) -> Result<Option<Frames>, Error> {
    let simulated: Vec<&Trajectory> = results.trajectories.iter().filter(|t| !t.shapes.is_empty()).collect();
    let Some(first) = simulated.first() else { return Ok(None) };
    let shapes = &first.shapes;
    let longest = shapes.most_nodes();
    let mut deflection = 0.0_f64;
    let mut first_root = None;
    for shape in shapes.iter() {
        let position = shape?.position;
        first_root.get_or_insert((position.len() as u64).saturating_sub(1));
        let aside = position.iter().map(|p| p.z.abs()).filter(|z| z.is_finite());
        deflection = aside.fold(deflection, f64::max);
    }
    let first_root = first_root.unwrap_or_default();
    let shown = (WIDTHS * deflection).clamp(SHOWN.0 * line.distance, SHOWN.1 * line.distance);
    let chosen = NodeChoice { case, line, stride: longest.div_ceil(NODES) as u64, first_root, shown };
    let nodes = longest / chosen.stride as usize + 1;
    let replicates = (POSITIONS / (nodes * INSTANTS)).clamp(1, REPLICATES);
    let trajectories: Vec<&Trajectory> =
        simulated.iter().filter(|t| t.shapes.len() == shapes.len()).take(replicates).copied().collect();
    let most = (POSITIONS / (nodes * trajectories.len())).clamp(2, MOST_INSTANTS);
    let fibres = trajectories.iter().map(|t| outline_shapes(t)).collect::<Result<Vec<_>, _>>()?;
    let instants = instants(&chosen, &fibres, most);

    type Nodes = (u64, Vec<Vec3<f64>>);
    let chosen_nodes = |t: &&Trajectory| instants.clone().map(|i| chosen.nodes(t, i)).collect();
    let all: Vec<Vec<Nodes>> = trajectories.iter().map(chosen_nodes).collect::<Result<_, Error>>()?;
    let points = || all.iter().flatten().flat_map(|(_, nodes)| nodes.iter().copied());
    let outlines = fibres.first().map_or(&[][..], |(_, outlines)| outlines);
    let times: Vec<f64> = outlines[instants.clone()].iter().map(|outline| outline.time).collect();
    let belt = Belt {
        speed: line.belt_speed,
        feed_speed: line.feed_speed,
        shown_mm: shown * 1e3,
        newest: all.iter().take(1).flatten().map(|(newest, _)| *newest).collect(),
        counts: all.iter().map(|instants| instants.iter().map(|(_, nodes)| nodes.len()).collect()).collect(),
        laid: trajectories.iter().map(|t| laid(&chosen, t, &times)).collect(),
    };
    let mut data = Data::new(case, &trajectories, times, points);
    data.belt = Some(belt);
    let mut remarks = vec![format!(
        "The belt moves at {} m/s and carries the fibre to the right.",
        crate::numbers::number(line.belt_speed)
    )];
    if chosen.stride > 1 {
        remarks.push(format!("One of {} is drawn.", count(chosen.stride, "node")));
    }
    if instants.len() < shapes.len()
        && let (Some(first), Some(last)) = (data.times.first(), data.times.last())
    {
        remarks.push(format!("The animation shows {} of {}.", time(last - first), time(case.run.duration())));
    }
    Ok(data.frames(remarks))
}

/// The last instants at which the laid points that are kept go on where the fibre in the air ends, in all replicates.
fn instants(chosen: &NodeChoice<'_>, fibres: &[Replicate<'_>], most: usize) -> std::ops::Range<usize> {
    let goes_on = |instant: usize| {
        fibres.iter().all(|(t, outlines)| {
            let number = |point: Option<&spunlaid_fibre::LaidPoint>| point.map(|p| chosen.number(p.fed));
            let (Some(first), Some(last)) = (number(t.laid.first()), number(t.laid.last())) else {
                return false;
            };
            (first..=last + 1).contains(&chosen.oldest(outlines[instant]))
        })
    };
    let outlines = fibres.first().map_or(&[][..], |(_, outlines)| outlines);
    let total = outlines.len();
    let Some(end) = (0..total).rfind(|&instant| goes_on(instant)) else {
        return total.saturating_sub(most)..total;
    };
    let start = (0..end).find(|&instant| goes_on(instant)).unwrap_or(end);
    // Some belt has been covered before the picture begins, if there is time for it.
    let covered = chosen.shown / chosen.line.belt_speed;
    let middle = (start..end).find(|&i| outlines[i].time >= outlines[start].time + covered).unwrap_or(start);
    let start = middle.min(start + (end - start) / 3);
    start.max((end + 1).saturating_sub(most))..end + 1
}

/// The laid points that can be seen between the first and the last of the times.
fn laid(chosen: &NodeChoice<'_>, trajectory: &Trajectory, times: &[f64]) -> LaidPoints {
    let duration = chosen.shown / chosen.line.belt_speed;
    let from = times.first().map_or(0.0, |time| time - 1.5 * duration);
    let points = trajectory
        .laid
        .iter()
        .filter(|p| p.time >= from && chosen.number(p.fed).is_multiple_of(chosen.stride));
    let points: Vec<_> = points.take(LAID).collect();
    let first = points.first().map_or(0, |p| chosen.number(p.fed) / chosen.stride);
    let numbers = points.iter().flat_map(|p| [p.md, p.cd]).map(|v| (v * 1e3) as f32);
    LaidPoints { first, points: encode(&numbers.flat_map(f32::to_le_bytes).collect::<Vec<u8>>()) }
}
