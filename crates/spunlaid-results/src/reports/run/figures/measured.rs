//! The curves that were measured, a figure for each that is declared.

use crate::figures::with_unit;
use crate::numbers::significant;
use spunlaid_charts::palette::{BLUE, GREEN, PURPLE, VERMILION};
use spunlaid_charts::{Axis, Chart, Figure, Rose, Series, even};
use spunlaid_ground::{MeasureKind, measure};
use spunlaid_simulation::{Curve, CurveValue, FibreMeasure, Results};

/// Most places along the fibre that get markers of their own, and that a line is drawn through.
const MARKED: usize = 41;
const LINED: usize = 1001;
/// Most points over time; more are taken together.
const INSTANTS: usize = 250;

/// The figures of all curves, in the order of their declarations.
pub(super) fn figures(results: &Results) -> Vec<Figure> {
    let mut declared: Vec<&'static measure::Figure> = Vec::new();
    for curve in &results.curves {
        if !declared.iter().any(|figure| figure.name == curve.measure.figure.name) {
            declared.push(curve.measure.figure);
        }
    }
    let drawn = |figure: &'static measure::Figure| {
        let curves: Vec<&Curve> =
            results.curves.iter().filter(|curve| curve.measure.figure.name == figure.name).collect();
        one(figure, &curves, results)
    };
    declared.into_iter().map(drawn).collect()
}

/// A figure of the curves that are declared for it.
fn one(declared: &measure::Figure, curves: &[&Curve], results: &Results) -> Figure {
    let first = curves[0].measure;
    if first.kind == MeasureKind::Direction {
        return rose(declared, curves[0], results.replicates());
    }
    let (along, value) = axes(first, curves.len() == 1);
    let unit = first.kind.abscissa().map_or(1.0, |(.., unit)| unit.per_si);
    let mut chart = Chart::new(declared.name, declared.title, along, value)
        .when_empty("no values: too few recorded instants, or nothing to compare with");
    for (i, curve) in curves.iter().enumerate() {
        let places = scaled(curve, unit);
        chart = match first.kind {
            MeasureKind::Profile => profile(chart, i, curve, &places, MARKED),
            MeasureKind::Way => profile(chart, i, curve, &places, places.len()),
            MeasureKind::Lag => correlation(chart, i, curve, &places),
            MeasureKind::Series => series(chart, i, curve, &places, results.replicates()),
            MeasureKind::Number | MeasureKind::Spectrum | MeasureKind::Direction => {
                chart.line(styled(i, curve.measure.series), places.iter().map(|place| (place.at, place.mean)))
            }
        };
        if first.kind == MeasureKind::Spectrum {
            chart = with_crossings(chart, i, curve.measure.series, results);
        }
    }
    Figure::new(&chart, caption(declared, first.kind, &scaled(curves[0], 1.0), results.replicates()))
}

/// The axes of a curve: along and up.
///
/// * `alone` – whether it is the only curve of its figure
pub fn axes(first: &FibreMeasure, alone: bool) -> (Axis, Axis) {
    let declared = first.figure;
    let Some((column, abscissa, unit)) = first.kind.abscissa() else {
        return (Axis::linear(""), Axis::linear(""));
    };
    let label = with_unit(abscissa, unit.shown);
    let along = match first.kind {
        MeasureKind::Spectrum => Axis::logarithmic(&label),
        _ => Axis::linear(&label),
    };
    let along = match first.kind {
        MeasureKind::Profile | MeasureKind::Way | MeasureKind::Lag => along.including(0.0),
        MeasureKind::Direction => along.tight(),
        MeasureKind::Series => along.tight().including(0.0),
        MeasureKind::Number | MeasureKind::Spectrum => along.tight(),
    };
    // The numbers beside a figure are in the units of its axes.
    let column = column.rsplit_once('_').map_or(column, |(name, _)| name);
    let shown = unit.shown.to_lowercase();
    let value = with_unit(if alone { first.label } else { declared.title }, first.unit.shown);
    let value = match (declared.logarithmic, first.kind) {
        (true, MeasureKind::Spectrum) => Axis::logarithmic(&value).decades(9),
        (true, _) => Axis::logarithmic(&value).steady(),
        (false, _) if declared.from_zero => Axis::linear(&value).zero_based(),
        (false, _) => Axis::linear(&value),
    };
    (along.in_column(&format!("{column}_{shown}")), value)
}

