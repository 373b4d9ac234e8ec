//! What is worth a note or a warning in a case that can be run.

use super::Case;
use super::keys::diagnostic;
use crate::drag::{NormalLaw, TableLaw};
use spunlaid_air::{Flow, Hint, PlacedField, SpectrumShape};
use spunlaid_ground::{Diagnostic, Dimension, Vec3};

/// Share of the measured drag across a fibre below which a case is warned [-].
const LOW_DRAG: f64 = 0.5;
/// Velocity at the belt over that at the inlet below which the widening of the air matters [-].
const LEAST_SLOWING: f64 = 0.9;
/// Change of the velocity over the width of a web, over its mean, above which a web is warned [-].
const MOST_ACROSS: f64 = 0.05;
/// Speed over the largest along the machine direction at the inlet from which on a place lies in the air of the slot
/// [-].
const IN_SLOT: f64 = 0.5;
/// Distance of a row from the middle of that air, over the width of the air, above which a web is warned [-].
const MOST_OFF_MIDDLE: f64 = 0.125;

impl Case {
    /// Notes and warnings.
    pub(super) fn notes(&self) -> Vec<Diagnostic> {
        let (fibre, l) = (&self.fibre, self.fibre.rest_length());
        let mut notes = Vec::new();
        let mut note = |key, value, remark| notes.push(diagnostic(key, value, remark));
        let across = self.drag.across;
        let there_is_air = self.air.density > 0.0;
        if let Some(fitted) = across.fitted_diameters()
            && there_is_air
            && !fitted.contains(&fibre.diameter)
        {
            let [from, to] = [fitted.start(), fitted.end()].map(|end| Dimension::Length.pretty(*end));
            let (law, instead) = (across.name(), NormalLaw::MarheinekeWegener.name());
            let text = format!(
                "is outside {from} to {to}, the range of diameters that drag.across = \"{law}\" was fitted to; the \
                 drag across the fibre is extrapolated. \"{instead}\" is valid for any diameter"
            );
            note("fibre.diameter", fibre.diameter, Diagnostic::warning(text));
        }
        if let Some(fitted) = across.fitted_reynolds()
            && !matches!(across, NormalLaw::Table(_))
            && there_is_air
            && !fitted.contains(&self.reynolds_across())
        {
            let text = format!(
                "gives Reynolds numbers across the fibre up to {}, and drag.across = \"{}\" is valid up to {}; the \
                 drag across the fibre is extrapolated. No other law covers so thick a fibre in so fast air",
                Dimension::Ratio.pretty_to(self.reynolds_across(), 3),
                across.name(),
                Dimension::Ratio.pretty(*fitted.end())
            );
            note("fibre.diameter", fibre.diameter, Diagnostic::warning(text));
        }
        let reynolds = self.usual_reynolds_across();
        // Outside of the diameters that it was fitted to, the case is warned of the law anyway.
        let fitted = across.fitted_diameters().is_some_and(|fitted| fitted.contains(&fibre.diameter));
        if across == NormalLaw::JuShambaugh && fitted && there_is_air && reynolds > 0.0 {
            let measured = NormalLaw::MarheinekeWegener;
            let drag = |law: NormalLaw| law.coefficient(reynolds, fibre.diameter);
            let share = drag(across) / drag(measured);
            if share < LOW_DRAG {
                let (law, instead) = (across.name(), measured.name());
                let [reynolds, share] = [reynolds, share].map(|number| Dimension::Ratio.pretty_to(number, 2));
                let text = format!(
                    "has Reynolds numbers of about {reynolds} across the fibre. There drag.across = \"{law}\" gives \
                     only {share} times the drag that was measured on fine fibres and cylinders; \"{instead}\" agrees \
                     with these measurements"
                );
                note("fibre.diameter", fibre.diameter, Diagnostic::warning(text));
            }
        }
        let element_length = Dimension::Length.pretty(l);
        if fibre.diameter > l {
            let text = format!("is larger than the element length, {element_length}; use longer elements");
            note("fibre.diameter", fibre.diameter, Diagnostic::warning(text));
        }
        // At the centres of the first and the last element.
        let centres = [0.5 * l, fibre.length - 0.5 * l].map(|s| fibre.direction * s);
        let is_inside = |at: Vec3<f64>| self.air.local(at, &mut Hint::default()).inside;
        let root_outside = self.root_outside();
        if root_outside.is_none() && !centres.into_iter().all(is_inside) {
            let (key, length) = match self.line {
                Some(line) => ("belt.distance", line.distance),
                None => ("fibre.length", fibre.length),
            };
            let text = "reaches out of the region where the flow is known; outside it, the air at the nearest \
                known point is used";
            note(key, length, Diagnostic::warning(text));
        }
        let felt = there_is_air && self.air.rms() > 0.0;
        if felt && self.air.length_scale < l * (1.0 - 1e-9) {
            let text = format!(
                "is shorter than the elements ({element_length}): each element only feels the eddy at its centre. \
                 Shorten fibre.element_length so that every eddy acts on the fibre"
            );
            note("air.length_scale", self.air.length_scale, Diagnostic::warning(text));
        }
        let (air, from_flow) = (&self.air, self.air.from_flow);
        let times = air.length_scale / fibre.length;
        if felt && air.records.is_empty() {
            if !from_flow.length_scale && times > 2.0 {
                let text = format!(
                    "is {} times fibre.length, so that the same fluctuation acts on the whole fibre; check the unit",
                    Dimension::Ratio.pretty_to(times, 2)
                );
                note("air.length_scale", air.length_scale, Diagnostic::warning(text));
            }
            let passing = air.velocity.abs() / air.length_scale;
            if !from_flow.cutoff_frequency
                && air.spectrum == SpectrumShape::VonKarman
                && air.cutoff_frequency < passing
            {
                let text = format!(
                    "is below velocity / length scale = {}, so that most of the energy of von Kármán's spectrum would \
                     lie above it and is moved below; choose a cut-off several times higher",
                    Dimension::Frequency.pretty(passing)
                );
                note("air.cutoff_frequency", air.cutoff_frequency, Diagnostic::warning(text));
            }
        }
        notes.extend(self.beyond_tables());
        notes.extend(self.slips());
        notes.extend(root_outside);
        notes.extend(self.field_notes());
        notes
    }

