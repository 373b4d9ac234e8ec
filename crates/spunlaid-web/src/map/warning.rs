//! What must be known of the numbers of a web before they are believed, and how it is said.

use super::few_findings::SubsampleWarning;
use spunlaid_fibre::BREAKDOWN;
use spunlaid_ground::Dimension;
use std::fmt::{Display, Formatter, Result};

/// A reason to doubt numbers of a web, or to read them with care. It is shown as a sentence without a full stop.
#[derive(Clone, Debug, PartialEq)]
pub enum WebWarning {
    /// Filaments were lost in flight, of so many.
    Lost {
        /// Number of lost ones.
        filaments: u64,
        /// Number of all that were simulated.
        of: u64,
    },
    /// Too few filaments were simulated to give what all do.
    Subsample {
        /// Sides of the patches whose CV they do not give [m].
        sides: Vec<f64>,
        /// The strongest reason.
        why: SubsampleWarning,
        /// Distance of the simulated ones [m].
        pitch: f64,
        /// Least number for each metre of a row that flies where the file leaves it open; None if all have to fly.
        enough: Option<f64>,
    },
    /// The field of charged filaments is near to that in which air breaks down.
    StrongField {
        /// The strongest field [V/m].
        field: f64,
    },
    /// The map is not as uneven as the CV that is reported, because filaments between the simulated ones are not known
    /// well.
    FilledIn {
        /// Part of their variance that is not known.
        missing: f64,
        /// Sides of the patches over which the map has another CV [m].
        sides: Vec<f64>,
        /// The CV of the map over the reported one, less one, where they differ most.
        apart: f64,
    },
    /// The map is made of pieces of the simulated sheet, and has another CV by sampling.
    Pieces {
        /// Sides of the patches over which the map has another CV [m].
        sides: Vec<f64>,
        /// The CV of the map over the reported one, less one, where they differ most.
        apart: f64,
    },
    /// The sheet that was simulated is too small for these patches, or all filaments of another layer were simulated.
    SmallSheet {
        /// Sides of the patches [m].
        sides: Vec<f64>,
    },
    /// The CV of a layer is not known to the error that was wanted.
    Unsure {
        /// The standard error that was wanted, as a fraction of the CV.
        wanted: f64,
        /// The one that was reached.
        reached: f64,
        /// The part of it that comes from the sample of filaments.
        by_sample: f64,
        /// Area that was simulated [m²].
        area: f64,
    },
    /// No fibre was simulated beside the surrogate.
    NothingFlown,
    /// Fibre lies beyond the edges of the sheet.
    CutOff {
        /// As a share of all fibre.
        share: f64,
    },
    /// The web is thinner at its edges, and these strips are left out.
    ThinEdges {
        /// Widths of the strips [m].
        margins: [f64; 2],
    },
    /// The sheet is too small for an error of the CV.
    NoError {
        /// Sides of the patches [m].
        sides: Vec<f64>,
    },
}

impl Display for WebWarning {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Lost { filaments, of } => write!(
                f,
                "{filaments} of {of} filaments {} lost in flight, and each is missing from then on: the \
                web is lighter by that, and slightly less uniform",
                if *filaments == 1 { "was" } else { "were" }
            ),
            Self::Subsample { sides, why, pitch, enough } => write!(
                f,
                "the CV over patches of {} is not known, because {}: too few filaments were simulated. \
                The map, the image and all that follows from them are no better. Simulate {}",
                millimetres(sides),
                reason(*why, *pitch),
                match enough {
                    Some(enough) => format!(
                        "as many as needed: leave web.simulated out, which simulates {enough} or more for each metre"
                    ),
                    None => "all of them, web.simulated = \"all\"".to_owned(),
                }
            ),
            Self::StrongField { field } => write!(
                f,
                "the charge of the filaments gives a field of {} at the edge of the curtain. Air breaks down at {}, \
                and at edges of metal long before, so a line would lose a part of this charge (line.charge)",
                Dimension::ElectricField.pretty_to(*field, 2),
                Dimension::ElectricField.pretty(BREAKDOWN)
            ),
            Self::Unsure { wanted, reached, by_sample, area } => {
                let left = wanted * wanted - by_sample * by_sample;
                // Most of the error of the sample does not become smaller with the area.
                let way = match left > 0.5 * wanted * wanted {
                    true => {
                        let times = (reached * reached - by_sample * by_sample) / left;
                        let times = Dimension::Ratio.pretty_to(times, 2);
                        format!(
                            "which needs about {times} times the area; raise web.time if it ended the simulation"
                        )
                    }
                    false => "which needs more filaments per metre (web.simulated)".to_owned(),
                };
                write!(
                    f,
                    "the standard error of the CV is {} % of the CV after {} m², {} % from the sample of filaments, \
                    and {} % were wanted (web.error), {way}",
                    per_cent(*reached, 2),
                    Dimension::Ratio.pretty_to(*area, 2),
                    per_cent(*by_sample, 2),
                    per_cent(*wanted, 2),
                )
            }
            Self::FilledIn { missing, sides, apart } => write!(
                f,
                "{} % of the variance of the filaments between the simulated ones is not known, so the \
                map, and what follows from it (image, thin spots, strips, light), {}; the CV in the \
                headline is not affected. Simulate more filaments for the map (web.simulated)",
                per_cent(*missing, 2),
                match sides.is_empty() {
                    true => "has too high a CV over small patches".to_owned(),
                    false => too_uneven(sides, *apart),
                }
            ),
            Self::Pieces { sides, apart } => write!(
                f,
                "the map is made of pieces of the simulated sheet, shifted at random, and {}; image, thin \
                spots, strips and light follow from it, the CV in the headline does not. Another \
                web.seed draws other pieces",
                too_uneven(sides, *apart)
            ),
            Self::SmallSheet { sides } => write!(
                f,
                "the CV over patches of {} cannot be estimated from the simulated filaments: their sheet \
                is too small for such patches, or all filaments of another layer were simulated. It is \
                the CV of the map, which is made of pieces of that sheet, and it has no error",
                millimetres(sides)
            ),
            Self::NothingFlown => write!(
                f,
                "no layer of this web has simulated fibres, so the errors are sampling errors only, and \
                it is not known how far a surrogate with these numbers is from real fibres. Compared \
                with simulated curves, its CV was up to 20 % wrong (docs/web.md)"
            ),
            Self::CutOff { share } => write!(
                f,
                "{} % of the fibre lies beyond the edges of the sheet and is cut off",
                per_cent(*share, 2)
            ),
            Self::ThinEdges { margins } => {
                let [first, last] = margins.map(|margin| digits(1e3 * margin, 3));
                write!(
                    f,
                    "the first {first} mm and the last {last} mm across the web are left out of CV, \
                    clouds and autocorrelation. The web is thinner at its edges, which reach 3 σ_CD \
                    inwards from the outermost filament (web.edges = \"cut\")"
                )
            }
            Self::NoError { sides } => write!(
                f,
                "the CV over patches of {} has no error: the sheet holds too few independent clouds or \
                streaks for one; make it larger, or lay several webs with other seeds",
                millimetres(sides)
            ),
        }
    }
}

