//! The numbers that a study keeps of each replicate: of a fibre, of a web, or of a spinline.

use crate::ensemble::Trajectory;
use crate::layers::WebSpec;
use crate::observe::{
    Deviation, Figure, MEASURES, Measure, OF_PATCHES, OF_SPINLINES, OF_WEBS, PatchMeasure, SpinlineMeasure,
    Unit, WebNumber, in_studies,
};
use crate::spinline::Solution;
use crate::units::shortest;
use crate::web::{Findings, Web};

/// A number that a study keeps, as its measure is declared in [`observe`](crate::observe). That of patches has their side in its
/// name.
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
    /// The figure that shows it.
    pub figure: &'static Figure,
    /// Its label in that figure.
    pub series: String,
    /// Where its standard error comes from.
    pub error: ErrorSource,
    /// Further errors, which more replicates do not lower: indices of the quantities that are their sizes.
    pub causes: Vec<usize>,
}

/// Where the standard error of the mean of a quantity comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorSource {
    /// The scatter of the replicates.
    Replicates,
    /// The scatter of the replicates; of a single one, the quantity with this index.
    OfOne(usize),
    /// The quantity with this index.
    Always(usize),
}

impl Quantity {
    /// A declared measure, with the side of the patches in place of `#`.
    fn new(measure: &'static Measure, side: &str) -> Self {
        let named = |text: &str| text.replace('#', side);
        Self {
            name: named(measure.name),
            column: named(measure.column),
            label: named(measure.label),
            meaning: measure.meaning,
            unit: measure.unit,
            figure: measure.figure,
            series: named(measure.series),
            error: ErrorSource::Replicates,
            causes: Vec::new(),
        }
    }
}

/// The measures of spinlines that studies keep, in the order of their columns.
fn spinline_columns() -> Vec<(&'static SpinlineMeasure, &'static Measure)> {
    in_studies(OF_SPINLINES, |declared| (&declared.study, declared.study_place))
}

/// The measures of patches that studies keep, in the order of their columns.
fn patch_columns() -> Vec<(&'static PatchMeasure, &'static Measure)> {
    in_studies(OF_PATCHES, |declared| (&declared.study, declared.study_place))
}

/// The quantities of a fibre.
pub(super) fn quantities_of_fibres() -> Vec<Quantity> {
    MEASURES.iter().map(|measure| Quantity::new(measure, "")).collect()
}

/// The quantities of a spinline.
pub(super) fn quantities_of_spinlines() -> Vec<Quantity> {
    spinline_columns().into_iter().map(|(_, measure)| Quantity::new(measure, "")).collect()
}

/// The numbers of a spinline, in the order of [`of_spinlines`].
pub(super) fn measured_of_spinline(found: &Solution) -> Measurements {
    spinline_columns().into_iter().map(|(declared, _)| (declared.number)(found)).collect()
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
    let (mut all, columns) = (Vec::new(), patch_columns());
    for side in sides(webs) {
        let first = all.len();
        let place = |end: &str| {
            let is_it = |(_, measure): &(_, &Measure)| measure.name.strip_prefix("cv_#") == Some(end);
            first + columns.iter().position(is_it).unwrap_or(0)
        };
        // In millimetres, without the rounding of the file.
        let side = shortest((side * 1e9).round() / 1e6);
        all.extend(columns.iter().map(|(declared, measure)| Quantity {
            error: match declared.error {
                None => ErrorSource::Replicates,
                Some(Deviation::OfOne(end)) => ErrorSource::OfOne(place(end)),
                Some(Deviation::Always(end)) => ErrorSource::Always(place(end)),
            },
            causes: declared.causes.iter().map(|end| place(end)).collect(),
            ..Quantity::new(measure, &side)
        }));
    }
    all.extend(OF_WEBS.iter().map(|declared| Quantity::new(&declared.measure, "")));
    all
}

/// The numbers of a web, in the order of [`of_webs`].
///
/// * `sides` – of the patches of the study [m]
pub(super) fn measured_of_web(sides: &[f64], web: &Web, found: &Findings) -> Measurements {
    let columns = patch_columns();
    let of_side = |&side: &f64| {
        let patch = found.patches.iter().find(|patch| is_same(patch.map.patch, side));
        columns.iter().map(move |(declared, _)| patch.and_then(declared.number).unwrap_or(f64::NAN))
    };
    let of_web =
        OF_WEBS.iter().map(|declared| (declared.number)(web, found).map_or(f64::NAN, WebNumber::value));
    sides.iter().flat_map(of_side).chain(of_web).collect()
}

/// The numbers measured on one replicate, in the order of the study's quantities, in SI units and percent. NaN means that a
/// measure does not apply.
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
