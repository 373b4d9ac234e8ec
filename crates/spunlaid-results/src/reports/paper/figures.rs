//! The figures of the paper, drawn again: circles for y, triangles for z, with the error bars it lacks.

use crate::numbers::capitalised;
use spunlaid_charts::palette::{BLUE, GREEN, VERMILION};
use spunlaid_charts::{Axis, Chart, Figure, Series};
use spunlaid_ground::Vec3;
use spunlaid_input::paper::{LateralEstimates, Parameter, TrendPoint};
use spunlaid_simulation::{CurveValue, SpectrumPoint};

/// Millimetres per metre.
const MM: f64 = 1e3;

/// Figure 2: the air velocity along x at one place over time.
pub fn velocity_history(record: &[(f64, f64)], mean: f64) -> Figure {
    let chart = Chart::new(
        "figure_2",
        "Air velocity over time",
        Axis::linear("Time *t* (s)").tight(),
        Axis::linear("Velocity *U* (m/s)"),
    )
    .line(Series::new("velocity along x in one eddy", BLUE).width(1.0), record)
    .line(
        Series::reference("mean"),
        [(record.first().map_or(0.0, |r| r.0), mean), (record.last().map_or(1.0, |r| r.0), mean)],
    );
    Figure::new(
        &chart,
        format!(
            "Figure 2. The synthesised velocity in the first eddy of the first replicate, mean {mean} m/s."
        ),
    )
}

/// Figure 3: the energy spectrum of the velocity.
pub fn spectrum(points: &[SpectrumPoint]) -> Figure {
    let synthesised = points.iter().map(|p| (p.frequency, p.synthesised));
    let model = points.iter().filter(|p| p.wanted > 0.0).map(|p| (p.frequency, p.wanted));
    let chart = Chart::new(
        "figure_3",
        "Energy spectrum of the air velocity",
        Axis::logarithmic("Frequency *f* (Hz)").tight(),
        Axis::logarithmic("Energy *E* ((m/s)^{2}/Hz)").decades(6),
    )
    .line(Series::new("synthesised", BLUE).width(1.3), synthesised)
    .line(Series::reference("flat model").width(1.6), model);
    Figure::new(
        &chart,
        "Figure 3. The spectrum of the synthesised velocity (Welch’s estimate over components, eddies and \
         replicates) and the flat model it is made from: constant up to the cut-off and zero above. The energy \
         above the cut-off comes from the window of the estimate."
            .to_owned(),
    )
}

/// Figure 8a: the fibre at the end, magnified across.
pub fn final_shape(shape: &[Vec3<f64>]) -> Figure {
    let along = |coordinate: fn(&Vec3<f64>) -> f64| shape.iter().map(move |p| (p.x * MM, coordinate(p) * MM));
    let spots = |coordinate| along(coordinate).map(|(x, y)| (x, y, None));
    let chart = Chart::new(
        "figure_8a",
        "The fibre at the end of the run",
        Axis::linear("*x* (mm)"),
        Axis::linear("*y*, *z* (mm)"),
    )
    .line(Series::circles("y"), along(|p| p.y))
    .line(Series::triangles("z"), along(|p| p.z))
    .scatter(Series::circles("y").adorning(), spots(|p| p.y))
    .scatter(Series::triangles("z").adorning(), spots(|p| p.z));
    Figure::new(
        &chart,
        "Figure 8a. The first replicate after one second, seen from two sides; the axes across are magnified. \
         Markers are the nodes."
            .to_owned(),
    )
}

/// Figure 8b: the work check over time for several time steps [s].
pub fn step_errors(runs: &[(f64, Vec<CurveValue>)]) -> Figure {
    let mut chart = Chart::new(
        "figure_8b",
        "Error of the work for three time steps",
        Axis::linear("Time *t* (s)").tight(),
        Axis::logarithmic("Error *ε* (%)").steady(),
    )
    .sized(640.0, 380.0);
    for ((step, errors), colour) in runs.iter().zip([BLUE, GREEN, VERMILION]) {
        let each = errors.len().div_ceil(250).max(1);
        let means = errors.chunks(each).map(|some| {
            let known: Vec<f64> = some.iter().map(|e| e.mean).filter(|e| e.is_finite()).collect();
            (some[some.len() / 2].at, known.iter().sum::<f64>() / known.len() as f64)
        });
        let all = errors.iter().map(|e| (e.at, e.mean, None));
        let series = Series::new(&format!("{:.0} µs", step * 1e6), colour).width(1.2);
        chart = chart.line(series.thinned_from(all), means);
    }
    Figure::new(
        &chart,
        "Figure 8b. Work of all forces against the kinetic energy (Eq 36), mean over the replicates, for three \
         time steps."
            .to_owned(),
    )
}

/// Figures 9 to 11: amplitude, and for 9 and 10 frequency, over a parameter.
pub fn trend(parameter: Parameter, points: &[TrendPoint]) -> Vec<Figure> {
    let number = parameter.figure();
    let with_frequency = matches!(parameter, Parameter::Velocity | Parameter::Intensity);
    let name = if with_frequency { format!("figure_{number}a") } else { format!("figure_{number}") };
    let amplitude = chart(parameter, points, &name, "Amplitude", "Amplitude (mm)", |p| p.amplitude, MM);
    let mut figures = vec![amplitude];
    if with_frequency {
        let name = format!("figure_{number}b");
        figures.push(chart(parameter, points, &name, "Frequency", "Frequency (Hz)", |p| p.frequency, 1.0));
    }
    figures
}

fn chart(
    parameter: Parameter,
    points: &[TrendPoint],
    name: &str,
    what: &str,
    label: &str,
    quantity: fn(&TrendPoint) -> LateralEstimates,
    scale: f64,
) -> Figure {
    let (symbol, unit, to_unit) = parameter.unit();
    let symbol = symbol.replace("L_T", "L_{T}");
    let words = parameter.name();
    let words_up = capitalised(words);
    let title = format!("{what} over the {words}");
    let mut chart = Chart::new(
        name,
        &title,
        Axis::linear(&format!("{words_up} *{symbol}* ({unit})")),
        Axis::linear(label).zero_based(),
    );
    for (i, series) in [Series::circles("y"), Series::triangles("z")].into_iter().enumerate() {
        let spot = |p: &TrendPoint| {
            let (mean, error) = quantity(p)[i];
            (p.value * to_unit, mean * scale, error.map(|e| e * scale))
        };
        chart = chart.scatter(series, points.iter().map(spot));
    }
    let n = points.iter().map(|p| p.n).min().unwrap_or(0);
    let paper = name.trim_start_matches("figure_");
    Figure::new(
        &chart,
        format!(
            "Figure {paper}. {what} of the free end in y (circles) and z (triangles), mean over {n} replicates; \
             bars are one standard error of the mean."
        ),
    )
}
