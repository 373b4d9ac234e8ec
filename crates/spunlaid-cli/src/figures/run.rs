//! The figures of a run.

use super::Figure;
use super::chart::{Chart, Series};
use super::decimate::even;
use super::draw::stacked;
use super::palette::{GREEN, GREY, INK, ORANGE, PURPLE};
use super::scale::{Axis, signed};
use spunlaid::case::Case;
use spunlaid::ensemble::{ErrorOverTime, NodeResults, Results, Sample, SpectrumPoint};

/// Millimetres per metre.
const MM: f64 = 1e3;
/// Most points of the end node's path that are drawn.
const PATH_POINTS: usize = 20_000;
/// Most nodes of a fibre that get markers of their own.
const MARKED_NODES: usize = 41;

/// The figures of a run, in the order a reader wants them; those that would be empty for a reason (no
/// turbulence) are left out.
pub(crate) fn run_figures(case: &Case, results: &Results, turbulence: &[SpectrumPoint]) -> Vec<Figure> {
    let samples = results.flights.first().map_or(&[][..], |flight| &flight.samples);
    let mut figures = vec![
        end_node_history(case, samples),
        end_node_path(case, samples),
        amplitude_along_fibre(case, &results.nodes),
        motion_spectrum(results),
    ];
    if !turbulence.is_empty() {
        figures.push(turbulence_spectrum(case, turbulence));
    }
    figures.push(energy_errors(case, &results.errors));
    figures
}

fn figure(chart: &Chart, caption: String) -> Figure {
    Figure { name: chart.name.clone(), title: chart.title.clone(), caption, svg: chart.svg() }
}

fn end_node_history(case: &Case, samples: &[Sample]) -> Figure {
    let y: Vec<_> = samples.iter().map(|s| (s.time, s.end.y * MM)).collect();
    let z: Vec<_> = samples.iter().map(|s| (s.time, s.end.z * MM)).collect();
    let mut chart = Chart::new(
        "end_node_history",
        "Free end over time",
        Axis::linear("Time *t* (s)").tight(),
        Axis::linear("Position of the free end (mm)"),
    );
    let spin_up = case.run.spin_up();
    if spin_up > 0.0 {
        chart = chart.stretch(Series::new("spin-up, not in the statistics", GREY), 0.0, spin_up);
    }
    let chart = chart.line(Series::y("*y*"), &y).line(Series::z("*z*"), &z);
    let caption =
        "Sideways position of the fibre’s free end in the first replicate: y (blue, circles) and z \
                   (vermilion, triangles), both across the mean flow. The amplitude of the table is the \
                   standard deviation of such a curve over time; its frequency is half the number of sign \
                   changes per second."
            .to_owned();
    figure(&chart, caption)
}

fn end_node_path(case: &Case, samples: &[Sample]) -> Figure {
    let flown: Vec<&Sample> = samples.iter().filter(|s| s.time >= case.run.spin_up()).collect();
    let drawn = &flown[flown.len().saturating_sub(PATH_POINTS)..];
    let points: Vec<_> = drawn.iter().map(|s| (s.end.y * MM, s.end.z * MM)).collect();
    let first: Vec<_> = points.first().map(|&(y, z)| (y, z, None)).into_iter().collect();
    let last: Vec<_> = points.last().map(|&(y, z)| (y, z, None)).into_iter().collect();
    let chart = Chart::new(
        "end_node_path",
        "Path of the free end across the flow",
        Axis::linear("*y* (mm)"),
        Axis::linear("*z* (mm)"),
    )
    .sized(520.0, 500.0)
    .equal()
    .path(Series::new("path of the free end", GREEN).width(1.0), &points)
    .scatter(Series::spots("first", INK), &first)
    .scatter(Series::spots("last", ORANGE), &last);
    let part = match (drawn.first(), drawn.len() < flown.len()) {
        (Some(s), true) => format!(" Only the path from {} s on is drawn.", signed(s.time, 3)),
        _ => String::new(),
    };
    let caption = format!(
        "The way of the free end seen along the mean flow, first replicate, same scale in both directions.{part}"
    );
    figure(&chart, caption)
}

fn amplitude_along_fibre(case: &Case, nodes: &[NodeResults]) -> Figure {
    type Axis3 = fn(&NodeResults) -> (f64, Option<f64>);
    let marked = even(nodes.len(), MARKED_NODES);
    let lined = even(nodes.len(), 1001);
    let scatter = |axis: Axis3| -> Vec<_> {
        let point = |&i: &usize| {
            let (mean, error) = axis(&nodes[i]);
            (nodes[i].distance * MM, mean * MM, error.map(|e| e * MM))
        };
        marked.iter().map(point).collect()
    };
    let line = |axis: Axis3| -> Vec<_> {
        lined.iter().map(|&i| (nodes[i].distance * MM, axis(&nodes[i]).0 * MM)).collect()
    };
    let (y, z): (Axis3, Axis3) = (|n| n.amplitude_y, |n| n.amplitude_z);
    let thin = |series: Series| series.unlabelled().unmarked().width(0.8);
    let chart = Chart::new(
        "amplitude_along_fibre",
        "Amplitude along the fibre",
        Axis::linear("Distance from the root along the fibre (mm)").including(0.0),
        Axis::linear("Amplitude (mm)").from_zero(),
    )
    .line(thin(Series::y("")), &line(y))
    .line(thin(Series::z("")), &line(z))
    .scatter(Series::y("*y*"), &scatter(y))
    .scatter(Series::z("*z*"), &scatter(z));
    let replicates = match case.run.replicates {
        0 | 1 => "a single replicate, so without error bars".to_owned(),
        n => format!("mean over {n} replicates, bars: ± one standard error of the mean"),
    };
    let nodes_shown = if marked.len() < nodes.len() {
        format!(" {} of the {} nodes carry a marker.", marked.len(), nodes.len())
    } else {
        String::new()
    };
    let caption = format!(
        "How far each node swings: the standard deviation of its y (circles) and z (triangles) over time, \
         {replicates}.{nodes_shown}"
    );
    figure(&chart, caption)
}