    /// Tables of drag laws that end before the Reynolds numbers that are to be expected.
    fn beyond_tables(&self) -> Vec<Diagnostic> {
        if self.air.density <= 0.0 {
            return Vec::new();
        }
        let feed = self.line.map_or(0.0, |line| line.feed_speed);
        let passing = (self.air.fastest(self.along()) - feed).abs();
        let rms = self.air.rms();
        let along = [rms.max(passing), 3.0 * rms + passing]
            .map(|speed| speed * self.fibre.diameter / self.air.kinematic_viscosity);
        let across = [self.usual_reynolds_across(), self.reynolds_across()];
        let of_tables = self.drag.tables().into_iter().zip([("drag.along", along), ("drag.across", across)]);
        let note = |(law, (key, expected)): (Option<TableLaw>, (&str, [f64; 2]))| {
            let (name, beyond) = law.and_then(|law| Some((law.name(), law.beyond(expected)?)))?;
            Some(Diagnostic::warning(beyond).with_key(key, Some(format!("\"{name}\""))))
        };
        of_tables.filter_map(note).collect()
    }

    /// A written intensity of more than the mean velocity.
    pub(super) fn intensity_above_one(&self) -> Option<f64> {
        let air = &self.air;
        let is_written = air.records.is_empty() && !air.from_flow.turbulence_intensity;
        let felt = air.density > 0.0 && air.rms() > 0.0;
        (felt && is_written && air.turbulence_intensity > 1.0).then_some(air.turbulence_intensity)
    }

    /// What is said of a web of such filaments, if the mean flow slows on their way and the case does not say
    /// whether it widens.
    pub fn slows_only(&self) -> Option<Diagnostic> {
        if !matches!(self.air.flow, Flow::Profile(_)) || self.air.widening.is_some() {
            return None;
        }
        let velocity = |at| self.air.local(at, &mut Hint::default()).velocity.x;
        let (from, to) = (velocity(Vec3::new(0.0, 0.0, 0.0)), velocity(self.along()));
        (to < LEAST_SLOWING * from).then(|| {
            let [from, to] = [from, to].map(|speed| Dimension::Velocity.pretty_to(speed, 3));
            Diagnostic::warning(format!(
                "lays filaments in air that slows from {from} to {to} and does not widen. Air slows in a channel \
                 that widens, and carries the filaments apart along the machine direction, so the web is more \
                 uniform. Write widening = \"md\" in [air] of the case, or \"none\" if it is meant"
            ))
        })
    }

