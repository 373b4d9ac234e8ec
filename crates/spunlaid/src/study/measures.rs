//! The numbers that a study keeps of each replicate: of a fibre, of a web, or of a spinline.

use crate::ensemble::Trajectory;
use crate::layers::WebSpec;
use crate::observe::{
    ErrorRole, Figure, KELVIN, MEASURES, Measure, OF_PATCHES, OF_SPINLINES, OF_WEBS, Unit, with_errors,
};
use crate::spinline::Solution;
use crate::units::shortest;
use crate::web::Findings;

/// A number that a study keeps, as its measure is declared in [`observe`](crate::observe). That of patches
/// has their side in its name.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// Name in a study file, `amplitude_y`, `cv_10_mm`.
    pub name: String,
    /// Name in tables, with its SI unit: `amplitude_y_m`.
    pub column: String,
    /// Its label in a table: `Amplitude in y`.
    pub label: String,
    /// Its definition in words.
    pub meaning: &'static str,
    /// The unit in which it is shown.
    pub unit: Unit,
    /// Whether tables show it.
    pub is_main: bool,
    /// The figure that shows it.
    pub figure: &'static Figure,
    /// Its label in that figure.
    pub series: String,
    /// Its errors: what each is to it, and the index of the quantity that is its size.
    pub errors: Vec<(ErrorRole, usize)>,
}

impl Quantity {
    /// A declared measure, with the side of the patches in place of `#`.
    fn new<T>(measure: &'static Measure<T>, side: &str) -> Self {
        let named = |text: &str| text.replace('#', side);
        let label = match measure.name.contains('#') && !measure.label.contains('#') {
            true => format!("{}, {side} mm", measure.label),
            false => named(measure.label),
        };
        Self {
            name: named(measure.name),
            column: named(measure.column),
            label,
            meaning: measure.meaning,
            // A temperature is kept in kelvin.
            unit: if measure.zero == 0.0 { measure.unit } else { KELVIN },
            is_main: measure.is_main,
            figure: measure.figure,
            series: named(measure.series),
            errors: Vec::new(),
        }
    }

    /// The quantities that are its further errors, which more replicates do not lower, by their indices.
    pub fn further_errors(&self) -> impl Iterator<Item = usize> {
        self.errors.iter().filter(|(role, _)| *role == ErrorRole::Further).map(|(_, index)| *index)
    }
}

/// Whether studies keep a measure.
fn is_kept<T>(measure: &Measure<T>) -> bool {
    !measure.name.is_empty()
}

/// Adds the quantities of some measures, each before its errors.
fn add<T>(all: &mut Vec<Quantity>, measures: &'static [Measure<T>], side: &str) {
    for measure in measures.iter().filter(|measure| is_kept(measure)) {
        let kept = || measure.errors.iter().filter(|error| is_kept(error));
        let first = all.len() + 1;
        let errors = kept().enumerate().map(|(i, error)| (error.role, first + i)).collect();
        all.push(Quantity { errors, ..Quantity::new(measure, side) });
        all.extend(kept().map(|error| Quantity::new(error, side)));
    }
}

/// The numbers of some measures, in the order of their quantities; NaN where there is nothing.
fn numbers<T>(measures: &'static [Measure<T>], found: Option<&T>) -> impl Iterator<Item = f64> {
    let kept = with_errors(measures).filter(|measure| is_kept(measure));
    kept.map(move |measure| found.map_or(f64::NAN, |found| measure.number(found)))
}

/// The quantities of a fibre.
pub(super) fn quantities_of_fibres() -> Vec<Quantity> {
    MEASURES.iter().map(|measure| Quantity::new(measure, "")).collect()
}

/// The quantities of a spinline.
pub(super) fn quantities_of_spinlines() -> Vec<Quantity> {
    let mut all = Vec::new();
    add(&mut all, OF_SPINLINES, "");
    all
}

/// The numbers of a spinline, in the order of [`quantities_of_spinlines`].
pub(super) fn measured_of_spinline(found: &Solution) -> Measurements {
    numbers(OF_SPINLINES, Some(found)).collect()
}

