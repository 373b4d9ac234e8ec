//! The conditions that a case must meet before it can be run.

use super::Case;
use super::keys::{self, FLOWN, diagnostic};
use super::limits::{FLIGHT_MEMORY_LIMIT, MOST_INSTANTS, MOST_STEPS};
use super::step::{FEEDING, StepLimit};
use crate::body::Root;
use crate::chain::Scheme;
use crate::line::Contact;
use spunlaid_air::{FileContent, Flow, Lateral, Measured, PlacedField};
use spunlaid_ground::{Diagnostic, Dimension, Fault, error};

impl Case {
    /// Checks everything that must hold for the case to be run.
    ///
    /// Returns notes and warnings about a case that can be run.
    ///
    /// # Errors
    /// Returns every reason why the case cannot be run.
    pub fn check(&self) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
        let mut check = Check { case: self, problems: Vec::new() };
        check.values();
        let values_are_sound = check.problems.is_empty();
        // If a value is wrong on its own, messages about its relation to others would only confuse.
        if check.problems.is_empty() {
            check.geometry();
            check.field();
            check.magnitudes();
        }
        if check.problems.is_empty() {
            let fits = check.memory();
            check.times();
            check.shared_record();
            // It makes a list of the eddies, of which there may be more than there is memory for.
            if fits {
                check.records();
            }
        }
        if check.problems.is_empty() {
            return Ok(self.notes());
        }
        if values_are_sound {
            self.blame_slips(&mut check.problems);
        }
        Err(check.problems)
    }
}

/// How far the speed of whole steps may be from that of the feed, by rounding [-].
const WHOLE_STEPS: f64 = 1e-6;

struct Check<'a> {
    case: &'a Case,
    problems: Vec<Diagnostic>,
}

