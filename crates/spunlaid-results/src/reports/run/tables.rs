//! The tables of a run: their files and columns.

use spunlaid_fibre::LaidPoint;
use spunlaid_simulation::ensemble::Sample;

/// A column of doubles: its name with the unit, and its value at an instant.
pub type Column = (&'static str, fn(&Sample) -> f64);

/// `end_node.parquet`: the free end over time.
const END_NODE: &[Column] =
    &[("time_s", |s| s.time), ("x_m", |s| s.end.x), ("y_m", |s| s.end.y), ("z_m", |s| s.end.z)];

/// Fibres that have a column.
#[derive(Clone, Copy, PartialEq)]
enum Fibres {
    All,
    Fixed,
    Fed,
}

/// `energy.parquet`: both ledgers over time; of a fed fibre the full balance.
const ENERGY: &[(Fibres, Column)] = &[
    (Fibres::All, ("time_s", |s| s.time)),
    (Fibres::All, ("kinetic_j", |s| s.kinetic)),
    (Fibres::All, ("axial_j", |s| s.axial)),
    (Fibres::All, ("bending_j", |s| s.bending)),
    (Fibres::Fixed, ("work_j", |s| s.work)),
    (Fibres::All, ("gravity_work_j", |s| s.gravity_work)),
    (Fibres::All, ("air_work_j", |s| s.air_work)),
    (Fibres::All, ("damping_work_j", |s| s.damping_work)),
    (Fibres::Fed, ("feed_work_j", |s| s.feed_work)),
    (Fibres::Fed, ("belt_work_j", |s| s.belt_work)),
    (Fibres::Fed, ("carried_j", |s| s.carried)),
    (Fibres::All, ("tension_dissipation_j", |s| s.tension_dissipation)),
    (Fibres::All, ("imbalance_j", |s| s.imbalance)),
    (Fibres::Fixed, ("work_error_percent", Sample::work_error_percent)),
    (Fibres::All, ("balance_error_percent", Sample::balance_error_percent)),
];

/// A number of a sample: its name, and the place where it stands.
pub type Field = (&'static str, SampleField);
/// Where a number stands in a sample.
pub type SampleField = fn(&mut Sample) -> &mut f64;

/// Everything that a sample has, apart from the time, which is the same for all fibres.
pub const FIELDS: [Field; 15] = [
    ("x_m", |s| &mut s.end.x),
    ("y_m", |s| &mut s.end.y),
    ("z_m", |s| &mut s.end.z),
    ("kinetic_j", |s| &mut s.kinetic),
    ("axial_j", |s| &mut s.axial),
    ("bending_j", |s| &mut s.bending),
    ("work_j", |s| &mut s.work),
    ("gravity_work_j", |s| &mut s.gravity_work),
    ("air_work_j", |s| &mut s.air_work),
    ("damping_work_j", |s| &mut s.damping_work),
    ("feed_work_j", |s| &mut s.feed_work),
    ("belt_work_j", |s| &mut s.belt_work),
    ("carried_j", |s| &mut s.carried),
    ("tension_dissipation_j", |s| &mut s.tension_dissipation),
    ("imbalance_j", |s| &mut s.imbalance),
];
/// All numbers of a sample, the time first.
pub(super) const SAMPLE: [Field; FIELDS.len() + 1] = {
    let mut all: [Field; FIELDS.len() + 1] = [("time_s", |s| &mut s.time); FIELDS.len() + 1];
    let mut i = 0;
    while i < FIELDS.len() {
        all[i + 1] = FIELDS[i];
        i += 1;
    }
    all
};

/// The tables of fed fibres, or of fibres of fixed length: their files and columns.
pub fn tables(fed: bool) -> Vec<(&'static str, Vec<Column>)> {
    let other = if fed { Fibres::Fixed } else { Fibres::Fed };
    let energy = ENERGY.iter().filter(|(kind, _)| *kind != other).map(|(_, column)| *column).collect();
    let end = (!fed).then(|| ("end_node.parquet", END_NODE.to_vec()));
    end.into_iter().chain([("energy.parquet", energy)]).collect()
}

/// The unit of a column, with which its name ends.
pub fn unit_of_column(name: &str) -> &'static str {
    const ENDINGS: [(&str, &str); 4] = [("_s", "s"), ("_m", "m"), ("_j", "J"), ("_percent", "%")];
    ENDINGS.iter().find(|(ending, _)| name.ends_with(ending)).map_or("", |(_, unit)| unit)
}

/// `laid.parquet`: what fed fibres have laid, in the order of feed.
pub(super) const LAID: &str = "laid.parquet";
/// A column of it.
pub(super) type PointColumn = (&'static str, fn(&LaidPoint) -> f64);
/// Its columns.
pub(super) const POINT: [PointColumn; 4] =
    [("s_m", |p| p.fed), ("time_s", |p| p.time), ("md_m", |p| p.md), ("cd_m", |p| p.cd)];

/// A laid point from its columns.
pub(super) const fn point_of([fed, time, md, cd]: [f64; POINT.len()]) -> LaidPoint {
    LaidPoint { fed, time, md, cd }
}
