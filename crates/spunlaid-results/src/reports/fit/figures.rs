//! Figures of a fit: the CV of the scan beside that of the simulated webs, the spectrum, and how sure
//! the values are.

use crate::numbers::significant;
use spunlaid_charts::palette::{BLUE, GREY, INK, VERMILION};
use spunlaid_charts::{Axis, Chart, Figure, Series};
use spunlaid_experiment::{Fit, FittedKey, FittedNumber, Texture};
use spunlaid_ground::{Dimension, NORMAL_95};

const MM: f64 = 1e3;
const PER_CENT: f64 = 100.0;

/// All figures of a fit.
pub fn fit_figures(fit: &Fit) -> Vec<Figure> {
    let mut figures = vec![patch_cv(fit), residuals(fit)];
    if fit.numbers.iter().any(|number| matches!(number.texture, Texture::Band { .. })) {
        figures.extend([0, 1].map(|direction| spectrum(fit, direction)));
    }
    figures.extend(fit.keys.iter().filter(|key| key.profile.len() > 1).map(profile));
    figures
}

/// Place, scan, start, fit, and the ends between which 95 of 100 simulated webs lie.
type CurveRow = (f64, f64, f64, f64, [f64; 2]);

fn drawn(place: f64, number: &FittedNumber, scale: f64) -> CurveRow {
    let [low, high] = [-NORMAL_95, NORMAL_95].map(|z| scale * number.found * (z * number.scatter).exp());
    (place, scale * number.scan, scale * number.start, scale * number.found, [low, high])
}

fn curves(chart: Chart, drawn: &[CurveRow]) -> Chart {
    let line = |value: fn(&CurveRow) -> f64| drawn.iter().map(move |one| (one.0, value(one)));
    let band = drawn.iter().map(|one| (one.0, one.4[0], one.4[1]));
    chart
        .band(Series::new("95 of 100 simulated webs", VERMILION), band)
        .line(Series::reference("start"), line(|one| one.2))
        .line(Series::new("fit, mean of the simulated webs", VERMILION).width(1.8), line(|one| one.3))
        .scatter(Series::spots("scan", BLUE), drawn.iter().map(|one| (one.0, one.1, None)))
}

/// CV over the size of the patches.
fn patch_cv(fit: &Fit) -> Figure {
    let patch = |number: &FittedNumber| match number.texture {
        Texture::Patch(side) => Some(drawn(side * MM, number, PER_CENT)),
        Texture::Band { .. } => None,
    };
    let patches: Vec<CurveRow> = fit.numbers.iter().filter_map(patch).collect();
    let chart = Chart::new(
        "fit_cv",
        "CV of the scan and of the simulated webs",
        Axis::logarithmic("Side of a patch (mm)").in_column("patch_mm"),
        Axis::logarithmic("Coefficient of variation CV (%)").in_column("cv_percent"),
    );
    Figure::new(
        &curves(chart, &patches),
        "Standard deviation of the basis weight of square patches over its mean, in pieces of web as large as the \
        part of the scan that is compared. The band contains 95 of 100 single simulated webs with the fitted \
        values; a scan of such a web is expected there too. The CV is relative to the mean of the piece, so for \
        large patches it is lower than that of the whole web.",
    )
}

/// Variance of waves in octaves, across or along the web.
fn spectrum(fit: &Fit, direction: usize) -> Figure {
    let (name, words) =
        if direction == 0 { ("fit_spectrum_cd", "cross") } else { ("fit_spectrum_md", "machine") };
    let band = |number: &FittedNumber| match number.texture {
        Texture::Band { direction: own, waves: [shortest, longest] } if own == direction => {
            Some(drawn((shortest * longest).sqrt() * MM, number, PER_CENT * PER_CENT))
        }
        _ => None,
    };
    let bands: Vec<CurveRow> = fit.numbers.iter().filter_map(band).collect();
    let chart = Chart::new(
        name,
        &format!("Spectrum in {words} direction, octave by octave"),
        Axis::logarithmic("Wavelength, middle of the octave (mm)").in_column("wavelength_mm"),
        Axis::logarithmic("Variance of the octave (%^{2})").in_column("variance_percent2"),
    );
    Figure::new(
        &curves(chart, &bands),
        format!(
            "Variance of the relative basis weight by its wavelength in {words} direction, of the scan and of the \
            simulated webs. The band contains 95 of 100 single simulated webs with the fitted values."
        ),
    )
}

