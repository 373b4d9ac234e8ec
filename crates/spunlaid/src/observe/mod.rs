//! What is measured of the fibres: each measure is declared once, with its name, unit, meaning and figure.
//!
//! ```text
//! Flight → recorded instants → observers (one file each) → values of each fibre → statistics over replicates
//! ```
//!
//! A new measure is a file of this folder with a [`Declaration`], and a line in [`DECLARED`]. The summary, the
//! tables, the report with its figures and CSV files, and the studies loop over the declarations.
//!
//! Webs, scans, records and spinlines have tables of their own, with an entry for each measure: [`OF_WEBS`] and [`OF_PATCHES`],
//! [`OF_SCANS`] and [`OF_SCANNED_PATCHES`], [`OF_FABRICS`] and others beside it, [`OF_RECORDS`] and [`OF_COMPONENTS`], [`OF_SPINLINES`].

mod along_fibre;
mod along_way;
mod curvature;
mod deflection;
mod end_node;
mod energy;
mod fabric;
mod flow;
mod laydown;
mod neighbours;
mod record;
mod residence;
mod root_tension;
mod sample;
mod scan;
mod spectrum;
mod spinline;
mod strain;
mod web;

pub use fabric::{FabricMeasure, OF_FABRIC_PATCHES, OF_FABRICS, OF_HOLES, OF_STRIPS};
pub use laydown::{LAYDOWN, SURROGATE};
pub use record::{OF_COMPONENTS, OF_RECORDS, RecordMeasure, RecordNumber};
pub use sample::Sample;
pub use scan::{OF_SCANNED_PATCHES, OF_SCANS, ScanMeasure};
pub use spinline::{OF_SPINLINES, SpinlineMeasure};
pub use web::{Deviation, OF_PATCHES, OF_WEBS, PatchColumn, PatchMeasure, WebMeasure, WebNumber};

use crate::case::Case;
use crate::flight::{Flight, LaidPoint, Snapshot};
use crate::lanes::WIDTH;
use crate::units::{si_unit_of, udunits};

/// Everything that is measured, in the order of the tables.
pub const DECLARED: &[&Declaration] = &[
    &end_node::DECLARATION,
    &deflection::DECLARATION,
    &residence::DECLARATION,
    &along_fibre::DECLARATION,
    &curvature::DECLARATION,
    &spectrum::DECLARATION,
    &laydown::DECLARATION,
    &along_way::DECLARATION,
    &neighbours::FED_CD,
    &neighbours::FED_MD,
    &neighbours::FIXED_CD,
    &neighbours::FIXED_MD,
    &root_tension::DECLARATION,
    &strain::USUAL,
    &strain::LARGEST,
    &flow::DECLARATION,
    &energy::WORK,
    &energy::BALANCE,
    &energy::DISSIPATION,
];

/// Some measures, and the observer that takes all of them.
#[derive(Debug)]
pub struct Declaration {
    /// The measures, in the order of the observer's values.
    pub measures: &'static [Measure],
    /// Whether they have a meaning for a case.
    pub applies: fn(&Case) -> bool,
    /// The observer of the fibres of a flight. Their cases may differ, so it takes what it needs of each lane's own,
    /// [`Flight::case`].
    pub observer: fn(&Flight) -> Box<dyn Observer>,
}

/// Something measured of every fibre.
#[derive(Debug)]
pub struct Measure {
    /// Name in a study file, `amplitude_y`.
    pub name: &'static str,
    /// Name in tables and in `summary.json`, with its SI unit: `amplitude_y_m`.
    pub column: &'static str,
    /// Its label in a table: `Amplitude in y`.
    pub label: &'static str,
    /// Its definition in words.
    pub meaning: &'static str,
    /// The unit in which it is shown.
    pub unit: Unit,
    /// Number or curve.
    pub kind: Kind,
    /// Its group.
    pub group: Group,
    /// The statistic over the replicates that is shown.
    pub aggregate: Aggregate,
    /// The figure that shows it.
    pub figure: &'static Figure,
    /// Its label in that figure: `*y*`.
    pub series: &'static str,
}

impl Measure {
    /// The mean over the replicates of a number that has no name yet.
    const NUMBER: Self = Self {
        name: "",
        column: "",
        label: "",
        meaning: "",
        unit: Unit { shown: "", per_si: 1.0 },
        kind: Kind::Number,
        group: END_NODE,
        aggregate: Aggregate::Mean,
        figure: &Figure { name: "", title: "", words: "", logarithmic: false, from_zero: true, caption: "" },
        series: "",
    };
}

