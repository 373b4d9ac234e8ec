//! What happens at which frequency: the motion of the free end, the turbulence.

use crate::numbers::significant;
use spunlaid_air::SpectrumShape;
use spunlaid_charts::palette::GREEN;
use spunlaid_charts::{Axis, Chart, Figure, Series};
use spunlaid_fibre::Case;
use spunlaid_simulation::SpectrumPoint;

/// The spectrum of the turbulence, as made and as asked for.
pub(super) fn turbulence(case: &Case, turbulence: &[SpectrumPoint]) -> Figure {
    let air = &case.air;
    let cutoff = air.cutoff_frequency;
    let shown = || turbulence.iter().filter(|p| p.frequency <= 2.0 * cutoff);
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
    .line(Series::new("realised", GREEN), shown().map(|p| (p.frequency, p.synthesised)));
    let what =
        "Spectrum of the simulated turbulence, averaged over components, eddies and up to eight replicates";
    let rms = if air.is_uniform() {
        format!("the rms is {} m/s per component", significant(air.rms(), 3))
    } else {
        "the spectrum of each eddy is divided by its variance".to_owned()
    };
    if !air.records.is_empty() {
        let caption =
            format!("{what}. The turbulence consists of stretches of the record as it was measured; {rms}.");
        return Figure::new(&chart, caption);
    }
    let model: Vec<_> = match air.spectrum {
        SpectrumShape::Flat if air.is_uniform() => {
            let level = air.rms().powi(2) / cutoff;
            vec![(0.0, level), (cutoff, level), (cutoff, 0.0), (2.0 * cutoff, 0.0)]
        }
        _ => shown().map(|p| (p.frequency, p.wanted)).collect(),
    };
    let shape = match air.spectrum {
        SpectrumShape::Flat => "flat",
        SpectrumShape::VonKarman => "von Kármán",
        SpectrumShape::Measured(_) => "measured",
    };
    let caption = format!(
        "{what}, compared with the {shape} spectrum of the case (dashed); {rms}. There is no energy above {} Hz. \
        The analysis smooths the lowest point and the edge at the cut-off.",
        significant(cutoff, 3),
    );
    Figure::new(&chart.line(Series::reference("wanted"), &model), caption)
}
