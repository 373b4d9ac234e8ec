//! Divides what an open case leaves to be counted: the fibre into elements, the time into steps and instants.
//! The case is checked then.

use super::open::OpenCase;
use super::written_values::{WrittenValues, sorted};
use spunlaid_air::EddyModel;
use spunlaid_fibre::case::keys::{self, Value};
use spunlaid_fibre::case::{too_many_steps, unusual, whole_parts};
use spunlaid_fibre::{Case, Fibre, MOST_STEPS, StepChoice};
use spunlaid_ground::{Diagnostic, Dimension, Error};

/// How many times longer a suitable step must be than the written one to be mentioned.
const MUCH_LONGER: f64 = 50.0;
/// Length of fibre that still moves on the belt, over the distance from inlet to belt. Of a usual filament 2
/// % still hang in arches when it leaves the chain; with a quarter of this length it is a third.
const KEPT: f64 = 0.25;
/// The key that says how the belt runs in a field.
const MACHINE_DIRECTION: &str = "air.field_machine_direction";

impl OpenCase {
    /// The checked case, with notes and warnings. The tension at the end of its spinline is taken as it is known.
    ///
    /// # Errors
    /// Every reason why the case cannot be run.
    pub(super) fn resolve_at_once(mut self) -> Result<(Case, Vec<Diagnostic>), Error> {
        self.spin()?;
        let fibre = &self.case.fibre;
        self.case.air.settle_along(fibre.direction * fibre.length);
        self.count_elements();
        let chosen = self.find_step();
        self.count_steps()?;
        self.count_instants();
        self.case.air.harmonics =
            match self.key_values.get("air.harmonics").map(|written_value| &written_value.value) {
                Some(Some(Value::Whole(harmonics))) => usize::try_from(*harmonics).unwrap_or(usize::MAX),
                _ => self.case.default_harmonics(),
            };
        if let Some((time_step, remark)) = chosen {
            let place = self.key_values.whole();
            self.notes.push(Diagnostic { place, ..keys::diagnostic("run.time_step", time_step, remark) });
        }
        self.look_at_what_no_case_has();
        if !self.is_written(MACHINE_DIRECTION)
            && let Some((axis, what)) = self.case.chosen_machine_direction()
        {
            let (place, key) = (self.key_values.whole(), MACHINE_DIRECTION.to_owned());
            self.notes.push(Diagnostic { place, key, value: Some(format!("\"{axis}\"")), ..what });
        }
        match self.case.check() {
            Ok(more) => {
                self.notes.extend(more.into_iter().map(|note| self.key_values.placed(note)));
                Ok((self.case, sorted(self.notes)))
            }
            Err(problems) => {
                let placed = problems.into_iter().map(|problem| self.key_values.placed(problem)).collect();
                Err(sorted(placed).into())
            }
        }
    }

    /// Notes unusual values of keys that stand for others, which the case itself does not have.
    fn look_at_what_no_case_has(&mut self) {
        for key in keys::all() {
            if key.get(&self.case).is_none()
                && let (Some(dimension), Some(usual)) = (key.dimension(), key.usual)
                && let Some(value) = self.key_values.number(key.name)
                && let Some(remark) = unusual(dimension, usual, value)
            {
                self.note(key.name, value, remark);
            }
        }
    }

    fn note(&mut self, key: &str, value: f64, remark: Diagnostic) {
        self.notes.push(self.key_values.placed(keys::diagnostic(key, value, remark)));
    }

    fn number_of(&self, key: &str) -> f64 {
        keys::find(key).and_then(|key| self.number(key)).unwrap_or(f64::NAN)
    }

    fn is_written(&self, key: &str) -> bool {
        self.key_values.get(key).is_some()
    }