/// The declared measures that studies keep, in the order of their columns. It is not that of the declarations, and it stays: a journal can be
/// continued only while the columns keep their order.
///
/// * `column` – the measure as studies keep it, and its place
pub(crate) fn in_studies<T>(
    declared: &'static [T],
    column: fn(&'static T) -> (&'static Option<Measure>, usize),
) -> Vec<(&'static T, &'static Measure)> {
    let kept = declared.iter().filter_map(|one| column(one).0.as_ref().map(|measure| (one, measure)));
    let mut kept: Vec<_> = kept.collect();
    kept.sort_by_key(|(one, _)| column(one).1);
    kept
}

/// A group of measures: a heading of tables, and a part of `summary.json`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Group {
    /// Name in `summary.json`.
    pub name: &'static str,
    /// Heading.
    pub title: &'static str,
}

/// Motion of the free end.
pub const END_NODE: Group = Group { name: "end_node", title: "free end of the fibre" };
/// The fibre as a whole.
pub const FIBRE: Group = Group { name: "fibre", title: "fibre" };
/// The energy checks.
pub const ENERGY: Group = Group { name: "energy", title: "energy" };

/// A unit to show values in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// As it is written; empty for a plain number.
    pub shown: &'static str,
    /// Factor from the SI unit to this unit.
    pub per_si: f64,
}

impl Unit {
    /// The unit of the values as they are kept, before they are shown, in the spelling of [`udunits`].
    pub fn of_values(self) -> String {
        if self.per_si == 1.0 { udunits(self.shown) } else { udunits(&si_unit_of(self.shown)) }
    }
}

/// Millimetres.
pub const MILLIMETRES: Unit = Unit { shown: "mm", per_si: 1e3 };
/// Hertz.
pub const HERTZ: Unit = Unit { shown: "Hz", per_si: 1.0 };
/// Millinewtons.
pub const MILLINEWTONS: Unit = Unit { shown: "mN", per_si: 1e3 };
/// A plain number.
pub const RATIO: Unit = Unit { shown: "", per_si: 1.0 };
/// Per metre.
pub const PER_METRE: Unit = Unit { shown: "1/m", per_si: 1.0 };
/// Square millimetres per hertz.
pub const SQUARE_MILLIMETRES_PER_HERTZ: Unit = Unit { shown: "mm²/Hz", per_si: 1e6 };
/// Per cent, of a ratio.
pub const PERCENT: Unit = Unit { shown: "%", per_si: 1e2 };
/// Per cent, of a value that is already in per cent.
pub const OF_PERCENT: Unit = Unit { shown: "%", per_si: 1.0 };

/// What kind of result a measure is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Number,
    /// A curve along the fibre, over the distance from the root [m].
    Profile,
    /// A curve over time [s], one value for each recorded instant.
    Series,
    /// A curve over frequency [Hz].
    Spectrum,
    /// A curve between the inlet and the belt, over the distance from the inlet along x [m].
    Way,
    /// A curve over the length of fibre between two points [m].
    Lag,
    /// A curve over the distance between the roots of two fibres [m].
    Neighbour,
    /// A curve over the direction on the belt [degrees], 0 in machine direction.
    Direction,
}

impl Kind {
    /// The abscissa of the curve: its name with the SI unit in a table, its label on an axis, and its unit.
    pub const fn abscissa(self) -> Option<(&'static str, &'static str, Unit)> {
        match self {
            Self::Number => None,
            Self::Profile => Some(("distance_m", "Distance from the root along the fibre", MILLIMETRES)),
            Self::Series => Some(("time_s", "Time", Unit { shown: "s", per_si: 1.0 })),
            Self::Spectrum => Some(("frequency_hz", "Frequency *f*", HERTZ)),
            Self::Way => Some(("distance_m", "Distance from the inlet", MILLIMETRES)),
            Self::Lag => Some(("lag_m", "Length of fibre between two points", MILLIMETRES)),
            Self::Neighbour => Some(("distance_m", "Distance between the fibres", MILLIMETRES)),
            Self::Direction => {
                Some(("direction_degrees", "Direction on the belt", Unit { shown: "°", per_si: 1.0 }))
            }
        }
    }
}

/// The statistic over the replicates that stands for all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aggregate {
    /// Their mean, which has a standard error.
    Mean,
    /// Their median.
    Median,
    /// The largest.
    Largest,
}

/// A figure of one or more measures.
#[derive(Debug, PartialEq)]
pub struct Figure {
    /// Name of its files.
    pub name: &'static str,
    /// Its title, which also names the axis of the measures.
    pub title: &'static str,
    /// What it shows, in words: `amplitude`.
    pub words: &'static str,
    /// Whether the axis of the measures is logarithmic.
    pub logarithmic: bool,
    /// Whether that axis begins at zero.
    pub from_zero: bool,
    /// Sentences under a curve.
    pub caption: &'static str,
}