/// The sides of the patches of some webs, each once, the smallest first [m].
pub(super) fn sides<'a>(webs: impl Iterator<Item = &'a WebSpec>) -> Vec<f64> {
    let mut sides: Vec<f64> = webs.flat_map(|web| web.sheet.patches.iter().copied()).collect();
    sides.sort_by(f64::total_cmp);
    sides.dedup_by(|a, b| is_same(*a, *b));
    sides
}

fn is_same(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9 * b
}

/// The quantities of some webs.
pub(super) fn quantities_of_webs<'a>(webs: impl Iterator<Item = &'a WebSpec>) -> Vec<Quantity> {
    let mut all = Vec::new();
    for side in sides(webs) {
        // In millimetres, without the rounding of the file.
        add(&mut all, OF_PATCHES, &shortest((side * 1e9).round() / 1e6));
    }
    add(&mut all, OF_WEBS, "");
    all
}

/// The numbers of a web, in the order of [`quantities_of_webs`].
///
/// * `sides` – of the patches of the study [m]
pub(super) fn measured_of_web(sides: &[f64], found: &Findings) -> Measurements {
    let of_side =
        |&side: &f64| numbers(OF_PATCHES, found.patches.iter().find(|patch| is_same(patch.map.patch, side)));
    sides.iter().flat_map(of_side).chain(numbers(OF_WEBS, Some(found))).collect()
}

/// The numbers measured on one replicate, in the order of the study's quantities, in SI units and percent.
/// NaN means that a measure does not apply.
pub type Measurements = Box<[f64]>;

/// The outcome of one replicate of one point.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Index of the point.
    pub point: u64,
    /// Index of the replicate.
    pub replicate: u64,
    /// The outcome.
    pub outcome: ReplicateOutcome,
}

/// How a replicate ended.
#[derive(Clone, Debug)]
pub enum ReplicateOutcome {
    /// It was completed and measured.
    Measured(Measurements),
    /// The computation of the fibre diverged, or it did not reach the belt.
    Lost {
        /// Node, counted from 1 at the root.
        node: u64,
        /// Time [s].
        time: f64,
    },
}

/// Compares bits, so that NaN equals NaN.
impl PartialEq for ReplicateOutcome {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Measured(a), Self::Measured(b)) => {
                a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
            }
            (Self::Lost { node: a, time: t }, Self::Lost { node: b, time: u }) => {
                a == b && t.to_bits() == u.to_bits()
            }
            _ => false,
        }
    }
}

impl ReplicateOutcome {
    /// The results of a completed replicate.
    pub fn measured(&self) -> Option<&[f64]> {
        match self {
            Self::Measured(measured) => Some(measured),
            Self::Lost { .. } => None,
        }
    }
}

/// The numbers of a trajectory.
pub fn measured(trajectory: &Trajectory) -> Measurements {
    MEASURES.iter().map(|measure| trajectory.number(measure.name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_errors_of_a_cv_follow_it_and_are_known_to_it() {
        let mut all = Vec::new();
        add(&mut all, OF_SPINLINES, "");
        add(&mut all, OF_PATCHES, "2.5");
        let errors_of = |name: &str| -> Vec<(ErrorRole, &str)> {
            let quantity = all.iter().find(|quantity| quantity.name == name);
            let errors = quantity.into_iter().flat_map(|quantity| &quantity.errors);
            errors.map(|(role, index)| (*role, all[*index].name.as_str())).collect()
        };
        assert_eq!(
            errors_of("cv_2.5_mm"),
            [
                (ErrorRole::OfOne, "cv_2.5_mm_chance"),
                (ErrorRole::Further, "cv_2.5_mm_few_fibres"),
                (ErrorRole::Further, "cv_2.5_mm_model")
            ]
        );
        assert_eq!(errors_of("cv_2.5_mm_flown"), [(ErrorRole::Always, "cv_2.5_mm_flown_error")]);
        // Its error is not kept.
        assert_eq!(errors_of("cv_2.5_mm_one_fibre"), []);
        // A temperature is kept in kelvin.
        assert!(
            all.iter().any(|quantity| quantity.column == "freezing_temperature_k" && quantity.unit == KELVIN)
        );
    }
}