    /// Divides the fibre into elements.
    fn count_elements(&mut self) {
        let Self { key_values, case, .. } = self;
        let written_length = key_values.number("fibre.element_length");
        if case.line.is_some() {
            feed(case, key_values, written_length);
            return;
        }
        let (fibre, length_scale) = (&mut case.fibre, case.air.length_scale);
        if let Some(element_length) = divide(fibre, written_length, length_scale) {
            let (elements, rest_length) = (fibre.elements, fibre.rest_length());
            let rest_length = Dimension::Length.pretty(rest_length);
            let are_used = are_used(elements as u64);
            let text = format!(
                "does not divide fibre.length into whole elements: {elements} of {rest_length} {are_used}"
            );
            self.note("fibre.element_length", element_length, Diagnostic::note(text));
        }
    }

    /// Sets the time step as written, or chooses one and returns it [s] with the reason.
    fn find_step(&mut self) -> Option<(f64, Diagnostic)> {
        let [duration, tolerance] = ["run.duration", "run.error_tolerance"].map(|key| self.number_of(key));
        let written_step = self.key_values.number("run.time_step");
        self.case.run.time_step = written_step.unwrap_or(duration);
        let (suggested, choice) = self.case.suggested_time_step(tolerance, duration);
        let Some(step) = written_step else {
            let limits = self.case.stable_step_limits();
            let limit = limits.iter().map(|limit| limit.limit).fold(f64::INFINITY, f64::min);
            self.case.run.time_step = suggested;
            let stable = match choice {
                StepChoice::Feed => "the longest possible is",
                _ => "the simulation is stable up to",
            };
            let limit = Dimension::Time.pretty(limit);
            return Some((
                suggested,
                Diagnostic::choice(format!("is used ({}); {stable} {limit}", choice.reason())),
            ));
        };
        if suggested >= MUCH_LONGER * step {
            let text = format!(
                "is {} times shorter than the step that run.scheme = \"{}\" needs ({}), so the run takes that much \
                 longer; leave the key out, or override it with the value auto",
                Dimension::Ratio.pretty_to(suggested / step, 2),
                self.case.run.scheme.name(),
                Dimension::Time.pretty(suggested)
            );
            self.note("run.time_step", step, Diagnostic::note(text));
        }
        if self.is_written("run.error_tolerance") {
            let text = "has no effect because run.time_step is given; remove one of the two";
            self.note("run.error_tolerance", tolerance, Diagnostic::note(text));
        }
        None
    }

    /// Divides the duration into whole steps.
    fn count_steps(&mut self) -> Result<(), Error> {
        let duration = self.number_of("run.duration");
        let time_step = self.case.run.time_step;
        let steps = (duration / time_step).ceil().max(1.0);
        if steps > MOST_STEPS as f64 {
            let fault = too_many_steps(steps, time_step);
            let mut problems = vec![keys::diagnostic("run.duration", duration, fault)];
            self.case.blame_slips(&mut problems);
            return Err(sorted(
                problems.into_iter().map(|problem| self.key_values.placed(problem)).collect(),
            )
            .into());
        }
        let (nearest, whole) = whole_parts(duration, time_step);
        self.case.run.steps = nearest;
        if self.case.line.is_some() {
            if let Some(remark) = feed_in_whole_steps(&mut self.case, duration) {
                self.note("run.time_step", time_step, remark);
            }
        } else if !whole || nearest == 0 {
            let run = &mut self.case.run;
            // Round up: a shorter step keeps every limit that the written step keeps.
            (run.steps, run.time_step) = (steps as u64, duration / steps);
            let used = Dimension::Time.pretty_to(run.time_step, 8);
            let are_used = are_used(run.steps);
            let text =
                format!("does not divide run.duration into whole steps: {} of {used} {are_used}", run.steps);
            if self.is_written("run.time_step") {
                self.note("run.time_step", time_step, Diagnostic::note(text));
            }
        }
        Ok(())
    }