/// A figure of numbers without a caption of its own, whose axis begins at zero.
const fn figure(name: &'static str, title: &'static str, words: &'static str) -> Figure {
    Figure { name, title, words, logarithmic: false, from_zero: true, caption: "" }
}

/// The state of the fibres at a recorded instant.
#[derive(Clone, Copy, Debug)]
pub struct Observation<'a> {
    /// The fibres.
    pub snapshot: &'a Snapshot,
    /// The sample of each of the eight fibres.
    pub samples: &'a [Sample],
    /// Whether the spin-up is over.
    pub settled: bool,
    /// What each of the eight fibres has laid since the last recorded instant.
    pub laid: &'a [Vec<LaidPoint>],
}

/// One value of a measure.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Of a [`Kind::Number`], in SI units; NaN where it is not defined.
    Number(f64),
    /// Of any other kind: places, times or frequencies, and the values there, as many of both, in SI units.
    Curve(Vec<f64>, Vec<f64>),
}

/// Looks at up to eight fibres while they fly.
pub trait Observer: std::fmt::Debug + Send {
    /// Receives a recorded instant. The instants come in order and begin with the start.
    fn see(&mut self, observation: &Observation<'_>);

    /// The values of one fibre at the end of the flight, one for each declared measure.
    fn finish(&self, lane: usize, flight: &Flight) -> Vec<Value>;
}

/// The observers of a flight.
#[derive(Debug)]
pub struct Observers(Vec<(&'static Declaration, Box<dyn Observer>)>);

impl Observers {
    /// The observers of all measures that apply to a fibre of a flight.
    ///
    /// * `curves` – whether to measure curves too. A study does without; observers of curves alone are then left
    ///   out.
    pub fn new(flight: &Flight, curves: bool) -> Self {
        let wanted = |d: &&Declaration| curves || d.measures.iter().any(|m| m.kind == Kind::Number);
        let any = |d: &&Declaration| (0..WIDTH).any(|lane| applies(d, flight, lane));
        let declared = DECLARED.iter().copied().filter(wanted).filter(any);
        Self(declared.map(|declared| (declared, (declared.observer)(flight))).collect())
    }

    /// Passes a recorded instant to all observers.
    pub fn see(&mut self, observation: &Observation<'_>) {
        self.0.iter_mut().for_each(|(_, observer)| observer.see(observation));
    }

    /// The measures that apply to one fibre, in the order of their declarations.
    pub fn finish(&self, lane: usize, flight: &Flight) -> impl Iterator<Item = (&'static Measure, Value)> {
        let of_lane = self.0.iter().filter(move |(declared, _)| applies(declared, flight, lane));
        of_lane
            .flat_map(move |(declared, observer)| declared.measures.iter().zip(observer.finish(lane, flight)))
    }
}

/// The number of measures that are numbers.
pub const NUMBERS: usize = {
    let (mut count, mut i) = (0, 0);
    while i < DECLARED.len() {
        let (measures, mut j) = (DECLARED[i].measures, 0);
        while j < measures.len() {
            count += matches!(measures[j].kind, Kind::Number) as usize;
            j += 1;
        }
        i += 1;
    }
    count
};

/// All measures that are numbers, whether they apply to a case or not. A study stores these for each fibre.
pub const MEASURES: [&Measure; NUMBERS] = {
    let mut all = [&DECLARED[0].measures[0]; NUMBERS];
    let (mut count, mut i) = (0, 0);
    while i < DECLARED.len() {
        let (measures, mut j) = (DECLARED[i].measures, 0);
        while j < measures.len() {
            if matches!(measures[j].kind, Kind::Number) {
                all[count] = &measures[j];
                count += 1;
            }
            j += 1;
        }
        i += 1;
    }
    all
};

/// Whether measures have a meaning for the fibre in a lane.
fn applies(declared: &Declaration, flight: &Flight, lane: usize) -> bool {
    flight.case(lane).is_some_and(declared.applies)
}

/// A number of the case in each lane; NaN in unused lanes.
fn number_of_each(flight: &Flight, number: impl Fn(&Case) -> f64) -> [f64; WIDTH] {
    std::array::from_fn(|lane| flight.case(lane).map_or(f64::NAN, &number))
}

/// Applies to fibres of fixed length.
fn fixed(case: &Case) -> bool {
    case.line.is_none()
}

/// Applies to fed fibres.
fn fed(case: &Case) -> bool {
    case.line.is_some()
}

/// Applies to every case.
fn always(_: &Case) -> bool {
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn names_and_columns_are_unique_and_complete() {
        let all: Vec<&Measure> = DECLARED.iter().flat_map(|declaration| declaration.measures).collect();
        assert_eq!(all.iter().map(|m| m.name).collect::<BTreeSet<_>>().len(), all.len());
        assert_eq!(all.iter().map(|m| m.column).collect::<BTreeSet<_>>().len(), all.len());
        assert!(MEASURES.iter().all(|measure| measure.kind == Kind::Number));
        assert_eq!(MEASURES.iter().map(|m| m.name).collect::<BTreeSet<_>>().len(), NUMBERS);
        for measure in all {
            assert!(measure.column.starts_with(measure.name), "{}", measure.name);
            assert!(!measure.meaning.is_empty() && !measure.label.is_empty(), "{}", measure.name);
        }
    }

    /// A name of a column ends with the unit of its values, `_m2_hz`.
    fn check_unit(measure: &Measure) {
        let unit = measure.unit.of_values();
        let ending = match unit.as_str() {
            "1" => return,
            "degC" => "c".to_owned(),
            "degree" => "degrees".to_owned(),
            // A power that is no whole number has words.
            "m-0.5" => "per_sqrt_m".to_owned(),
            "1/m" => "per_m".to_owned(),
            "1/s" => "per_s".to_owned(),
            unit => unit.to_lowercase().replace('/', "_"),
        };
        assert!(measure.column.ends_with(&format!("_{ending}")), "{} in {unit}", measure.column);
    }

    #[test]
    fn the_unit_of_the_values_is_that_of_the_name_of_their_column() {
        DECLARED.iter().flat_map(|declaration| declaration.measures).for_each(check_unit);
        OF_SPINLINES.iter().filter_map(|one| one.study.as_ref()).for_each(check_unit);
        OF_WEBS.iter().for_each(|one| check_unit(&one.measure));
        OF_PATCHES.iter().filter_map(|one| one.study.as_ref()).for_each(check_unit);
    }

    /// Fails unless names are unique and not empty.
    fn check_names(names: impl Iterator<Item = &'static str>) {
        let names: Vec<&str> = names.collect();
        assert!(names.iter().all(|name| !name.is_empty()), "{names:?}");
        assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len(), "{names:?}");
    }

    /// Fails unless places are 0, 1, 2 and so on, each once.
    fn check_places(places: impl Iterator<Item = usize>) {
        let mut places: Vec<usize> = places.collect();
        places.sort_unstable();
        assert_eq!(places, (0..places.len()).collect::<Vec<_>>());
    }

    /// Fails unless the columns of a study have a name, a label and a meaning each, and a place of their own.
    fn check_columns(columns: impl Iterator<Item = (&'static Measure, usize)> + Clone) {
        let measures = || columns.clone().map(|(measure, _)| measure);
        check_names(measures().map(|measure| measure.name));
        check_names(measures().map(|measure| measure.column));
        check_names(measures().map(|measure| measure.label));
        assert!(measures().all(|measure| !measure.meaning.is_empty()));
        check_places(columns.map(|(_, place)| place));
    }

    #[test]
    fn measures_of_webs_spinlines_and_records_have_names_and_places_of_their_own() {
        check_names(OF_SPINLINES.iter().map(|declared| declared.name));
        check_names(OF_SPINLINES.iter().map(|declared| declared.label));
        check_columns(OF_SPINLINES.iter().filter_map(|one| Some((one.study.as_ref()?, one.study_place))));
        check_names(OF_WEBS.iter().map(|declared| declared.measure.name));
        check_names(OF_WEBS.iter().map(|declared| declared.measure.column));
        check_names(OF_PATCHES.iter().map(|declared| declared.name));
        let columns = OF_PATCHES.iter().filter_map(|one| Some((one.study.as_ref()?, one.study_place)));
        check_columns(columns.clone());
        check_places(
            OF_PATCHES.iter().filter_map(|declared| declared.column.as_ref()).map(|column| column.place),
        );
        // Errors are told by the ends of names.
        for declared in OF_PATCHES {
            let error = declared.error.map(|error| match error {
                Deviation::OfOne(end) | Deviation::Always(end) => end,
            });
            for end in error.iter().chain(declared.causes) {
                let mut names = columns.clone().map(|(measure, _)| measure.name);
                assert!(names.any(|name| name.strip_prefix("cv_#") == Some(end)), "{end}");
            }
        }
        check_names(OF_RECORDS.iter().map(|declared| declared.name));
        check_names(OF_COMPONENTS.iter().map(|declared| declared.name));
    }
}