fn motion_spectrum(results: &Results) -> Figure {
    let density = |axis: fn(&(f64, f64, f64)) -> f64| -> Vec<_> {
        results.motion_spectrum.iter().map(|p| (p.0, axis(p) * MM * MM)).collect()
    };
    let mut chart = Chart::new(
        "motion_spectrum",
        "Spectrum of the motion",
        Axis::logarithmic("Frequency *f* (Hz)").tight(),
        Axis::logarithmic("Power spectral density (mm²/Hz)").decades(9),
    )
    .when_empty("too few recorded instants, or no motion")
    .line(Series::y("*y*").unmarked(), &density(|p| p.1))
    .line(Series::z("*z*").unmarked(), &density(|p| p.2));
    let end = &results.end_node;
    // The dashes of one fill the gaps of the other, where both are at the same place.
    for (series, name, frequency, dash) in [
        (Series::y(""), "y", end.frequency_y.mean, "5 5"),
        (Series::z(""), "z", end.frequency_z.mean, "0 5 5 0"),
    ] {
        if frequency.is_finite() && frequency > 0.0 {
            let label = format!("*{name}* crosses at {} Hz", significant(frequency, 3));
            let series = Series { label: Some(label), ..series };
            chart = chart.vertical(series.dashed(dash).width(1.2), frequency);
        }
    }
    let caption = "How the motion of the free end is spread over frequencies, averaged over all replicates \
                   (Welch’s method). The area under a curve is the amplitude squared. Dashed: the crossing \
                   frequency, half the number of sign changes per second."
        .to_owned();
    figure(&chart, caption)
}

fn turbulence_spectrum(case: &Case, turbulence: &[SpectrumPoint]) -> Figure {
    let cutoff = case.air.cutoff_frequency;
    let shown: Vec<_> = turbulence.iter().filter(|p| p.frequency <= 2.0 * cutoff).collect();
    let realised: Vec<_> = shown.iter().map(|p| (p.frequency, p.realised)).collect();
    let level = case.air.rms().powi(2) / cutoff;
    let wanted = [(0.0, level), (cutoff, level), (cutoff, 0.0), (2.0 * cutoff, 0.0)];
    let chart = Chart::new(
        "turbulence_spectrum",
        "Spectrum of the turbulence",
        Axis::linear("Frequency *f* (Hz)").tight(),
        Axis::linear("Power spectral density [(m/s)²/Hz]").from_zero(),
    )
    .line(Series::new("realised", GREEN), &realised)
    .line(Series::reference("wanted"), &wanted);
    let caption = format!(
        "What the simulated turbulence holds at each frequency, averaged over components, eddies and up to \
         eight replicates, against the flat spectrum asked for (dashed): rms {} m/s per component, nothing \
         above {} Hz. The lowest point and the flank at the cut-off are blurred by the analysis.",
        significant(case.air.rms(), 3),
        significant(cutoff, 3),
    );
    figure(&chart, caption)
}

fn energy_errors(case: &Case, errors: &[ErrorOverTime]) -> Figure {
    type Pick = fn(&ErrorOverTime) -> (f64, f64);
    let panel = |name: &str, label: &str, colour, pick: Pick| {
        let mean: Vec<_> = errors.iter().map(|e| (e.time, pick(e).0)).collect();
        let band: Vec<_> = errors.iter().map(|e| (e.time, pick(e).0, pick(e).1)).collect();
        let x = Axis::linear("").tight().including(0.0);
        let chart = Chart::new(name, "", x, Axis::logarithmic("Error (%)").decades(9))
            .when_empty("no energy to compare with");
        if case.run.replicates > 1 {
            let label = format!("{label}, mean over the replicates");
            chart
                .line(Series::new(&label, colour).width(1.1), &mean)
                .band(Series::new("up to the largest", colour), &band)
        } else {
            chart.line(Series::new(label, colour).width(1.1), &mean)
        }
    };
    let work = panel("work_check", "work check", PURPLE, |e| e.work);
    let mut balance = panel("energy_balance", "energy balance", GREEN, |e| e.balance);
    balance.x.label = "Time *t* (s)".to_owned();
    let title = "Errors of the energy over time";
    Figure {
        name: "energy_errors".to_owned(),
        title: title.to_owned(),
        caption:
            "Two checks on the computation, mean and largest over the replicates. Work check: the work of \
                  all forces against the kinetic energy. Energy balance: kinetic and elastic energy less the \
                  work of gravity, air and damping, relative to the work of the air. Both would be zero with \
                  an infinitely small time step."
                .to_owned(),
        svg: stacked(title, &[&work.sized(640.0, 230.0), &balance.sized(640.0, 250.0)]),
    }
}

/// A number to so many significant digits, plainly.
pub(crate) fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return signed(value, 0);
    }
    let magnitude = value.abs().log10().floor() as i32;
    let decimals = (digits - 1 - magnitude).max(0) as usize;
    let text = signed(value, decimals);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
