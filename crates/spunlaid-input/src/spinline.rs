//! Reads and writes a spinline: the tables `[spinline]`, `[spinline.material]` and `[drag]` of a file, which
//! may be a whole case. A spinline that a case has gives it diameter, density and feed speed.

use super::data::DataFiles;
use super::open::{OpenCase, open_part};
use super::write::own_value;
use super::written_values::{WrittenValues, sorted};
use super::{FORMAT_VERSION, Overrides, Source, open_values, values_of_case, write};
use spunlaid_air::{Flow, Hint};
use spunlaid_fibre::case::keys::{self, Key};
use spunlaid_fibre::{AirTable, Case, End, Failure, Melt, Solution, SpinSpec, Spinline, Surroundings};
use spunlaid_ground::error::Place;
use spunlaid_ground::{Diagnostic, Dimension, Error, Fault, FileKind, Vec3};

/// The tables that describe a spinline.
pub(super) const TABLES: [&str; 3] = ["spinline", "spinline.material", "drag"];
/// Looks into a CFD field along the line.
const LOOKS: usize = 200;

/// A spinline as a file describes it.
#[derive(Clone, Debug)]
pub struct SpinFile {
    /// The line and the drag laws.
    pub spec: SpinSpec,
    /// Notes and warnings.
    pub notes: Vec<Diagnostic>,
    key_values: WrittenValues,
}

/// Reads a spinline.
///
/// # Errors
/// If the file cannot be read, or with every problem found in these tables.
pub fn read_spinline<'a>(
    source: impl Into<Source<'a>>,
    set: impl Into<Overrides<'a>>,
) -> Result<SpinFile, Error> {
    let set = set.into();
    source.into().open(FileKind::Case, set, |text, name, resources| {
        let key_values = values_of_case(resources, text, name, &[set])?;
        let mut open = open_spinline(key_values.clone(), &resources.files)?;
        // Only a whole case has a fibre that can fly.
        if open.waits_for_flights() {
            (open.case, open.notes) = resources.resolve(open_values(key_values, &resources.files)?)?;
        }
        Ok(SpinFile::from_open(open))
    })
}

/// Sets the values of a spinline alone, which is then complete.
pub(super) fn open_spinline(mut key_values: WrittenValues, files: &DataFiles) -> Result<OpenCase, Error> {
    if !key_values.has_table("spinline") {
        let remedy = "describe the line in a table [spinline]; `cases/spinline.toml` is an example";
        key_values.reject("[spinline]", Fault::new("is missing", remedy));
    }
    let (has_field, has_air) = (takes_field(&key_values), follows_air(&key_values));
    let wanted = |key: &Key| {
        TABLES.contains(&key.table())
            || has_field && is_of_field(key.name)
            || has_air && OF_AIR_AT_SLOT.contains(&key.name)
    };
    let mut open = open_part(key_values, files, wanted)?;
    open.complete_spinline()?;
    Ok(open)
}

/// Whether the velocity of the air along the line is that of a CFD field.
fn takes_field(key_values: &WrittenValues) -> bool {
    key_values.text("spinline.field").is_some_and(|word| word == "true")
}

/// Whether the velocity of the air along the line ends with that at the slot.
fn follows_air(key_values: &WrittenValues) -> bool {
    key_values.text("spinline.follows_air").is_some_and(|word| word == "true")
}

/// What gives the velocity of the air at the slot.
const OF_AIR_AT_SLOT: [&str; 7] = [
    "air.velocity",
    "air.profile",
    "air.speed_factor",
    "air.cabin_pressure",
    "air.speed_coefficient",
    "air.density",
    "air.temperature",
];

/// Whether a key says where a CFD field is, or how fast it flows.
fn is_of_field(key: &str) -> bool {
    key.starts_with("air.field") || key == "air.speed_factor"
}

/// Whether a spinline is written, and nothing of a fibre that flies.
pub(super) fn is_spinline_alone(key_values: &WrittenValues) -> bool {
    const OF_FLIGHTS: [&str; 5] = ["fibre", "feed", "belt", "air", "run"];
    let is_of_flight = |table| key_values.has_table(table) && !(table == "air" && takes_field(key_values));
    key_values.has_table("spinline") && !OF_FLIGHTS.into_iter().any(is_of_flight)
}