/// Series in colours and marks that stay apart in grey too.
fn styled(i: usize, name: &str) -> Series {
    match i {
        0 => Series::circles(name),
        1 => Series::triangles(name),
        2 => Series::new(name, GREEN),
        _ => Series::new(name, PURPLE),
    }
}

/// The places in the units of the axes.
fn scaled(curve: &Curve, per_si: f64) -> Vec<CurveValue> {
    let factor = curve.measure.unit.per_si;
    let scaled = |place: &CurveValue| CurveValue {
        at: place.at * per_si,
        mean: place.mean * factor,
        standard_error: place.standard_error.map(|error| error * factor),
        largest: place.largest * factor,
    };
    curve.places.iter().map(scaled).collect()
}

/// A thin line with markers and error bars at so many of the places.
fn profile(chart: Chart, i: usize, curve: &Curve, places: &[CurveValue], marked: usize) -> Chart {
    let point = |place: &CurveValue| (place.at, place.mean, place.standard_error);
    let line = even(places.len(), LINED).into_iter().map(|k| (places[k].at, places[k].mean));
    let marked = even(places.len(), marked).into_iter().map(|k| point(&places[k]));
    let all = places.iter().map(point);
    let named = curve.measure.series;
    let series = styled(i, named).thinned_from(all);
    // The only curve of a figure has no name of its own.
    let series = if named.is_empty() { series.unlabelled() } else { series };
    chart.line(styled(i, "").adorning().unmarked().width(0.8), line).scatter(series, marked)
}

/// A line with a band of one standard error to both sides. What was fitted to a measured curve has its colour, dashed.
fn correlation(chart: Chart, i: usize, curve: &Curve, places: &[CurveValue]) -> Chart {
    let colour = if i.is_multiple_of(2) { BLUE } else { VERMILION };
    let points = places.iter().map(|place| (place.at, place.mean));
    let full = places.iter().map(|place| (place.at, place.mean, place.standard_error));
    let series = Series::new(curve.measure.series, colour).thinned_from(full);
    if i >= MEASURED {
        return chart.line(series.dashed(&[7.0, 4.0]).width(1.4), points);
    }
    let error = |place: &CurveValue| place.standard_error.filter(|error| error.is_finite()).unwrap_or(0.0);
    let band = places.iter().map(|place| (place.at, place.mean - error(place), place.mean + error(place)));
    chart.band(Series::new("", colour).adorning(), band).line(series.width(1.8), points)
}

/// Curves of a correlation that are measured, the first ones; the others are fitted to them.
const MEASURED: usize = 2;

/// Directions on the belt.
fn rose(declared: &measure::Figure, curve: &Curve, replicates: usize) -> Figure {
    let places = scaled(curve, 1.0);
    let rose = Rose {
        name: declared.name.to_owned(),
        title: "Directions of the laid fibre".to_owned(),
        classes: places.iter().map(|place| (place.mean, place.standard_error)).collect(),
        reference: Some((1.0, "isotropic".to_owned())),
        sides: ["MD", "CD", "against MD", "CD"].map(str::to_owned),
        columns: ["direction_degrees", "share_of_chords_times_classes"].map(str::to_owned),
        series: "laid fibre".to_owned(),
    };
    rose.figure(format!("{} {}.{}", declared.caption, declared.title, mean_sentence(replicates)))
}

