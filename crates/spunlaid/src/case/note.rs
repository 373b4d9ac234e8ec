//! Notes and warnings about a case that can be run.

use super::StepChoice;
use crate::charge::BREAKDOWN;
use crate::error::{Fault, Finding, Problem};
use crate::units::Dimension;

/// A note or a warning about a case that can be run.
pub type Note = Finding<Remark>;

/// What a note or a warning says about a value of a case. The text continues after `key = value `.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Remark {
    /// The fibre is not a whole number of elements long.
    #[error(
        "does not divide fibre.length into whole elements: {elements} of {} {}",
        Dimension::Length.pretty(*element_length), if *elements == 1 { "is used" } else { "are used" }
    )]
    ElementsRounded {
        /// Number of elements used.
        elements: usize,
        /// Their rest length [m].
        element_length: f64,
    },
    /// An element is not fed in a whole number of steps.
    #[error(
        "does not divide the time in which an element is fed into whole steps: {steps} of {} are used for each",
        Dimension::Time.pretty_to(*time_step, 8)
    )]
    StepShortenedToFeed {
        /// Number of steps for an element.
        steps: u64,
        /// Length of a step [s].
        time_step: f64,
    },
    /// The run is not a whole number of steps long.
    #[error(
        "does not divide run.duration into whole steps: {steps} of {} {}",
        Dimension::Time.pretty_to(*time_step, 8), if *steps == 1 { "is used" } else { "are used" }
    )]
    StepShortened {
        /// Number of steps used.
        steps: u64,
        /// Their length [s].
        time_step: f64,
    },
    /// The case gives no time step.
    #[error(
        "is used ({}); {} {}",
        choice.reason(),
        if *choice == StepChoice::Feed { "the longest possible is" } else { "the flight is stable up to" },
        Dimension::Time.pretty(*limit)
    )]
    StepChosen {
        /// What limited the choice.
        choice: StepChoice,
        /// Longest stable step [s].
        limit: f64,
    },
    /// The tension at the end of a spinline was found by flights.
    #[error(
        "was found by flights: the mean tension at the root, {}, with a feed speed of {} that changed by {} \
        in the last round",
        Dimension::Force.pretty(*tension), Dimension::Velocity.pretty(*speed), Dimension::Ratio.pretty_to(*change, 2)
    )]
    TensionFlown {
        /// Mean tension at the root [N].
        tension: f64,
        /// Feed speed [m/s].
        speed: f64,
        /// Relative change of the speed in the last round [-].
        change: f64,
    },
    /// The tension at the end of a spinline has not been found by flights yet.
    #[error(
        "is found by flights when the case flies; until then, all that follows from it is that of a tension of 0 N"
    )]
    TensionUnflown,
    /// The air of a spinline comes from a CFD field, which gives no temperature.
    #[error(
        "takes the velocity of the air along the spinline from the field, and its temperature, {} \
        everywhere, from spinline.temperature",
        Dimension::Temperature.pretty(*temperature)
    )]
    AirOfField {
        /// Temperature of the air [K].
        temperature: f64,
    },
    /// A standard error is judged from few replicates.
    #[error(
        "is too few to trust a standard error, so the study often stops before its results are as exact as \
        asked; write 6 or more"
    )]
    FewReplicates,
    /// A key of a study's case that has no meaning at some of its points.
    #[error("is left out, because it needs {needed}")]
    Unneeded {
        /// What it needs.
        needed: &'static str,
    },
    /// A time step far below the one that the scheme needs.
    #[error(
        "is {} times shorter than the step that run.scheme = \"{scheme}\" needs ({}), so the run takes that much \
         longer; leave the key out, or override it with the value auto",
        Dimension::Ratio.pretty_to(*times, 2), Dimension::Time.pretty(*suggested)
    )]
    StepShort {
        /// A suitable step [s].
        suggested: f64,
        /// How many times longer that is [-].
        times: f64,
        /// Name of the scheme.
        scheme: &'static str,
    },
    /// An error tolerance although the time step is given.
    #[error("has no effect because run.time_step is given; remove one of the two")]
    ToleranceUnused,
    /// A time that is not a whole number of steps.
    #[error("is not a whole number of time steps: {} is used", Dimension::Time.pretty(*time))]
    TimeRounded {
        /// Time used [s].
        time: f64,
    },
    /// A diameter outside the range that the drag law was fitted to.
    #[error(
        "is outside {} to {}, the range of diameters that drag.across = \"{law}\" was fitted to; the drag across the \
         fibre is extrapolated. \"{instead}\" is valid for any diameter",
        Dimension::Length.pretty(*from), Dimension::Length.pretty(*to)
    )]
    OutsideFit {
        /// Name of the law.
        law: &'static str,
        /// Thinnest fitted [m].
        from: f64,
        /// Thickest fitted [m].
        to: f64,
        /// A law that is valid for other diameters.
        instead: &'static str,
    },
    /// Reynolds numbers above the range of the drag law.
    #[error(
        "gives Reynolds numbers across the fibre up to {}, and drag.across = \"{law}\" is valid up to {}; the drag \
         across the fibre is extrapolated. No other law covers so thick a fibre in so fast air",
        Dimension::Ratio.pretty_to(*reynolds, 3), Dimension::Ratio.pretty(*to)
    )]
    ReynoldsOutsideFit {
        /// Name of the law.
        law: &'static str,
        /// Largest to expect [-].
        reynolds: f64,
        /// Largest fitted [-].
        to: f64,
    },
    /// Reynolds numbers at which a drag law is far below the measured drag.
    #[error(
        "has Reynolds numbers of about {} across the fibre. There drag.across = \"{law}\" gives only {} \
        times the drag that was measured on fine fibres and cylinders; \"{instead}\" agrees with these \
        measurements",
        Dimension::Ratio.pretty_to(*reynolds, 2), Dimension::Ratio.pretty_to(*share, 2)
    )]
    DragTooLow {
        /// Name of the law.
        law: &'static str,
        /// Usual Reynolds number [-].
        reynolds: f64,
        /// Drag of this law divided by that of the other one [-].
        share: f64,
        /// A law that agrees with the measurements.
        instead: &'static str,
    },
    /// Elements longer than eddies.
    #[error(
        "is shorter than the elements ({}): each element only feels the eddy at its centre. Shorten \
        fibre.element_length so that every eddy acts on the fibre",
        Dimension::Length.pretty(*element_length)
    )]
    EddiesSkipped {
        /// Rest length of an element [m].
        element_length: f64,
    },
    /// Something about a CFD field or a velocity record that makes results doubtful.
    #[error("{0}")]
    File(Fault),
    /// What the reader of a velocity record mended or left out.
    #[error("{0}")]
    Repaired(Fault),
    /// A value that is most likely a slip.
    #[error("is outside the usual range, {least} to {greatest}; {}", slip(instead))]
    Unusual {
        /// Smallest usual value.
        least: String,
        /// Largest usual value.
        greatest: String,
        /// The same digits with other units that are within the range.
        instead: Vec<String>,
    },
    /// A value that comes from a file and is most likely a slip.
    #[error(
        "gives {key} = {value} along the fibre, which is outside the usual range, {least} to {greatest}; \
        check the units in the file"
    )]
    UnusualInFile {
        /// What it gives.
        key: &'static str,
        /// Its value along the fibre.
        value: String,
        /// Smallest usual value.
        least: String,
        /// Largest usual value.
        greatest: String,
    },
    /// Air that is too fast for a model with air of constant density.
    #[error(
        "makes the air as fast as {}, which is Mach {}: the model's air has a constant density, as air has \
        up to about Mach {SLOW}{}",
        Dimension::Velocity.pretty_to(*speed, 3), Dimension::Ratio.pretty_to(*mach, 2), advice
    )]
    Fast {
        /// Largest mean velocity along the fibre [m/s].
        speed: f64,
        /// The same over the speed of sound [-].
        mach: f64,
        /// What to do if the velocities have another unit; it continues the sentence.
        advice: &'static str,
    },
    /// A profile much longer than the way of the fibre.
    #[error(
        "is {} long, while the fibre is {} long, so that it feels the first rows only; check the unit of the distances",
        Dimension::Length.pretty_to(*profile, 3), Dimension::Length.pretty_to(*fibre, 3)
    )]
    ProfileSize {
        /// Length of the profile [m].
        profile: f64,
        /// Length of the fibre [m].
        fibre: f64,
    },
    /// Turbulence of a file that is stronger than the mean flow.
    #[error(
        "makes the rms of the fluctuation {} times the mean velocity along the fibre; {advice}",
        Dimension::Ratio.pretty_to(*intensity, 2)
    )]
    IntensityOfFile {
        /// Rms over mean velocity [-].
        intensity: f64,
        /// What to look at.
        advice: &'static str,
    },
    /// Places where a field has turbulence that does not decay.
    #[error(
        "has k above zero and ε = 0 at {places} of {sampled} places along the fibre; the eddies there are \
        taken to be as large as the field. Write ε or ω for every point"
    )]
    NoDissipation {
        /// How many places.
        places: usize,
        /// How many were looked at.
        sampled: usize,
    },
    /// A field with `k` and `ε` but no turbulence along the fibre.
    #[error(
        "has k = 0 everywhere along the fibre, so the air there is not turbulent; check that the file has \
        the k of the solution"
    )]
    NoTurbulence,
    /// A turbulence intensity above one.
    #[error(
        "means that the rms of the fluctuation is {} times the mean velocity; if {} % was meant, write \"{} %\"",
        Dimension::Ratio.pretty(*value), Dimension::Ratio.pretty(*value), Dimension::Ratio.pretty(*value)
    )]
    IntensityAboveOne {
        /// The turbulence intensity [-].
        value: f64,
    },
    /// Eddies much longer than the fibre.
    #[error(
        "is {} times fibre.length, so that the same fluctuation acts on the whole fibre; check the unit",
        Dimension::Ratio.pretty_to(*times, 2)
    )]
    EddiesLong {
        /// Length of the eddies over that of the fibre [-].
        times: f64,
    },
    /// A cut-off that removes most of von Kármán's spectrum.
    #[error(
        "is below velocity / length scale = {}, so that most of the energy of von Kármán's spectrum would lie above \
         it and is moved below; choose a cut-off several times higher",
        Dimension::Frequency.pretty(*passing)
    )]
    CutoffLow {
        /// Mean velocity over length scale [Hz].
        passing: f64,
    },
    /// A fibre that reaches out of the region where the air is known.
    #[error(
        "reaches out of the region where the flow is known; outside it, the air at the nearest known point is used"
    )]
    LeavesFlow,
    /// A web in air that slows and does not widen.
    #[error(
        "lays filaments that have flown in air that slows from {} to {} and does not widen. A channel in \
        which air slows widens, and carries the filaments apart along the machine direction, so that the web \
        is more even; write widening = \"md\" in [air] of the case, or \"none\" if it is meant",
        Dimension::Velocity.pretty_to(*from, 3), Dimension::Velocity.pretty_to(*to, 3)
    )]
    SlowsOnly {
        /// Mean velocity at the inlet [m/s].
        from: f64,
        /// Mean velocity at the belt [m/s].
        to: f64,
    },
    /// A root outside of the field.
    #[error(
        "is outside of the box around the field, {low} to {high}; the air at the nearest point of the field \
        is used there"
    )]
    RootOutside {
        /// Lowest coordinates of the box.
        low: String,
        /// Highest coordinates of the box.
        high: String,
    },
    /// Air that hardly flows along the fibre, or against it.
    #[error(
        "lets the air flow along the fibre with {} on average, although its speed is {}: {}; choose the \
        direction in which the air leaves the spinneret",
        Dimension::Velocity.pretty_to(*along, 3), Dimension::Velocity.pretty_to(*speed, 3),
        if *along < 0.0 { "it blows from the end to the root" } else { "it blows across" }
    )]
    NotAlong {
        /// Mean velocity along the fibre [m/s].
        along: f64,
        /// Mean speed [m/s].
        speed: f64,
    },
    /// The case gives no machine direction in a field.
    #[error(
        "is used: the cross direction (CD) is {cross} of the field, {}",
        if *plane { "along which its air is the same" } else { "a choice of the program, because its air is the \
            same along none of its axes, or along two; write the key if the belt runs otherwise" }
    )]
    MachineDirectionChosen {
        /// Name of the axis along the cross direction.
        cross: &'static str,
        /// Whether the air is the same along it.
        plane: bool,
    },
    /// A field whose machine and cross direction look swapped.
    #[error(
        "makes the air the same along the machine direction, and lets it change along the cross direction ({cross} of \
        the field), as if the two were swapped: the air of a slot is the same across. Write \"{cross}\", or leave \
        the key out"
    )]
    EvenAlongBelt {
        /// Name of the axis along the cross direction.
        cross: &'static str,
    },
    /// A web whose air changes over its width.
    #[error(
        "lets the air change by {} % of its mean speed along the cross direction ({cross} of the field), over the {} of \
        the web around the root; a web is laid as if its air were the same across. If {cross} is the machine \
        direction, write it here; otherwise choose root and width where the air is even, or make a plane flow of the \
        middle",
        Dimension::Ratio.pretty_to(100.0 * *share, 2), Dimension::Length.pretty_to(*width, 3)
    )]
    ChangesAcross {
        /// Name of the axis along the cross direction.
        cross: &'static str,
        /// Width of the web [m].
        width: f64,
        /// Largest change over the mean speed [-].
        share: f64,
    },
    /// A field much larger or smaller than the fibre.
    #[error(
        "makes the field {} long, while the fibre is {} long; check that this is the unit of the mesh",
        Dimension::Length.pretty_to(*field, 3), Dimension::Length.pretty(*fibre)
    )]
    FieldSize {
        /// Longest side of the box around the field [m].
        field: f64,
        /// Length of the fibre [m].
        fibre: f64,
    },
    /// The field of charged filaments is near to that in which air breaks down.
    #[error(
        "gives a field of some {} at the edge of the curtain: air breaks down at {}, and at edges of metal long \
         before, which takes the charge away",
        Dimension::ElectricField.pretty_to(*field, 2), Dimension::ElectricField.pretty(BREAKDOWN)
    )]
    StrongField {
        /// The field [V/m].
        field: f64,
    },
    /// A number that no spunbond line is known to have.
    #[error("is doubtful: a {words} of {told}, where spunbond lines have {range}; {advice}")]
    Implausible {
        /// What the number is called.
        words: &'static str,
        /// The number with its unit.
        told: String,
        /// The range of spunbond lines.
        range: String,
        /// What may be wrong.
        advice: &'static str,
    },
    /// A key of a web in place of a number of its case, which has another.
    #[error("is laid with {of_case} = {used} in place of the {own} of {case}")]
    CaseChanged {
        /// The key of the case.
        of_case: &'static str,
        /// Its value for the web.
        used: String,
        /// Its own value.
        own: String,
        /// Path of the case.
        case: String,
    },
    /// Elements that are shorter than the diameter.
    #[error("is larger than the element length, {}; use longer elements", Dimension::Length.pretty(*element_length))]
    ElementsStubby {
        /// Rest length of an element [m].
        element_length: f64,
    },
}