/// Writes a spinline as a file that reads back to the same bits.
pub fn write_spinline(spec: &SpinSpec) -> String {
    let case = Case::from(spec);
    let mut text = format!("version = {FORMAT_VERSION}\n");
    for table in TABLES {
        let lines = write::lines(&keys::CASE, table, |key| own_value(key, &case));
        text += &format!("\n[{table}]\n{}", write::in_lines(&lines));
    }
    if spec.air.is_some() {
        let of_field = |key: &Key| own_value(key, &case).filter(|_| is_of_field(key.name));
        let lines = write::lines(&keys::CASE, "air", of_field);
        text += &format!("\n[air]\n{}", write::in_lines(&lines));
    }
    text
}

impl SpinFile {
    pub(super) fn from_open(open: OpenCase) -> Self {
        let OpenCase { key_values, case, mut notes } = open;
        notes.extend(case.unusual_in(&TABLES).into_iter().map(|note| key_values.placed(note)));
        Self { spec: spec_of(&case), notes, key_values }
    }

    /// The spinline from which a case is fed; `None` if it has none.
    pub fn from_case(case: &Case) -> Option<Self> {
        let (key_values, notes) = (WrittenValues::new(Place::Code), Vec::new());
        case.spinline.is_some().then(|| Self { spec: spec_of(case), notes, key_values })
    }

    /// The factor on the drag with which the filament has a titre [kg/m].
    ///
    /// # Errors
    /// As [`SpinSpec::drag_factor_of_titre`], at the key to blame.
    pub fn drag_factor_of_titre(&self, titre: f64) -> Result<f64, Error> {
        let found = self.spec.drag_factor_of_titre(titre);
        found.map_err(|failure| rejected(&self.key_values, &Case::from(&self.spec), failure))
    }

    /// The steady state of each row of the curtain, the quenched side first; one if there is no curtain.
    ///
    /// # Errors
    /// If there is none, with the reason, at the key to blame.
    pub fn solve(&self) -> Result<Vec<Solution>, Error> {
        self.spec
            .spinline
            .solve_rows(self.spec.drag.along)
            .map_err(|failure| rejected(&self.key_values, &Case::from(&self.spec), failure))
    }
}

/// The spinline of a case, with the air of a CFD field if it takes that.
fn spec_of(case: &Case) -> SpinSpec {
    let mut spinline = case.spinline.as_deref().cloned().unwrap_or(Spinline::UNKNOWN);
    // Without the air of the case, the factor stands alone.
    spinline.air_change.follows_air = false;
    let takes_field = matches!(spinline.air, Surroundings::Field { .. });
    SpinSpec { spinline, drag: case.drag, air: takes_field.then(|| Box::new(case.air.clone())) }
}

/// A failure at the place of the key to blame, after the unusual values that may be why.
fn rejected(key_values: &WrittenValues, case: &Case, failure: Failure) -> Error {
    let slips = case.unusual_in(&TABLES).into_iter().filter(|slip| slip.key != failure.key);
    let mut problems: Vec<Diagnostic> = slips.map(|slip| key_values.placed(slip.into_error())).collect();
    problems.push(placed(key_values, failure));
    problems.into()
}

/// A failure at the place of the key to blame.
fn placed(key_values: &WrittenValues, failure: Failure) -> Diagnostic {
    let Failure { key, value, fault } = failure;
    match value {
        Some(value) => key_values.placed(keys::diagnostic(key, value, fault)),
        None => key_values.placed(Diagnostic::from(fault).with_key(key, None)),
    }
}