/// How far the scan is from the fit.
fn residuals(fit: &Fit) -> Figure {
    let points = |wanted: &dyn Fn(&Texture) -> Option<f64>| -> Vec<(f64, f64, Option<f64>)> {
        let point = |number: &FittedNumber| Some((wanted(&number.texture)? * MM, number.residual(), None));
        fit.numbers.iter().filter_map(point).collect()
    };
    let middle = |wanted: usize| {
        points(&|texture| match texture {
            Texture::Band { direction, waves } if *direction == wanted => Some((waves[0] * waves[1]).sqrt()),
            _ => None,
        })
    };
    let patches = points(&|texture| if let Texture::Patch(side) = texture { Some(*side) } else { None });
    let (across, along) = (middle(0), middle(1));
    let ends = [&patches, &across, &along].into_iter().flatten().map(|point| point.0);
    let (from, to) = ends.fold((f64::INFINITY, 0.0_f64), |(from, to), at| (from.min(at), to.max(at)));
    let level = |height: f64| [(from, height), (to, height)];
    let mut chart = Chart::new(
        "fit_residuals",
        "Residuals of the fit",
        Axis::logarithmic("Side of a patch, or wavelength (mm)").in_column("size_mm"),
        Axis::linear("Scan minus fit (standard deviations of a web)").in_column("residual"),
    )
    .band(Series::new("95 of 100 webs", GREY), [(from, -NORMAL_95, NORMAL_95), (to, -NORMAL_95, NORMAL_95)])
    .line(Series::new("", INK).unlabelled().adorning().width(1.0), level(0.0))
    .scatter(Series::spots("CV over patches", BLUE), &patches);
    if !across.is_empty() {
        chart = chart
            .scatter(Series::triangles("spectrum across"), &across)
            .scatter(Series::spots("spectrum along", VERMILION), &along);
    }
    Figure::new(
        &chart,
        "The logarithm of the scan’s number over that of the fit, in standard deviations of that number from one \
        simulated web to another. Neighbouring sizes are correlated, so several points on one side mean little more \
        than one.",
    )
}

/// A value of a key in a unit that suits all values that are drawn, as axis title and factor.
fn axis(key: &FittedKey) -> (String, f64) {
    let parameter = &key.parameter;
    let name = &parameter.key.name;
    if parameter.key.dimension() == Dimension::Ratio {
        return (name.clone(), 1.0);
    }
    let pretty = parameter.key.dimension().pretty_to(key.value, 17);
    let (number, unit) = pretty.split_once(' ').unwrap_or((&pretty, ""));
    let factor = number.parse::<f64>().map_or(1.0, |number| number / key.value);
    (format!("{name} ({unit})"), if factor.is_finite() { factor } else { 1.0 })
}

/// The least misfit for each value of a key.
fn profile(key: &FittedKey) -> Figure {
    let (title, factor) = axis(key);
    let points = || key.profile.iter().map(|(value, misfit)| (value * factor, *misfit));
    let name = format!("fit_profile_{}", key.parameter.key.name.replace('.', "_"));
    let mut chart = Chart::new(
        &name,
        &format!("Misfit over {}", key.parameter.key.name),
        Axis::linear(&title),
        Axis::linear("Least misfit").zero_based(),
    );
    if let Ok([low, high]) = key.interval {
        chart = chart.stretch(Series::new("95 % interval", VERMILION), low * factor, high * factor);
    }
    let chart = chart
        .line(Series::new("", BLUE).unlabelled().adorning().width(1.2), points())
        .scatter(Series::spots("simulated", BLUE), points().map(|(x, y)| (x, y, None)))
        .vertical(Series::new("fit", INK), key.value * factor);
    Figure::new(
        &chart,
        format!(
            "The smallest misfit for values of {} other than the fitted one, {}. Webs were laid with each of these \
            values and the best values of the other keys for it. A flat curve means that the scan does not \
            determine this key.",
            key.parameter.key.name,
            significant(key.value * factor, 4)
        ),
    )
}