/// How far a map is from what is reported.
fn too_uneven(sides: &[f64], apart: f64) -> String {
    format!(
        "has too {} a CV over patches of {}, by up to {} % of the CV",
        if apart > 0.0 { "high" } else { "low" },
        listed(sides),
        per_cent(apart.abs(), 2)
    )
}

/// Why a few filaments do not give what all do.
fn reason(why: SubsampleWarning, pitch: f64) -> String {
    match why {
        SubsampleWarning::Halves(patch, off) => format!(
            "every second simulated filament alone would give a CV over patches of {} that is {} % {}",
            millimetres(&[patch]),
            per_cent(off.abs(), 2),
            if off > 0.0 { "higher" } else { "lower" }
        ),
        SubsampleWarning::Own(patch) => format!(
            "over patches of {} nearly all of CV² comes from each simulated filament by itself, and what \
            is left for all filaments cannot be distinguished from zero",
            millimetres(&[patch])
        ),
        SubsampleWarning::Neighbours(correlation) => format!(
            "the simulated filaments are {} mm apart, and the positions where such neighbours land have a \
            correlation of {}",
            digits(1e3 * pitch, 3),
            digits(correlation, 2)
        ),
    }
}

/// `2, 5, 10 mm`.
fn millimetres(sides: &[f64]) -> String {
    let sides: Vec<String> = sides.iter().map(|side| digits(1e3 * side, 3)).collect();
    format!("{} mm", sides.join(", "))
}

/// `2, 5 and 10 mm`.
fn listed(sides: &[f64]) -> String {
    match sides {
        [first @ .., last] if !first.is_empty() => {
            format!("{} and {}", millimetres(first).trim_end_matches(" mm"), millimetres(&[*last]))
        }
        sides => millimetres(sides),
    }
}

fn per_cent(share: f64, count: usize) -> String {
    digits(100.0 * share, count)
}

/// A number with so many digits, and without zeros at its end.
fn digits(value: f64, count: usize) -> String {
    let decimals = count - 1;
    let rounded: f64 = format!("{value:.decimals$e}").parse().unwrap_or(value);
    format!("{rounded}").replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doubts_are_sentences_with_their_numbers() {
        let few = |enough: Option<f64>| {
            let (sides, why) = (vec![0.01, 0.02], SubsampleWarning::Halves(0.02, -0.08));
            WebWarning::Subsample { sides, why, pitch: 0.002, enough }.to_string()
        };
        let said = few(Some(1000.0));
        assert!(
            said.starts_with("the CV over patches of 10, 20 mm is not known, because every second"),
            "{said}"
        );
        assert!(
            said.contains("over patches of 20 mm that is 8 % lower")
                && said.ends_with("leave web.simulated out, which simulates 1000 or more for each metre"),
            "{said}"
        );
        assert!(few(None).ends_with("Simulate all of them, web.simulated = \"all\""), "{}", few(None));
        let filled =
            |sides: Vec<f64>| WebWarning::FilledIn { missing: 0.12, sides, apart: 0.131 }.to_string();
        let said = filled(vec![0.01, 0.02]);
        assert!(
            said.contains("has too high a CV over patches of 10 and 20 mm, by up to 13 % of the CV"),
            "{said}"
        );
        assert!(filled(Vec::new()).contains("has too high a CV over small patches; the CV"));
        let pieces = WebWarning::Pieces { sides: vec![0.05], apart: -0.07 }.to_string();
        assert!(
            pieces.contains("and has too low a CV over patches of 50 mm, by up to 7 % of the CV; image"),
            "{pieces}"
        );
        assert!(
            WebWarning::Lost { filaments: 1, of: 40 }.to_string().starts_with("1 of 40 filaments was lost")
        );
    }
}