impl OpenCase {
    /// Solves the spinline of a case, if it has one, and takes diameter, density and feed speed from it.
    ///
    /// # Errors
    /// What is missing, or why there is no steady state.
    pub(super) fn spin(&mut self) -> Result<(), Error> {
        self.complete_spinline()?;
        let Some(spinline) = &self.case.spinline else { return Ok(()) };
        let solved = spinline.solve(self.case.drag.along);
        let filament = solved.map_err(|failure| rejected(&self.key_values, &self.case, failure))?;
        if let Some(beyond) = filament.beyond_table(self.case.drag.along) {
            self.notes.push(self.key_values.placed(Diagnostic::warning(beyond).with_key("drag.along", None)));
        }
        self.case.take_filament(&filament);
        Ok(())
    }

    /// Checks that everything is known, and looks up the air in a CFD field.
    fn complete_spinline(&mut self) -> Result<(), Error> {
        let Self { key_values, case, notes } = self;
        let Some(spinline) = &case.spinline else { return Ok(()) };
        if spinline.melt == Melt::Viscosity && spinline.material.viscosity.is_nan() {
            let remedy =
                "add melt_flow_rate = 35 to [spinline], or viscosity = \"220 Pa s\" to [spinline.material]";
            key_values.reject(
                "spinline.melt_flow_rate",
                Fault::new("is missing, and this polymer has no usual viscosity", remedy),
            );
        }
        if spinline.crystallisation && !spinline.material.crystals.is_known() {
            let remedy = "leave it out, or give the constants from avrami_exponent to heat_of_fusion in \
                [spinline.material]";
            key_values.reject(
                "spinline.crystallisation",
                Fault::new("needs constants of crystallisation, which are not known of this polymer", remedy),
            );
        }
        if matches!(spinline.end, End::TakeUp(speed) if speed.is_nan()) {
            key_values.reject(
                "spinline.take_up_speed",
                Fault::missing("spinline", "take_up_speed = \"3000 m/min\""),
            );
        }
        if spinline.curtain.is_some_and(|curtain| curtain.filaments_per_metre.is_nan()) {
            let line = "filaments_per_metre_and_row = 250";
            key_values.reject("spinline.filaments_per_metre_and_row", Fault::missing("spinline", line));
        }
        if spinline.air_change.follows_air {
            match factor_of_air_at_slot(case, spinline) {
                Ok(factor) => {
                    if let Some(line) = &mut case.spinline {
                        line.air_change.velocity_factor = factor;
                    }
                }
                Err(fault) => key_values.reject("spinline.follows_air", fault),
            }
        }
        let Some(spinline) = &case.spinline else { return Ok(()) };
        if let Surroundings::Field { temperature, .. } = spinline.air {
            match field_along(case, spinline.length, temperature) {
                Ok(table) => {
                    let what = Diagnostic::note(format!(
                        "takes the velocity of the air along the spinline from the field, and its temperature, {} \
                        everywhere, from spinline.temperature",
                        Dimension::Temperature.pretty(temperature)
                    ));
                    notes.push(key_values.placed(what.with_key("spinline.field", None)));
                    if let Some(line) = &mut case.spinline {
                        line.air = Surroundings::Field { temperature, table };
                    }
                }
                Err(fault) => key_values.reject("spinline.field", fault),
            }
        }
        if key_values.problems.is_empty() {
            Ok(())
        } else {
            Err(sorted(std::mem::take(&mut key_values.problems)).into())
        }
    }
}

/// The factor on the velocity of a profile with which it ends with that of the air at the slot.
fn factor_of_air_at_slot(case: &Case, spinline: &Spinline) -> Result<f64, Fault> {
    let at_slot = case.air.velocity_at_slot().filter(|_| !matches!(case.air.flow, Flow::Field(_)));
    let velocity = at_slot.ok_or_else(|| {
        Fault::needs(
            "the velocity of the air at the slot",
            "leave it out, or write air.profile or air.velocity",
        )
    })?;
    let Surroundings::Table(table) = &spinline.air else {
        return Err(Fault::needs("spinline.profile", "leave it out, or write a table of the air"));
    };
    let at_end = table.velocity_at(spinline.length);
    if at_end > 0.0 {
        return Ok(velocity / at_end);
    }
    let remedy = "write the velocity of the slot in its last rows";
    Err(Fault::new("has no velocity of spinline.profile at the end of the spinline to scale", remedy))
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