/// `1 replicate`, `8 replicates`.
pub(super) fn one_of(n: usize, thing: &str) -> String {
    format!("{n} {thing}{}", if n == 1 { "" } else { "s" })
}

fn mean_sentence(replicates: usize) -> String {
    if replicates > 1 { format!(" Mean over {replicates} replicates.") } else { String::new() }
}

/// The mean over time, and a band from it to the largest of any replicate.
fn series(chart: Chart, i: usize, curve: &Curve, places: &[CurveValue], replicates: usize) -> Chart {
    let each = places.len().div_ceil(INSTANTS).max(1);
    let together = |some: &[CurveValue]| {
        let known: Vec<&CurveValue> = some.iter().filter(|place| place.mean.is_finite()).collect();
        let mean = known.iter().map(|place| place.mean).sum::<f64>() / known.len() as f64;
        let largest = known.iter().map(|place| place.largest).fold(f64::NAN, f64::max);
        (some[some.len() / 2].at, mean, largest)
    };
    let band: Vec<_> = places.chunks(each).map(together).collect();
    let all = |value: fn(&CurveValue) -> f64| places.iter().map(move |place| (place.at, value(place), None));
    let name = curve.measure.series;
    let several = replicates > 1 || each > 1;
    let label = if several { format!("{name}, mean") } else { name.to_owned() };
    // Other colours than those of y and z.
    let column = if several { format!("{name} mean") } else { name.to_owned() };
    let line = styled(i + 2, &label).named(&column).width(1.2).thinned_from(all(|place| place.mean));
    let chart = chart.line(line, band.iter().map(|&(time, mean, _)| (time, mean)));
    if !several {
        return chart;
    }
    let largest = styled(i + 2, "up to the largest").named(&format!("{name} largest"));
    chart.band(largest.thinned_from(all(|place| place.largest)), &band)
}

/// A vertical line at the crossing frequency.
fn with_crossings(chart: Chart, i: usize, series: &str, results: &Results) -> Chart {
    let axis = series.trim_matches('*');
    let frequency = results.estimate(&format!("frequency_{axis}")).mean;
    if !(frequency.is_finite() && frequency > 0.0) {
        return chart;
    }
    let label = format!("{series} crosses at {} Hz", significant(frequency, 3));
    // The dashes of one fill the gaps of the other, where both are at the same place.
    let dash = if i == 0 { &[5.0, 5.0][..] } else { &[0.0, 5.0, 5.0, 0.0] };
    let line = Series { label: Some(label), ..styled(i, "") }.named(&format!("{axis} crossing frequency"));
    chart.vertical(line.dashed(dash).width(1.2), frequency)
}

fn caption(
    declared: &measure::Figure,
    kind: MeasureKind,
    places: &[CurveValue],
    replicates: usize,
) -> String {
    let note = match (kind, replicates) {
        (MeasureKind::Spectrum, _) => {
            " Dashed: the crossing frequency, half the number of sign changes per second.".to_owned()
        }
        (_, 0 | 1) => " There is a single replicate, so there are no error bars.".to_owned(),
        (MeasureKind::Lag, n) => {
            format!(
                " Mean over {n} replicates; bands: ± one standard error of the mean. Dashed: the surrogate."
            )
        }
        (MeasureKind::Direction, n) => mean_sentence(n),
        (MeasureKind::Profile | MeasureKind::Way, n) => {
            let marked = if kind == MeasureKind::Profile && places.len() > MARKED {
                format!(" {MARKED} of {} places carry a marker.", places.len())
            } else {
                String::new()
            };
            format!(" Mean over {n} replicates; bars: ± one standard error of the mean.{marked}")
        }
        (_, n) => {
            let each = places.len().div_ceil(INSTANTS).max(1);
            let together =
                if each > 1 { format!(", {each} recorded instants at a time") } else { String::new() };
            format!(
                " Mean over {n} replicates{together}; the shaded area reaches to the largest of any replicate."
            )
        }
    };
    format!("{}{note}", declared.caption)
}