    /// Sets the whole numbers of steps of the spin-up and between two recorded instants.
    fn count_instants(&mut self) {
        let [interval, spin_up] = ["run.output_interval", "run.spin_up"].map(|key| self.number_of(key));
        let [interval_written, spin_up_written] =
            ["run.output_interval", "run.spin_up"].map(|key| self.is_written(key));
        let run = &mut self.case.run;
        let spin_up = match &self.case.line {
            Some(line) if !spin_up_written => {
                (4.0 * line.distance / line.feed_speed).min(0.5 * run.duration())
            }
            _ => spin_up,
        };
        let (spin_up_steps, spin_up_whole) = whole_parts(spin_up, run.time_step);
        let (output_steps, interval_whole) = whole_parts(interval, run.time_step);
        (run.spin_up_steps, run.output_steps) = (spin_up_steps, output_steps.max(1));
        if !interval_written {
            run.output_steps = run.output_steps.min(run.steps);
        }
        let rounded = [
            ("run.spin_up", spin_up, run.spin_up(), !spin_up_whole && spin_up_written),
            ("run.output_interval", interval, run.output_interval(), !interval_whole && interval_written),
        ];
        for (key, time, used, _) in rounded.into_iter().filter(|(.., is_rounded)| *is_rounded) {
            let used = Dimension::Time.pretty(used);
            self.note(
                key,
                time,
                Diagnostic::note(format!("is not a whole number of time steps: {used} is used")),
            );
        }
    }
}

/// Divides a fibre of fixed length into elements: of the written length, or else as long as an eddy. Returns the wanted
/// length of an element [m] if the fibre is not a whole number of them.
fn divide(fibre: &mut Fibre, written_length: Option<f64>, length_scale: f64) -> Option<f64> {
    let element_length = written_length.unwrap_or(length_scale.min(fibre.length));
    let (mut elements, whole) = whole_parts(fibre.length, element_length);
    if written_length.is_none() && !whole && (elements as f64) < fibre.length / element_length {
        // An element must not be longer than an eddy, so that no eddy is skipped.
        elements += 1;
    }
    fibre.elements = usize::try_from(elements.max(1)).unwrap_or(usize::MAX);
    (!whole).then_some(element_length)
}

/// Sets what follows from the distance to the belt: the elements, the length that still moves on the belt,
/// and the decay time of the eddies.
fn feed(case: &mut Case, key_values: &WrittenValues, written_length: Option<f64>) {
    let Some(line) = &mut case.line else { return };
    case.fibre.span(line.distance, written_length.unwrap_or(line.distance / 125.0));
    if key_values.get("belt.kept_length").is_none() {
        line.kept_length = KEPT * line.distance;
    }
    // An eddy turns over in this time. Air at rest has none.
    let turnover = case.air.length_scale / case.air.rms();
    if let EddyModel::Convected { decay_time } = &mut case.air.eddies
        && key_values.get("air.decay_time").is_none()
        && case.air.records.is_empty()
    {
        *decay_time = turnover;
    }
}

/// Shortens the time step of a fed fibre so that an element is fed in a whole number of steps, and sets the number of
/// steps of the run. A step that is too long for the feed stays as it is, because it is refused later.
fn feed_in_whole_steps(case: &mut Case, duration: f64) -> Option<Diagnostic> {
    let (length, step) = (case.fibre.rest_length(), case.run.time_step);
    let line = case.line.as_mut()?;
    let lifetime = length / line.feed_speed;
    line.steps_per_element = line.steps_of(length, step);
    let whole = lifetime / line.steps_per_element as f64;
    let keeps = (whole / step - 1.0).abs() < 1e-9 || step > 0.5 * lifetime;
    case.run.time_step = if keeps { step } else { whole };
    case.run.steps = whole_parts(duration, case.run.time_step).0.max(1);
    let steps = line.steps_per_element;
    let used = Dimension::Time.pretty_to(case.run.time_step, 8);
    (!keeps).then(|| {
        Diagnostic::note(format!(
            "does not divide the time in which an element is fed into whole steps: {steps} of {used} are used for each"
        ))
    })
}

fn are_used(count: u64) -> &'static str {
    if count == 1 { "is used" } else { "are used" }
}