    /// The machine direction of a field as the case has it, with what is said of it where nobody has written it.
    pub fn chosen_machine_direction(&self) -> Option<(&'static str, Diagnostic)> {
        let Flow::Field(placed) = &self.air.flow else { return None };
        let [_, machine, cross] = placed.axes();
        let plane = placed.field.even_axis() == Some(cross.index);
        let why = if plane {
            "along which its air is the same"
        } else {
            "a choice of the program, because its air is the same along none of its axes, or along two; write the \
            key if the belt runs otherwise"
        };
        let text = format!("is used: the cross direction (CD) is {} of the field, {why}", cross.name());
        Some((machine.name(), Diagnostic::choice(text)))
    }

    /// What is said of a web of this width [m], if the air of a field changes over it.
    pub fn changes_across(&self, width: f64) -> Option<Diagnostic> {
        const PLACES: i32 = 8;
        let Flow::Field(placed) = &self.air.flow else { return None };
        let mut hint = Hint::default();
        let mut at = |step: i32, z: f64| {
            let along = self.along() * ((f64::from(step) + 0.5) / f64::from(PLACES));
            self.air.local(along + Vec3::new(0.0, 0.0, z), &mut hint)
        };
        let middle: Vec<Vec3<f64>> = (0..PLACES).map(|step| at(step, 0.0).velocity).collect();
        let speed: f64 = middle.iter().map(|velocity| velocity.norm()).sum();
        let change = |side: i32| {
            let z = 0.5 * width * f64::from(side) / f64::from(PLACES);
            let there = middle.iter().zip(0..).map(|(here, step)| (here, at(step, z)));
            there
                .filter(|(_, there)| there.inside)
                .map(|(here, there)| (there.velocity - *here).norm())
                .sum::<f64>()
        };
        let share = (-PLACES..=PLACES).map(change).fold(0.0, f64::max) / speed;
        let cross = placed.axes()[2].name();
        (share > MOST_ACROSS).then(|| {
            Diagnostic::warning(format!(
                "lets the air change by {} % of its mean speed along the cross direction ({cross} of the \
                 field), over the {} of the web around the root. A web is laid as if its air were the \
                 same across. If {cross} is the machine direction, write it here; otherwise choose root \
                 and width where the air is uniform, or make a plane flow of the middle",
                Dimension::Ratio.pretty_to(100.0 * share, 2),
                Dimension::Length.pretty_to(width, 3)
            ))
        })
    }

    /// What is said of a web whose filaments are fed beside the air of a field, or not in its middle.
    ///
    /// * `from`, `to` – where they are fed along the machine direction, seen from the root [m]
    pub fn fed_off_the_middle(&self, [from, to]: [f64; 2]) -> Option<Diagnostic> {
        const PLACES: i32 = 400;
        let Flow::Field(placed) = &self.air.flow else { return None };
        let mut hint = Hint::default();
        let mut speed = |y: f64| {
            let at = self.fibre.direction * (0.5 * self.fibre.rest_length()) + Vec3::new(0.0, y, 0.0);
            Some(self.air.local(at, &mut hint)).filter(|air| air.inside).map(|air| air.velocity.norm())
        };
        let shown = |y: f64| Dimension::Length.pretty_to(y + 0.0, 3);
        let fed = match to - from > 0.0 {
            true => {
                format!("feeds filaments from {} to {} along the machine direction", shown(from), shown(to))
            }
            false => format!("feeds filaments at {} along the machine direction", shown(from)),
        };
        let remedy = "choose the position in the middle of the slot, at its upper end (air.field_root)";
        if [from, to].into_iter().any(|y| speed(y).is_none()) {
            return Some(Diagnostic::warning(format!(
                "{fed}, some of them outside of the region where the flow is known, where they meet the air of its \
                 edge; {remedy}, or a smaller line.slot_gap"
            )));
        }
        let ((low, high), reach) = (placed.extent(), self.fibre.length);
        let (low, high) = (low.y.max(-reach), high.y.min(reach));
        let place = |i: i32| low + (high - low) * (f64::from(i) + 0.5) / f64::from(PLACES);
        let middle = 0.5 * (from + to);
        let here = speed(middle)?;
        let speeds: Vec<(f64, f64)> =
            (0..PLACES).filter_map(|i| Some((place(i), speed(place(i))?))).collect();
        let (slowest, fastest) =
            speeds.iter().fold((here, here), |(least, most), (_, v)| (least.min(*v), most.max(*v)));
        if slowest >= IN_SLOT * fastest {
            return None;
        }
        let velocity = |speed: f64| Dimension::Velocity.pretty_to(speed, 3);
        if here < IN_SLOT * fastest {
            let at = speeds.iter().find(|(_, v)| *v == fastest).map_or(middle, |(y, _)| *y);
            return Some(Diagnostic::warning(format!(
                "{fed}, in air of {}, while that at {} has {}; {remedy}",
                velocity(here),
                shown(at),
                velocity(fastest)
            )));
        }
        // The fast air on both sides, up to the first slow one.
        let is_slow = |(_, v): &&(f64, f64)| *v < IN_SLOT * fastest;
        let before = speeds.iter().rev().filter(|(y, _)| *y < middle).find(is_slow).map_or(low, |(y, _)| *y);
        let after = speeds.iter().filter(|(y, _)| *y > middle).find(is_slow).map_or(high, |(y, _)| *y);
        (((0.5 * (before + after) - middle) / (after - before)).abs() > MOST_OFF_MIDDLE).then(|| {
            Diagnostic::warning(format!(
                "{fed}, off the middle of the fast air at the inlet, which reaches from {} to {}; {remedy}",
                shown(before),
                shown(after)
            ))
        })
    }

