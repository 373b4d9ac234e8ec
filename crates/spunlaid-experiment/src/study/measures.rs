//! The numbers that a study keeps of each replicate: of a fibre, of a web, or of a spinline.

use spunlaid_fibre::{SPINLINE_MEASURES, Solution};
use spunlaid_ground::units::shortest;
use spunlaid_ground::{
    ErrorRole, Figure, Formula, KELVIN, Known, Measure, PER_SQUARE_METRE, Unit, Value, measure,
};
use spunlaid_simulation::{MEASURES, Trajectory, WebSpec};
use spunlaid_web::map::Findings;
use spunlaid_web::{
    ABOUT, FABRIC_MEASURES, FABRIC_PATCH_MEASURES, Fabric, FabricPatch, NONE_FOUND, PATCH_MEASURES,
    PATCHES as FABRIC_PATCHES, STRIP_MEASURES, WEB_MEASURES,
};

/// A number that a study keeps, as its [`Measure`] declares it. That of patches
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
    /// A declared measure, of one part of what is measured.
    fn new<T>(measure: &'static Measure<T>, part: &Part) -> Self {
        let named = |text: &str| text.replace('#', &part.name);
        let label = match measure.name.contains('#') && !measure.label.contains('#') {
            true => format!("{}, {}", measure.label, part.words),
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

    /// The standard error that a number of a fabric has by itself.
    fn error_of(known: &Self) -> Self {
        let (name, unit) = (known.name.as_str(), known.column.strip_prefix(&known.name).unwrap_or_default());
        Self {
            name: format!("{name}_error"),
            column: format!("{name}_error{unit}"),
            label: format!("Error of: {}", known.label),
            meaning: "sampling error: standard error from the positions on one web",
            is_main: false,
            figure: NONE,
            series: String::new(),
            errors: Vec::new(),
            ..known.clone()
        }
    }

    /// The quantities that are its further errors, which more replicates do not lower, by their indices.
    pub fn further_errors(&self) -> impl Iterator<Item = usize> {
        self.errors.iter().filter(|(role, _)| *role == ErrorRole::Further).map(|(_, index)| *index)
    }
}

/// The figure of what no figure shows.
const NONE: &Figure = Measure::<Fabric>::NUMBER.figure;

/// A part of what is measured: the patches of one size, the strips in one direction.
struct Part {
    /// What stands in names in place of `#`: `10`.
    name: String,
    /// The same in labels: `10 mm`.
    words: String,
}

impl Part {
    /// Patches of a side [m].
    fn patches(side: f64) -> Self {
        // In millimetres, without the rounding of the file.
        let name = shortest((side * 1e9).round() / 1e6);
        Self { words: format!("{name} mm"), name }
    }

    /// Strips along MD, or along CD.
    fn strips(direction: &str) -> Self {
        Self { name: direction.to_lowercase(), words: direction.to_owned() }
    }

    /// All that is measured.
    const fn whole() -> Self {
        Self { name: String::new(), words: String::new() }
    }
}

/// Directions of the strips, in the order of [`Fabric::strips`].
const DIRECTIONS: [&str; 2] = ["MD", "CD"];
/// Side of the patches of a fabric that tables show [m]: the clouds that the eye sees first.
const SHOWN_PATCH: f64 = 10e-3;

/// Whether studies keep a measure.
fn is_kept<T>(measure: &Measure<T>) -> bool {
    !measure.name.is_empty()
}

/// Adds the quantities of some measures, each before its errors.
fn add<T>(all: &mut Vec<Quantity>, measures: &'static [Measure<T>], part: &Part) {
    for measure in measures.iter().filter(|measure| is_kept(measure)) {
        let kept = || measure.errors.iter().filter(|error| is_kept(error));
        let first = all.len() + 1;
        let mut known = Quantity::new(measure, part);
        known.errors = kept().enumerate().map(|(i, error)| (error.role, first + i)).collect();
        if has_own_error(measure) {
            known.errors.push((ErrorRole::OfOne, first));
            all.extend([known.clone(), Quantity::error_of(&known)]);
        } else {
            all.push(known);
            all.extend(kept().map(|error| Quantity::new(error, part)));
        }
    }
}

/// Whether the value of a measure comes with its error.
const fn has_own_error<T>(measure: &Measure<T>) -> bool {
    matches!(measure.formula, Formula::Reported(_))
}

/// Adds the numbers of some measures, in the order of their quantities; NaN where there is nothing.
fn enter<T>(all: &mut Vec<f64>, measures: &'static [Measure<T>], found: Option<&T>) {
    for measure in measure::with_errors(measures).filter(|measure| is_kept(measure)) {
        match found.and_then(|found| measure.value(found)) {
            Some(Value::Reported(known)) => all.extend(of_one_web(known, measure.unit)),
            value if has_own_error(measure) => {
                all.extend([value.map_or(f64::NAN, |value| value.number()); 2])
            }
            value => all.push(value.map_or(f64::NAN, |value| value.number())),
        }
    }
}

/// What one of several webs reports of a number, and its error. A bound says nothing of a mean, but where none
/// were found on a sheet there are zero, as likely as one.
fn of_one_web(known: Known, unit: Unit) -> [f64; 2] {
    match known {
        Known::Value(value, error) => [value, error.unwrap_or(f64::NAN)],
        Known::AtMost(bound) if unit == PER_SQUARE_METRE => [0.0, bound / NONE_FOUND],
        Known::Exact(_) | Known::Between(_) => [known.value(), f64::NAN],
        Known::AtMost(_) | Known::AtLeast(_) => [f64::NAN; 2],
    }
}

/// The quantities of a fibre.
pub(super) fn quantities_of_fibres() -> Vec<Quantity> {
    MEASURES.iter().map(|measure| Quantity::new(measure, &Part::whole())).collect()
}

/// The quantities of a spinline.
pub(super) fn quantities_of_spinlines() -> Vec<Quantity> {
    let mut all = Vec::new();
    add(&mut all, SPINLINE_MEASURES, &Part::whole());
    all
}

/// The numbers of a spinline, in the order of [`quantities_of_spinlines`].
pub(super) fn measured_of_spinline(found: &Solution) -> Measurements {
    let mut all = Vec::new();
    enter(&mut all, SPINLINE_MEASURES, Some(found));
    all.into()
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

/// The quantities of some webs and of their fabrics.
pub(super) fn quantities_of_webs<'a>(webs: impl Iterator<Item = &'a WebSpec>) -> Vec<Quantity> {
    let mut all = Vec::new();
    for side in sides(webs) {
        add(&mut all, PATCH_MEASURES, &Part::patches(side));
    }
    add(&mut all, WEB_MEASURES, &Part::whole());
    add(&mut all, FABRIC_MEASURES, &Part::whole());
    let mut add_part = |is_shown: bool, add: &dyn Fn(&mut Vec<Quantity>)| {
        let first = all.len();
        add(&mut all);
        all[first..].iter_mut().for_each(|quantity| quantity.is_main &= is_shown);
    };
    for side in FABRIC_PATCHES {
        add_part(is_same(side, SHOWN_PATCH), &|all| add(all, FABRIC_PATCH_MEASURES, &Part::patches(side)));
    }
    for direction in DIRECTIONS {
        add_part(true, &|all| add(all, STRIP_MEASURES, &Part::strips(direction)));
    }
    all
}

/// The numbers of a web and of its fabric, in the order of [`quantities_of_webs`].
///
/// * `sides` – of the patches of the study [m]
pub(super) fn measured_of_web(sides: &[f64], found: &Findings, fabric: &Fabric) -> Measurements {
    let mut all = Vec::new();
    for &side in sides {
        enter(&mut all, PATCH_MEASURES, found.patches.iter().find(|patch| is_same(patch.map.patch, side)));
    }
    enter(&mut all, WEB_MEASURES, Some(found));
    enter(&mut all, FABRIC_MEASURES, Some(fabric));
    for side in FABRIC_PATCHES {
        // Patches of a fabric are of whole cells.
        let is_it = |patch: &&FabricPatch| (patch.thin.patch / side - 1.0).abs() < ABOUT;
        enter(&mut all, FABRIC_PATCH_MEASURES, fabric.patches.iter().find(is_it));
    }
    for strips in &fabric.strips {
        enter(&mut all, STRIP_MEASURES, strips.as_ref());
    }
    all.into()
}

/// The numbers measured on one replicate, in the order of the study's quantities, in SI units and percent.
/// NaN means that a measure does not apply.
pub(crate) type Measurements = Box<[f64]>;

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
        add(&mut all, SPINLINE_MEASURES, &Part::whole());
        add(&mut all, PATCH_MEASURES, &Part::patches(2.5e-3));
        let errors_of = |name: &str| -> Vec<(ErrorRole, &str)> {
            let quantity = all.iter().find(|quantity| quantity.name == name);
            let errors = quantity.into_iter().flat_map(|quantity| &quantity.errors);
            errors.map(|(role, index)| (*role, all[*index].name.as_str())).collect()
        };
        assert_eq!(
            errors_of("cv_2.5_mm"),
            [(ErrorRole::OfOne, "cv_2.5_mm_chance"), (ErrorRole::Further, "cv_2.5_mm_few_fibres")]
        );
        // Its error is not kept.
        assert_eq!(errors_of("cv_2.5_mm_one_fibre"), []);
        // A temperature is kept in kelvin.
        assert!(
            all.iter()
                .any(|quantity| quantity.column == "solidification_temperature_k" && quantity.unit == KELVIN)
        );
    }
}