impl Check<'_> {
    fn blame(&mut self, key: &str, value: f64, fault: Fault) {
        self.problems.push(diagnostic(key, value, fault));
    }

    fn blame_key(&mut self, key: &str, value: String, fault: Fault) {
        self.problems.push(Diagnostic::from(fault).with_key(key, Some(value)));
    }

    /// Checks each value on its own.
    fn values(&mut self) {
        // Nothing follows from such air but numbers that are not finite.
        if let Flow::Field(placed) = &self.case.air.flow
            && self.case.air.velocity == 0.0
        {
            let fault = Fault::new(
                "is a place from which the air of the field does not move all along the fibre, as in a wall",
                "write the place of the spinneret, and the direction of the fibre in air.field_axis",
            );
            return self.blame_key("air.field_root", PlacedField::in_case(placed.root), fault);
        }
        let (run, elements) = (self.case.run, self.case.fibre.elements as u64);
        for key in keys::all() {
            if let Some(value) = key.get(self.case)
                // A tension that flights have to find is this word as long as they have not.
                && value != FLOWN.into()
                && let Some(fault) = key.kind.fault(&value)
            {
                self.blame_key(key.name, key.kind.pretty(&value), fault);
            }
        }
        if elements == 0 {
            let fault = Fault::out_of_range(1, u64::MAX);
            self.blame_key("fibre.elements", elements.to_string(), fault);
        }
        if run.steps > MOST_STEPS {
            let fault = too_many_steps(run.steps as f64, run.time_step);
            self.blame("run.duration", run.duration(), fault);
        }
    }

    fn geometry(&mut self) {
        let fibre = self.case.fibre;
        if fibre.diameter >= fibre.length {
            let length = Dimension::Length.pretty(fibre.length);
            let fault = Fault::new(
                format!("is not smaller than fibre.length = {length}"),
                "a fibre must be longer than it is thick",
            );
            self.blame("fibre.diameter", fibre.diameter, fault);
        }
        if let Some(line) = self.case.line
            && fibre.rest_length() > 0.5 * line.distance
        {
            let distance = Dimension::Length.pretty(line.distance);
            let fault = Fault::new(
                format!(
                    "is longer than half of belt.distance = {distance}, so that the fibre cannot bend on its way"
                ),
                "shorten the elements, or correct the distance",
            );
            self.blame("fibre.element_length", fibre.rest_length(), fault);
        }
        self.feed();
        if self.case.line.is_some() && fibre.root == Root::Free {
            let other = "[feed]";
            let remedy = "the feed drives the root, so choose \"clamped\" or \"pinned\"";
            self.blame_key("fibre.root", "\"free\"".to_owned(), Fault::excludes(other, remedy));
        }
        let scheme = self.case.run.scheme;
        if self.case.line.is_some_and(|line| line.contact != Contact::Stick)
            && scheme != Scheme::ImplicitTension
        {
            let remedy =
                "only implicit tension computes how a fibre slides; choose it, or let the fibre stick";
            let (other, shown) = ("this run.scheme", format!("\"{}\"", "friction"));
            self.blame_key("belt.contact", shown, Fault::excludes(other, remedy));
        }
        if self.case.line.is_some() && fibre.direction.x <= 0.0 {
            let remedy = "the belt lies along +x, so the first number has to be above zero";
            let direction = fibre.direction;
            let shown = format!("[{}, {}, {}]", direction.x, direction.y, direction.z);
            self.blame_key("fibre.direction", shown, Fault::excludes("[feed]", remedy));
        }
    }

    /// Checks that an element is fed in its whole number of steps: otherwise the fibre comes at another speed.
    fn feed(&mut self) {
        let Some(line) = self.case.line else { return };
        let (element, step) = (self.case.fibre.rest_length(), self.case.run.time_step);
        let speed = element / (line.steps_per_element as f64 * step);
        // A step that is longer than an element takes is refused for that.
        let is_short = step * line.feed_speed <= element * (1.0 + WHOLE_STEPS);
        if is_short && (speed / line.feed_speed - 1.0).abs() > WHOLE_STEPS {
            let fault = Fault::new(
                format!(
                    "feeds an element in {} steps, which is a feed.speed of {}",
                    line.steps_per_element,
                    Dimension::Velocity.pretty_to(speed, 3)
                ),
                "set the time step after the element length (Case::set_time_step)",
            );
            self.blame("run.time_step", step, fault);
        }
    }

    /// Checks that quantities which follow from the values are neither zero nor infinite.
    fn magnitudes(&mut self) {
        let (fibre, strand) = (self.case.fibre, self.case.strand());
        for (what, value) in [
            ("the mass of an element [kg]", fibre.element_mass()),
            ("the axial stiffness of an element [N/m]", fibre.axial_stiffness()),
            ("the bending stiffness of a node [N·m]", fibre.rotational_stiffness()),
        ] {
            // The inverse must be finite as well.
            if !(value.is_normal() && (1.0 / value).is_normal()) {
                self.blame("fibre.diameter", fibre.diameter, Fault::degenerate(what, value));
                return;
            }
        }
        for (quantity, key, what, value) in [
            (
                "air.kinematic_viscosity",
                self.case.air.kinematic_viscosity,
                "the drag along an element",
                strand.drag.along.factor,
            ),
            (
                "air.kinematic_viscosity",
                self.case.air.kinematic_viscosity,
                "the drag across an element",
                strand.drag.across.factor,
            ),
            (
                "air.turbulence_intensity",
                self.case.air.turbulence_intensity,
                "the rms of the air's velocity [m/s]",
                self.case.air.rms(),
            ),
            (
                "run.duration",
                self.case.run.duration(),
                "the number of cycles at the cut-off frequency",
                self.case.run.duration() * self.case.air.cutoff_frequency,
            ),
            (
                "air.cutoff_frequency",
                self.case.air.cutoff_frequency,
                "the time after which the turbulence repeats [s]",
                self.case.air.repeat_time(),
            ),
        ] {
            if !value.is_finite() {
                self.blame(quantity, key, Fault::degenerate(what, value));
                return;
            }
        }
    }

    /// Checks that there is memory for a flight, and says so.
    fn memory(&mut self) -> bool {
        let (case, memory) = (self.case, self.case.flight_memory());
        let (bytes, most) = (memory.total(), FLIGHT_MEMORY_LIMIT);
        if bytes <= most {
            return true;
        }
        let (needed, allowed) = (error::memory(bytes), error::memory(most));
        let fault = |what: &str, remedy: &'static str| {
            let message = format!(
                "needs {needed} of memory for eight fibres side by side, most of it for {what}; at most \
                {allowed} is allowed"
            );
            Fault::new(message, remedy)
        };
        let air = &case.air;
        let largest =
            memory.chain.max(memory.turbulence).max(memory.synthesis).max(memory.field).max(memory.instants);
        let chosen = case.default_harmonics();
        if largest == memory.chain {
            let fault = fault("the chain", "choose a longer one");
            self.blame("fibre.element_length", case.fibre.rest_length(), fault);
        } else if largest == memory.field {
            let remedy = "choose a lower one, nearer neighbours, or longer eddies (air.length_scale)";
            let fault = fault("fields of eddies in space", remedy);
            self.blame("air.lateral_cutoff", air.lateral.cutoff().unwrap_or_default(), fault);
        } else if largest == memory.turbulence {
            let fault = fault("the turbulence", "choose a longer one, or shorten run.duration");
            self.blame("air.length_scale", air.length_scale, fault);
        } else if largest == memory.instants {
            let fault = fault("the recorded instants", "choose a longer one");
            self.blame("run.output_interval", case.run.output_interval(), fault);
        } else if air.harmonics == chosen {
            let fault = fault("making the turbulence", "choose a lower one, or shorten run.duration");
            self.blame("air.cutoff_frequency", air.cutoff_frequency, fault);
        } else {
            let fault = fault("making the turbulence", "choose fewer, or leave the key out");
            self.blame_key("air.harmonics", air.harmonics.to_string(), fault);
        }
        false
    }

    fn times(&mut self) {
        let (run, fibre) = (self.case.run, self.case.fibre);
        let limits = self.case.stable_step_limits();
        let tightest = limits.into_iter().min_by(|a, b| a.limit.total_cmp(&b.limit));
        // The memory check may have reported these keys already.
        let reported: Vec<String> = self.problems.iter().map(|problem| problem.key.clone()).collect();
        let is_reported = |key: &str| reported.iter().any(|other| other == key);
        if let Some(StepLimit { limit, cause }) = tightest
            && !is_reported("fibre.element_length")
            && run.time_step >= limit
        {
            let element_length = Dimension::Length.pretty(fibre.rest_length());
            let [longest, advice] = [limit, two_digits_down(0.9 * limit)].map(|h| Dimension::Time.pretty(h));
            let fault = match cause {
                FEEDING => {
                    let steps = match self.case.line.map_or(1, |line| line.fewest_steps()) {
                        1 => "one step at least".to_owned(),
                        steps => format!("{steps} steps at least"),
                    };
                    Fault::new(
                        format!("is too long: an element of {element_length} is fed in {steps}"),
                        format!("lower it to at most {longest}, or lengthen fibre.element_length"),
                    )
                }
                _ => Fault::new(
                    format!("exceeds the stability limit {longest} ({cause} of {element_length} elements)"),
                    format!("lower it to at most {advice} or lengthen fibre.element_length"),
                ),
            };
            self.blame("run.time_step", run.time_step, fault);
        }
        let whole = Dimension::Time.pretty(run.duration());
        if run.spin_up_steps >= run.steps {
            let fault = Fault::new(
                format!(
                    "is not shorter than run.duration = {whole}, so that no time is left for the statistics"
                ),
                "shorten it",
            );
            self.blame("run.spin_up", run.spin_up(), fault);
        }
        if run.output_steps > run.steps {
            let fault = Fault::new(format!("is longer than run.duration = {whole}"), "shorten it");
            self.blame("run.output_interval", run.output_interval(), fault);
        }
        let instants = (run.steps / run.output_steps + 1) as f64 * run.replicates as f64;
        if !is_reported("run.output_interval") && instants > MOST_INSTANTS {
            let fault = Fault::new(
                format!("records {instants:.1e} instants over all replicates, more than {MOST_INSTANTS:e}"),
                "lengthen it or lower run.replicates",
            );
            self.blame("run.output_interval", run.output_interval(), fault);
        }
    }
}