    /// Whether the root is farther outside of a field's box than rounding.
    fn root_outside(&self) -> Option<Diagnostic> {
        let Flow::Field(placed) = &self.air.flow else {
            return None;
        };
        let (low, high) = placed.field.bounds();
        let root = placed.root * (1.0 / placed.unit);
        let far = 1e-9 * (high - low).norm();
        let outside = |x: f64, low: f64, high: f64| low < high && !(low - far..=high + far).contains(&x);
        if !(outside(root.x, low.x, high.x)
            || outside(root.y, low.y, high.y)
            || outside(root.z, low.z, high.z))
        {
            return None;
        }
        let what = Diagnostic::warning(format!(
            "is outside of the box around the field, {} to {}; the air at the nearest point of the field is used \
             there",
            PlacedField::in_words(low * placed.unit),
            PlacedField::in_words(high * placed.unit)
        ));
        let value = Some(PlacedField::in_case(placed.root));
        Some(what.with_key("air.field_root", value))
    }

    /// A field that may be turned or scaled wrongly.
    fn field_notes(&self) -> Vec<Diagnostic> {
        let Flow::Field(placed) = &self.air.flow else {
            return Vec::new();
        };
        let mut notes = Vec::new();
        let mut note =
            |key: &str, value: String, what: Diagnostic| notes.push(what.with_key(key, Some(value)));
        let (along, speed) = self.air.along_and_speed(self.along());
        if along < 0.25 * speed {
            let how = if along < 0.0 { "it blows from the end to the root" } else { "it blows across" };
            let [along, speed] = [along, speed].map(|speed| Dimension::Velocity.pretty_to(speed, 3));
            let what = Diagnostic::warning(format!(
                "lets the air flow along the fibre with {along} on average, although its speed is {speed}: {how}; \
                 choose the direction in which the air leaves the spinneret"
            ));
            note("air.field_axis", format!("\"{}\"", placed.axis.name()), what);
        }
        let [_, machine, cross] = placed.axes();
        if placed.field.is_even_along(machine.index) && !placed.field.is_even_along(cross.index) {
            let cross = cross.name();
            let what = Diagnostic::warning(format!(
                "makes the air the same along the machine direction, and lets it change along the cross direction \
                 ({cross} of the field), as if the two were swapped: the air of a slot is the same across. Write \
                 \"{cross}\", or leave the key out"
            ));
            note("air.field_machine_direction", format!("\"{}\"", machine.name()), what);
        }
        let (low, high) = placed.extent();
        let size = high - low;
        let (field, fibre) = (size.x.max(size.y).max(size.z), self.fibre.length);
        if field > 30.0 * fibre || field < fibre / 30.0 {
            let unit = Dimension::Length.pretty(placed.unit);
            let what = Diagnostic::warning(format!(
                "makes the field {} long, while the fibre is {} long; check that this is the unit of the mesh",
                Dimension::Length.pretty_to(field, 3),
                Dimension::Length.pretty(fibre)
            ));
            note("air.field_unit", unit, what);
        }
        notes
    }
}
