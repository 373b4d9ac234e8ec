//! What happens at which frequency: the motion of the free end, the turbulence.

use super::MM;
use crate::numbers::significant;
use spunlaid::air::SpectrumShape;
use spunlaid::case::Case;
use spunlaid::ensemble::{Results, SpectrumPoint};
use spunlaid_charts::{Axis, Chart, Figure, Series, palette::GREEN};

/// The spectrum of the free end's y and z, with their crossing frequencies.
pub(super) fn motion(results: &Results) -> Figure {
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
    .line(Series::circles("*y*").unmarked(), &density(|p| p.1))
    .line(Series::triangles("*z*").unmarked(), &density(|p| p.2));
    let end = &results.end_node;
    // The dashes of one fill the gaps of the other, where both are at the same place.
    for (series, name, frequency, dash) in [
        (Series::circles(""), "y", end.frequency_y.mean, "5 5"),
        (Series::triangles(""), "z", end.frequency_z.mean, "0 5 5 0"),
    ] {
        if frequency.is_finite() && frequency > 0.0 {
            let label = format!("*{name}* crosses at {} Hz", significant(frequency, 3));
            let series = Series { label: Some(label), ..series }.named(&format!("{name} crossing frequency"));
            chart = chart.vertical(series.dashed(dash).width(1.2), frequency);
        }
    }
    let caption = "How the motion of the free end is spread over frequencies, averaged over all replicates \
                   (Welch’s method). The area under a curve is the amplitude squared. Dashed: the crossing \
                   frequency, half the number of sign changes per second."
        .to_owned();
    Figure::of(&chart, caption)
}

/// The spectrum of the turbulence, as made and as asked for.
pub(super) fn turbulence(case: &Case, turbulence: &[SpectrumPoint]) -> Figure {
    let air = &case.air;
    let cutoff = air.cutoff_frequency;
    let shown: Vec<_> = turbulence.iter().filter(|p| p.frequency <= 2.0 * cutoff).collect();
    let realised: Vec<_> = shown.iter().map(|p| (p.frequency, p.realised)).collect();
    let chart = Chart::new(
        "turbulence_spectrum",
        "Spectrum of the turbulence",
        Axis::linear("Frequency *f* (Hz)").tight(),
        Axis::linear(if air.is_uniform() {
            "Power spectral density [(m/s)²/Hz]"
        } else {
            "Power spectral density over variance (1/Hz)"
        })
        .zero_based(),
    )
    .line(Series::new("realised", GREEN), &realised);
    let what = "What the simulated turbulence holds at each frequency, averaged over components, eddies and up to eight \
                replicates";
    let rms = if air.is_uniform() {
        format!("rms {} m/s per component", significant(air.rms(), 3))
    } else {
        "each eddy’s by its own variance".to_owned()
    };
    if !air.records.is_empty() {
        let caption = format!("{what}: stretches of the record as it was measured, {rms}.");
        return Figure::of(&chart, caption);
    }
    let wanted: Vec<_> = match air.spectrum {
        SpectrumShape::Flat if air.is_uniform() => {
            let level = air.rms().powi(2) / cutoff;
            vec![(0.0, level), (cutoff, level), (cutoff, 0.0), (2.0 * cutoff, 0.0)]
        }
        _ => shown.iter().map(|p| (p.frequency, p.wanted)).collect(),
    };
    let shape = match air.spectrum {
        SpectrumShape::Flat => "flat",
        SpectrumShape::VonKarman => "von Kármán",
        SpectrumShape::Measured(_) => "measured",
    };
    let caption = format!(
        "{what}, against the {shape} spectrum asked for (dashed): {rms}, nothing above {} Hz. The lowest point and the flank \
         at the cut-off are blurred by the analysis.",
        significant(cutoff, 3),
    );
    Figure::of(&chart.line(Series::reference("wanted"), &wanted), caption)
}
