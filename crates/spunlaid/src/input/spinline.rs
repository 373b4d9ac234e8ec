//! Reads and writes a spinline: the tables `[spinline]`, `[spinline.material]` and `[drag]` of a file, which may be a whole case.
//! A spinline that a case has gives it diameter, density and feed speed.

use super::data::DataFiles;
use super::open::{Open, open_part};
use super::written::{WrittenValues, sorted};
use super::{FORMAT_VERSION, Overrides, document, file, parse_with, write};
use crate::air::Flow;
use crate::case::keys::{self, Key};
use crate::case::{Case, Note};
use crate::drag::Drag;
use crate::error::{Error, Fault, FileKind, Place, Problem};
use crate::field::Hint;
use crate::spinline::{AirTable, End, Failure, Melt, Solution, Spinline, Surroundings};
use crate::units::Dimension;
use crate::vec3::Vec3;
use std::path::Path;

/// The tables that describe a spinline.
const TABLES: [&str; 3] = ["spinline", "spinline.material", "drag"];
/// Looks into a CFD field along the line.
const LOOKS: usize = 200;

/// A spinline as a file describes it.
#[derive(Clone, Debug)]
pub struct SpinFile {
    /// What is known of the line.
    pub spinline: Spinline,
    /// The drag laws; the one along the thread is used.
    pub drag: Drag,
    /// Notes and warnings.
    pub notes: Vec<Note>,
    written: WrittenValues,
}

/// Reads a spinline.
///
/// # Errors
/// If the file cannot be read, or with every problem found in these tables.
pub fn read_spinline<'a>(path: &Path, overrides: impl Into<Overrides<'a>>) -> Result<SpinFile, Error> {
    let text = file::read(path, FileKind::Case)?;
    parse_spinline(&text, &path.display().to_string(), overrides)
}

/// Reads the text of a spinline. Messages call the file `name`.
///
/// # Errors
/// As [`read_spinline`].
pub fn parse_spinline<'a>(
    text: &str,
    name: &str,
    overrides: impl Into<Overrides<'a>>,
) -> Result<SpinFile, Error> {
    let (files, overrides) = (DataFiles::default(), [overrides.into()]);
    let mut written = document::read(&keys::CASE, text, name, &overrides)?;
    if !written.has_table("spinline") {
        let remedy = "describe the line in a table [spinline]; `cases/spinline.toml` is an example";
        written.reject("[spinline]", Fault::new("is missing", remedy));
    }
    let has_field = written.text("spinline.field").is_some_and(|word| word == "true");
    let wanted = |key: &Key| TABLES.contains(&key.table()) || has_field && key.name.starts_with("air.field");
    let mut open = open_part(written, &files, wanted)?;
    if open.waits_for_flights() {
        // Only a whole case has a fibre that can fly.
        (open.case, open.notes) = parse_with(&files, text, name, &overrides)?;
    }
    open.complete_spinline()?;
    let Open { written, case, notes } = open;
    let spinline = case.spinline.unwrap_or(Spinline::UNKNOWN);
    Ok(SpinFile { spinline, drag: case.drag, notes, written })
}

/// Whether a file describes a spinline and no fibre that flies. False if it cannot be read.
pub fn holds_spinline_alone(path: &Path) -> bool {
    let Ok(text) = file::read(path, FileKind::Case) else { return false };
    let alone = |written: WrittenValues| {
        written.has_table("spinline") && !["fibre", "air"].into_iter().any(|table| written.has_table(table))
    };
    document::read(&keys::CASE, &text, "", &[]).is_ok_and(alone)
}

/// Writes a spinline as a file that reads back to the same bits.
pub fn write_spinline(file: &SpinFile) -> String {
    let case = file.carrier();
    let mut text = format!("version = {FORMAT_VERSION}\n");
    for table in TABLES {
        let lines = write::lines(&keys::CASE, table, &case, |_, value| value);
        text += &format!("\n[{table}]\n{}", write::in_lines(&lines));
    }
    text
}

impl SpinFile {
    /// The spinline from which a case is fed; `None` if it has none.
    pub fn of_case(case: &Case) -> Option<Self> {
        let (spinline, written) = (case.spinline.clone()?, WrittenValues::new(Place::Code));
        Some(Self { spinline, drag: case.drag, notes: Vec::new(), written })
    }

    /// The steady state of each row of the curtain, the quenched side first; one if there is no curtain.
    ///
    /// # Errors
    /// If there is none, with the reason, at the key to blame.
    pub fn solve(&self) -> Result<Vec<Solution>, Error> {
        self.spinline
            .solve_rows(self.drag.along)
            .map_err(|failure| vec![placed(&self.written, failure)].into())
    }

