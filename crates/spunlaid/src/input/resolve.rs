//! From what is written to what is meant: defaults, whole elements, whole steps.

use super::data::DataFiles;
use super::document::{Document, Entry, kind};
use super::layout::VERSION;
use super::{FORMAT_VERSION, air};
use crate::air::{Air, EddyModel};
use crate::case::keys::{self, Quantity};
use crate::case::{Case, ERROR_TOLERANCE, MOST_REPLICATES, MOST_STEPS, Note, Remark, Run};
use crate::chain::schemes::Scheme;
use crate::drag::{Drag, FrictionLaw, NormalLaw};
use crate::error::{Error, Fault, Finding, Place};
use crate::fibre::{Fibre, Root};
use crate::vec3::Vec3;
use std::collections::BTreeMap;
use toml::de::DeValue;

/// Default acceleration of gravity [m/s²].
const GRAVITY: f64 = 9.81;
/// Default time between recorded instants [s].
const OUTPUT_INTERVAL: f64 = 1e-3;
/// Default number of replicates.
const REPLICATES: u64 = 10;
/// Default master seed.
const SEED: u64 = 1;

/// Makes a case of a document and checks it.
pub(super) fn resolve(mut document: Document<'_>, files: &DataFiles) -> Result<(Case, Vec<Note>), Error> {
    version(&mut document)?;
    let sources = Sources::of(&document);
    let written = Written::read(&mut document, files);
    if !document.problems.is_empty() {
        return Err(Document::sorted(document.problems).into());
    }
    let mut notes = std::mem::take(&mut document.notes);
    let case = written.case(&sources, &mut notes)?;
    match case.check() {
        Ok(more) => {
            notes.extend(more.into_iter().map(|note| sources.placed(note)));
            Ok((case, Document::sorted(notes)))
        }
        Err(problems) => {
            let placed = problems.into_iter().map(|problem| sources.placed(problem)).collect();
            Err(Document::sorted(placed).into())
        }
    }
}

/// What a case file says, as written or by default, before anything is made of it.
pub(super) struct Base {
    /// Values of the keys that have a number, in SI units; none for those that follow from others where they are
    /// not written.
    pub(super) values: BTreeMap<&'static str, Option<f64>>,
    /// Number of replicates.
    pub(super) replicates: u64,
    /// Master seed.
    pub(super) seed: u64,
}

/// Reads what a document says.
pub(super) fn base(mut document: Document<'_>, files: &DataFiles) -> Result<Base, Error> {
    version(&mut document)?;
    let written = Written::read(&mut document, files);
    if !document.problems.is_empty() {
        return Err(Document::sorted(document.problems).into());
    }
    let Written {
        fibre,
        element_length,
        air,
        harmonics,
        drag,
        duration,
        time_step,
        error_tolerance,
        spin_up,
        ..
    } = written;
    let mut values = BTreeMap::from(
        [
            (&keys::LENGTH, fibre.length),
            (&keys::DIAMETER, fibre.diameter),
            (&keys::FIBRE_DENSITY, fibre.density),
            (&keys::YOUNGS_MODULUS, fibre.youngs_modulus),
            (&keys::VELOCITY, air.velocity),
            (&keys::TURBULENCE_INTENSITY, air.turbulence_intensity),
            (&keys::LENGTH_SCALE, air.length_scale),
            (&keys::CUTOFF_FREQUENCY, air.cutoff_frequency),
            (&keys::AIR_DENSITY, air.density),
            (&keys::VISCOSITY, air.kinematic_viscosity),
            (&keys::SPEED_FACTOR, air.speed_factor),
            (&keys::DURATION, duration),
            (&keys::GRAVITY, written.run.gravity),
            (&keys::SPIN_UP, spin_up),
            (&keys::DAMPING, written.run.damping),
        ]
        // What the flow tells is no number yet.
        .map(|(quantity, value)| (quantity.key, Some(value).filter(|value| !value.is_nan()))),
    );
    values.insert(
        keys::DECAY_TIME.key,
        match air.eddies {
            EddyModel::Convected { decay_time } => Some(decay_time).filter(|time| time.is_finite()),
            EddyModel::Independent => None,
        },
    );
    values.insert(keys::FRICTION_COEFFICIENT.key, drag.along.factor());
    values.insert(keys::ELEMENT_LENGTH.key, element_length);
    values.insert(keys::TIME_STEP.key, time_step);
    values.insert(keys::ERROR_TOLERANCE.key, error_tolerance);
    values.insert(keys::OUTPUT_INTERVAL.key, written.output_interval);
    values.insert(keys::HARMONICS, harmonics.map(|harmonics| harmonics as f64));
    Ok(Base { values, replicates: written.run.replicates, seed: written.run.seed })
}