/// A warning becomes a problem where something else is wrong with the case, because it may be the cause.
impl From<Note> for Problem {
    fn from(Note { place, key, value, what }: Note) -> Self {
        Self { place, key, value, what: Fault::plain(what.to_string()) }
    }
}

impl Note {
    /// The notes that go with results. A step that was chosen is not among them: it is no flaw, and the case with every
    /// default written out says it.
    pub fn notes_of_results(notes: &[Self]) -> Vec<String> {
        notes.iter().filter(|note| note.is_of_results()).map(Self::to_string).collect()
    }

    pub(crate) const fn is_of_results(&self) -> bool {
        !matches!(
            self.what,
            Remark::StepChosen { .. } | Remark::TensionFlown { .. } | Remark::MachineDirectionChosen { .. }
        )
    }
}

/// Mach number up to which the density of air changes by less than 5 % [-].
pub(super) const SLOW: f64 = 0.3;

/// What to do about a value that is most likely a slip.
fn slip(instead: &[String]) -> String {
    match instead {
        [] => "check the value and its unit".to_owned(),
        [one] => format!("did you mean {one}?"),
        [more @ .., last] => format!("did you mean {} or {last}?", more.join(", ")),
    }
}

impl Remark {
    /// Whether the value is most likely a slip, which can be the cause of anything else that is wrong with a case.
    pub(super) const fn is_of_a_slip(&self) -> bool {
        matches!(
            self,
            Self::Unusual { .. }
                | Self::UnusualInFile { .. }
                | Self::Fast { .. }
                | Self::IntensityOfFile { .. }
                | Self::NoDissipation { .. }
                | Self::ProfileSize { .. }
                | Self::IntensityAboveOne { .. }
                | Self::EddiesLong { .. }
                | Self::FieldSize { .. }
        )
    }

    /// The same, said of one file of several.
    pub(crate) fn of_file(self, file: &str) -> Self {
        let named = |fault: Fault| Fault { message: format!("{file}: {}", fault.message).into(), ..fault };
        match self {
            Self::File(fault) => Self::File(named(fault)),
            Self::Repaired(fault) => Self::Repaired(named(fault)),
            other => other,
        }
    }

    /// Whether this is a warning: the results may mislead. Otherwise it is a note, for example on rounding.
    pub const fn is_warning(&self) -> bool {
        self.is_of_a_slip()
            || matches!(
                self,
                Self::OutsideFit { .. }
                    | Self::ReynoldsOutsideFit { .. }
                    | Self::DragTooLow { .. }
                    | Self::EddiesSkipped { .. }
                    | Self::NoTurbulence
                    | Self::CutoffLow { .. }
                    | Self::File(_)
                    | Self::LeavesFlow
                    | Self::Implausible { .. }
                    | Self::SlowsOnly { .. }
                    | Self::RootOutside { .. }
                    | Self::NotAlong { .. }
                    | Self::EvenAlongBelt { .. }
                    | Self::ChangesAcross { .. }
                    | Self::FewReplicates
                    | Self::ElementsStubby { .. }
            )
    }
}