    /// A case with nothing but the spinline, whose keys can be read and set.
    pub(super) fn carrier(&self) -> Case {
        Case { spinline: Some(self.spinline.clone()), drag: self.drag, ..Case::unset() }
    }
}

/// A failure at the place of the key to blame.
fn placed(written: &WrittenValues, failure: Failure) -> Problem {
    let Failure { key, value, fault } = failure;
    match value {
        Some(value) => written.placed(keys::finding(key, value, fault)),
        None => Problem { key: key.to_owned(), ..written.placed(keys::finding(key, f64::NAN, fault)) },
    }
}

impl Open {
    /// Solves the spinline of a case, if it has one, and takes diameter, density and feed speed from it.
    ///
    /// # Errors
    /// What is missing, or why there is no steady state.
    pub(super) fn spin(&mut self) -> Result<(), Error> {
        self.complete_spinline()?;
        let Some(spinline) = &self.case.spinline else { return Ok(()) };
        let solved = spinline.solve(self.case.drag.along);
        let filament = solved.map_err(|failure| vec![placed(&self.written, failure)])?;
        self.case.take_filament(&filament);
        Ok(())
    }

    /// Checks that everything is known, and looks up the air in a CFD field.
    fn complete_spinline(&mut self) -> Result<(), Error> {
        let Self { written, case, .. } = self;
        let Some(spinline) = &case.spinline else { return Ok(()) };
        if spinline.melt == Melt::Viscosity && spinline.material.viscosity.is_nan() {
            let remedy =
                "add melt_flow_rate = 35 to [spinline], or viscosity = \"220 Pa s\" to [spinline.material]";
            written.reject(
                "spinline.melt_flow_rate",
                Fault::new("is missing, and this polymer has no usual viscosity", remedy),
            );
        }
        if spinline.crystallisation && !spinline.material.crystals.is_known() {
            let remedy = "leave it out, or give the constants from avrami_exponent to heat_of_fusion in [spinline.material]";
            written.reject(
                "spinline.crystallisation",
                Fault::new("needs constants of crystallisation, which are not known of this polymer", remedy),
            );
        }
        if matches!(spinline.end, End::TakeUp(speed) if speed.is_nan()) {
            written.reject(
                "spinline.take_up_speed",
                Fault::missing("spinline", "take_up_speed = \"3000 m/min\""),
            );
        }
        if spinline.curtain.is_some_and(|curtain| curtain.filaments_per_metre.is_nan()) {
            let line = "filaments_per_metre_and_row = 250";
            written.reject("spinline.filaments_per_metre_and_row", Fault::missing("spinline", line));
        }
        if let Surroundings::Field { temperature, .. } = spinline.air {
            match field_along(case, spinline.length, temperature) {
                Ok(table) => {
                    if let Some(line) = &mut case.spinline {
                        line.air = Surroundings::Field { temperature, table };
                    }
                }
                Err(fault) => written.reject("spinline.field", fault),
            }
        }
        if written.problems.is_empty() {
            Ok(())
        } else {
            Err(sorted(std::mem::take(&mut written.problems)).into())
        }
    }
}

/// The air of the case's CFD field along the line, which ends at the root of the fibre.
fn field_along(case: &Case, length: f64, temperature: f64) -> Result<AirTable, Fault> {
    let Flow::Field(placed) = &case.air.flow else {
        return Err(Fault::needs("air.field", "leave it out, or name the file of a CFD field"));
    };
    let above = -placed.extent().0.x;
    if above < length * (1.0 - 1e-6) {
        let [above, length] = [above.max(0.0), length].map(|length| Dimension::Length.pretty(length));
        let message = format!(
            "needs the field along the whole spinline of {length}, and it begins {above} above the root"
        );
        let remedy = "correct air.field_root, shorten spinline.length, or write the air as spinline.profile";
        return Err(Fault::new(message, remedy));
    }
    let (mut table, mut hint) = (AirTable::default(), Hint::default());
    for i in 0..=LOOKS {
        let distance = length * i as f64 / LOOKS as f64;
        let velocity = placed.velocity(Vec3::new(distance - length, 0.0, 0.0), &mut hint);
        table.distance.push(distance);
        table.velocity.push(velocity.x * case.air.speed_factor);
        table.cross_velocity.push(velocity.y.hypot(velocity.z) * case.air.speed_factor);
        table.temperature.push(temperature);
    }
    Ok(table)
}