/// Refuses a file of a later format before anything else in it is judged.
fn version(document: &mut Document<'_>) -> Result<(), Error> {
    let Some(Entry { place, shown, value }) = document.take(VERSION) else {
        return Ok(());
    };
    let known = FORMAT_VERSION;
    let what = match &value {
        DeValue::Integer(number) => match number.as_str().parse() {
            Ok(version) if (1..=i128::from(known)).contains(&version) => return Ok(()),
            Ok(version) if version < 1 => Fault::OutOfRange { least: 1, most: u64::from(known) },
            _ => Fault::NewerVersion { known },
        },
        other => Fault::WrongType { found: kind(other), wanted: format!("a whole number, {known}") },
    };
    Err(vec![Finding { place, key: VERSION.to_owned(), value: shown, what }].into())
}

/// Where the values of a case come from.
struct Sources {
    file: Place,
    written: BTreeMap<String, (Place, Option<String>)>,
}

impl Sources {
    fn of(document: &Document<'_>) -> Self {
        Self { file: document.whole(), written: document.sources() }
    }

    /// The finding with the place and the text of the value it is about.
    fn placed<W>(&self, mut finding: Finding<W>) -> Finding<W> {
        match self.written.get(&finding.key) {
            Some((place, shown)) => {
                (finding.place, finding.value) = (place.clone(), shown.clone());
            }
            None => {
                finding.place = self.file.clone();
                finding.value = finding.value.map(|value| format!("{value} (the default)"));
            }
        }
        finding
    }
}

/// What a case file says, in SI units, before anything is made of it.
struct Written {
    fibre: Fibre,
    element_length: Option<f64>,
    air: Air,
    harmonics: Option<u64>,
    drag: Drag,
    duration: f64,
    time_step: Option<f64>,
    error_tolerance: Option<f64>,
    spin_up: f64,
    output_interval: Option<f64>,
    /// Its times are still to be filled in.
    run: Run,
}

impl Written {
    fn read(d: &mut Document<'_>, files: &DataFiles) -> Self {
        let fibre = Fibre {
            length: d.required(&keys::LENGTH, "length = \"1 m\""),
            diameter: d.required(&keys::DIAMETER, "diameter = \"50 µm\""),
            density: d.required(&keys::FIBRE_DENSITY, "density = \"950 kg/m³\""),
            youngs_modulus: d.required(&keys::YOUNGS_MODULUS, "youngs_modulus = \"2 GPa\""),
            elements: 0,
            root: d.choice("fibre.root", &keys::ROOTS.map(|one| (one.name(), one))).unwrap_or(Root::Pinned),
            direction: d.direction(keys::DIRECTION).unwrap_or(Vec3::new(1.0, 0.0, 0.0)),
        };
        let element_length = d.optional(&keys::ELEMENT_LENGTH);
        let air = air::read(d, files);
        let harmonics = d.whole_number(keys::HARMONICS, 1, usize::MAX as u64);
        let mut along = d
            .choice("drag.along", &keys::FRICTION_LAWS.map(|one| (one.name(), one)))
            .unwrap_or(keys::FRICTION_LAWS[0]);
        if let Some(entry) = d.take(keys::FRICTION_COEFFICIENT.key) {
            match &mut along {
                FrictionLaw::Matsui { factor } => *factor = d.quantity(&keys::FRICTION_COEFFICIENT, entry),
                _ => {
                    let (needed, remedy) = ("drag.along = \"matsui\"", "strike it out, the law has its own");
                    let fault = Fault::Needs { needed, remedy };
                    d.reject(entry.place, keys::FRICTION_COEFFICIENT.key, entry.shown, fault);
                }
            }
        }
        let drag = Drag {
            along,
            across: d
                .choice("drag.across", &keys::NORMAL_LAWS.map(|one| (one.name(), one)))
                .unwrap_or(NormalLaw::JuShambaugh),
        };
        let duration = d.required(&keys::DURATION, "duration = \"1 s\"");
        let time_step = d.optional(&keys::TIME_STEP);
        let error_tolerance = d.optional(&keys::ERROR_TOLERANCE);
        let spin_up = d.optional(&keys::SPIN_UP).unwrap_or(0.0);
        let output_interval = d.optional(&keys::OUTPUT_INTERVAL);
        let run = Run {
            time_step: time_step.unwrap_or(duration),
            steps: 0,
            spin_up_steps: 0,
            output_steps: 0,
            replicates: d.whole_number(keys::REPLICATES, 1, MOST_REPLICATES).unwrap_or(REPLICATES),
            seed: d.whole_number("run.seed", 0, u64::MAX).unwrap_or(SEED),
            scheme: d
                .choice("run.scheme", &keys::SCHEMES.map(|one| (one.name(), one)))
                .unwrap_or(Scheme::SemiImplicitEuler),
            gravity: d.optional(&keys::GRAVITY).unwrap_or(GRAVITY),
            damping: d.optional(&keys::DAMPING).unwrap_or(0.0),
        };
        Self {
            fibre,
            element_length,
            air,
            harmonics,
            drag,
            duration,
            time_step,
            error_tolerance,
            spin_up,
            output_interval,
            run,
        }
    }