/// Checks of the velocity records that drive the fibre.
impl Check<'_> {
    /// Checks that the records are long enough for the flight of one fibre.
    fn records(&mut self) {
        let Some(shared) = self.case.air.records.first() else {
            return;
        };
        let (eddies, turbulence) = match self.case.stations() {
            Some(stations) => (stations.eddies(), self.case.air.turbulence_at(&stations)),
            None => {
                let eddies = self.case.eddies();
                let turbulence = self.case.turbulence_along(&eddies);
                (eddies, turbulence)
            }
        };
        let records = self.case.air.records.len();
        let convected = turbulence.iter().any(|t| t.carried.is_some());
        if convected && turbulence.iter().any(|eddy| eddy.decay_times > 0.0) {
            let other = "air.decay_time";
            let remedy = "a record is carried along unchanged; leave air.decay_time out";
            self.blame_key("air.record", self.names(), Fault::excludes(other, remedy));
        } else if convected && records > 1 {
            let other = "air.eddies = \"convected\"";
            let remedy = "one record is carried along; name one";
            self.blame_key("air.record", self.names(), Fault::excludes(other, remedy));
        } else if records > 1 && records != eddies.count() {
            let eddies = eddies.count();
            let fault = Fault::new(
                format!("names {records} records, but the fibre has {eddies} eddies"),
                "name one record for all, or one for each eddy",
            );
            self.blame_key("air.record", self.names(), fault);
        }
        let delay: f64 = turbulence.iter().filter_map(|eddy| eddy.carried).sum();
        let duration = self.case.run.duration() + self.case.run.time_step + delay;
        let sharing = if records == 1 && !convected { eddies.count() } else { 1 };
        let stretches = (sharing * shared.stretches_each()) as f64;
        let records: Vec<FileContent<Measured>> = self.case.air.records.clone();
        for record in records.iter().filter(|record| record.stretches(duration) < stretches) {
            let [each, all] = [
                Dimension::Time.pretty(duration),
                Dimension::Time.pretty_to(record.duration_for(stretches, duration), 3),
            ];
            let fault = Fault::new(
                format!(
                    "is too short: the turbulence along one fibre needs {stretches} stretches of {each} that start 5 \
                     integral times apart, which needs a record of {all}"
                ),
                "shorten run.duration, lengthen air.length_scale or record for longer",
            );
            self.blame_key("air.record", format!("{}", record.path().display()), fault);
        }
    }

    /// A CFD solution must have numbers where the fibre hangs, and one unit of length.
    fn field(&mut self) {
        const PLACES: usize = 256;
        let Flow::Field(placed) = &self.case.air.flow else {
            return;
        };
        let path = || format!("\"{}\"", placed.field.path().display());
        if let Some(coordinate) = placed.field.measured_coordinate().filter(|_| placed.unit != 1.0) {
            let fault = Fault::new(
                format!("scales coordinates whose unit is in the file ({coordinate})"),
                "leave it out, or take the unit out of the names of the coordinates",
            );
            self.blame_key("air.field_unit", format!("\"{}\"", Dimension::Length.pretty(placed.unit)), fault);
            return;
        }
        let [axis, machine, _] = placed.axes();
        if axis.index == machine.index {
            let fault = Fault::new(
                format!("is parallel to air.field_axis = \"{}\"", axis.name()),
                "the belt runs across the fibre: choose one of the four directions at a right angle to it, or leave \
                 this key out",
            );
            self.blame_key("air.field_machine_direction", format!("\"{}\"", machine.name()), fault);
            return;
        }
        let along = self.case.along();
        let lacks = (0..=PLACES).find_map(|i| placed.why_no_air(along * (i as f64 / PLACES as f64)));
        if let Some(fault) = lacks {
            self.blame_key("air.field", path(), fault);
        }
    }

    /// A field in space cannot be made from a record.
    fn shared_record(&mut self) {
        let lateral = self.case.air.lateral;
        if lateral != Lateral::Uniform && !self.case.air.records.is_empty() {
            let remedy = "a record is measured at one point, so the variation across the flow is not \
                known; write air.lateral = \"uniform\", or use the numbers and the spectrum of the \
                record (spunlaid analyse) instead of it";
            let fault = Fault::excludes("air.record", remedy);
            self.blame_key("air.lateral", format!("\"{}\"", lateral.name()), fault);
        }
    }

    fn names(&self) -> String {
        let paths = self.case.air.records.iter().map(|record| record.path().display().to_string());
        paths.collect::<Vec<_>>().join(", ")
    }
}

/// The fault of a run of more than [`MOST_STEPS`] steps.
pub fn too_many_steps(steps: f64, time_step: f64) -> Fault {
    let step = Dimension::Time.pretty(time_step);
    Fault::new(
        format!("needs {steps:.1e} steps of {step}, more than {:e}", MOST_STEPS as f64),
        "shorten it or lengthen run.time_step",
    )
}

/// Rounds a positive number down to two significant digits.
fn two_digits_down(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor() - 1.0);
    let digits = format!("{:.0}", (value / power).floor());
    format!("{digits}e{:.0}", power.log10()).parse().unwrap_or(value)
}