    /// The case that is meant, before it is checked.
    fn case(&self, sources: &Sources, notes: &mut Vec<Note>) -> Result<Case, Error> {
        let Self { mut fibre, mut run, drag, .. } = *self;
        let mut air = self.air.clone();
        air.settle(fibre.direction * fibre.length);
        let mut chosen = Vec::new();
        let mut note = |quantity: &Quantity, value: f64, remark: Remark| {
            let value = Some(quantity.dimension.pretty(value));
            let key = quantity.key.to_owned();
            notes.push(sources.placed(Note { place: Place::Code, key, value, what: remark }));
        };

        let element_length = self.element_length.unwrap_or(air.length_scale.min(fibre.length));
        let (mut elements, whole) = nearest_whole(fibre.length, element_length);
        if self.element_length.is_none() && !whole && (elements as f64) < fibre.length / element_length {
            // No longer than an eddy: none is to be skipped.
            elements += 1;
        }
        fibre.elements = usize::try_from(elements.max(1)).unwrap_or(usize::MAX);
        if !whole {
            let remark =
                Remark::ElementsRounded { elements: fibre.elements, element_length: fibre.rest_length() };
            note(&keys::ELEMENT_LENGTH, element_length, remark);
        }

        let time_step = self.time_step.unwrap_or_else(|| {
            let open = Case { fibre, air: air.clone(), drag, run };
            let tolerance = self.error_tolerance.unwrap_or(ERROR_TOLERANCE);
            let (time_step, choice) = open.suggested_time_step(tolerance, self.duration);
            let limits = open.stable_step_limits();
            let limit = limits.iter().map(|limit| limit.limit).fold(f64::INFINITY, f64::min);
            let value = Some(keys::TIME_STEP.dimension.pretty(time_step));
            let (place, key) = (sources.file.clone(), keys::TIME_STEP.key.to_owned());
            chosen.push(Note { place, key, value, what: Remark::StepChosen { choice, limit } });
            time_step
        });
        if let (Some(_), Some(tolerance)) = (self.time_step, self.error_tolerance) {
            note(&keys::ERROR_TOLERANCE, tolerance, Remark::ToleranceUnused);
        }

        let steps = (self.duration / time_step).ceil().max(1.0);
        if steps > MOST_STEPS as f64 {
            let fault = Fault::TooManySteps { steps, most: MOST_STEPS as f64, time_step };
            let value = Some(keys::DURATION.dimension.pretty(self.duration));
            let problem =
                Finding { place: Place::Code, key: keys::DURATION.key.to_owned(), value, what: fault };
            return Err(vec![sources.placed(problem)].into());
        }
        let (nearest, whole) = nearest_whole(self.duration, time_step);
        (run.steps, run.time_step) = (nearest, time_step);
        if !whole || nearest == 0 {
            // More steps, and these shorter: never beyond a limit that the step as written keeps.
            run.steps = steps as u64;
            run.time_step = self.duration / steps;
            let remark = Remark::StepShortened { steps: run.steps, time_step: run.time_step };
            if self.time_step.is_some() {
                note(&keys::TIME_STEP, time_step, remark);
            }
        }

        let (spin_up_steps, whole) = nearest_whole(self.spin_up, run.time_step);
        run.spin_up_steps = spin_up_steps;
        if !whole {
            note(&keys::SPIN_UP, self.spin_up, Remark::TimeRounded { time: run.spin_up() });
        }
        if let Some(interval) = self.output_interval {
            let (output_steps, whole) = nearest_whole(interval, run.time_step);
            run.output_steps = output_steps.max(1);
            if !whole {
                note(&keys::OUTPUT_INTERVAL, interval, Remark::TimeRounded { time: run.output_interval() });
            }
        } else {
            run.output_steps = nearest_whole(OUTPUT_INTERVAL, run.time_step).0.clamp(1, run.steps);
        }

        air.harmonics = match self.harmonics {
            Some(harmonics) => usize::try_from(harmonics).unwrap_or(usize::MAX),
            None => air.default_harmonics(run.duration()),
        };
        notes.append(&mut chosen);
        Ok(Case { fibre, air, drag, run })
    }
}

/// How often `part` goes into `whole`, to the nearest whole number, and whether it does so exactly but for
/// rounding.
pub(super) fn nearest_whole(whole: f64, part: f64) -> (u64, bool) {
    let ratio = whole / part;
    let nearest = ratio.round();
    (nearest as u64, (ratio - nearest).abs() <= 8.0 * f64::EPSILON * ratio)
}
