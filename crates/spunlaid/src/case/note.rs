//! Remarks on a case that can be run all the same.

use super::StepChoice;
use crate::error::Finding;
use crate::field::FieldWarning;
use crate::units::Dimension;

/// A remark on a case that can be run all the same.
pub type Note = Finding<Remark>;

/// What there is to say about a value of a case; reads on after `key = value `.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Remark {
    /// The fibre is not a whole number of elements long.
    #[error(
        "leaves no whole number of elements: {elements} of {} {}",
        Dimension::Length.pretty(*element_length), if *elements == 1 { "is taken" } else { "are taken" }
    )]
    ElementsRounded {
        /// Number of elements taken.
        elements: usize,
        /// Their rest length [m].
        element_length: f64,
    },
    /// The run is not a whole number of steps long.
    #[error(
        "leaves no whole number of steps in run.duration: {steps} of {} {}",
        Dimension::Time.pretty_to(*time_step, 8), if *steps == 1 { "is taken" } else { "are taken" }
    )]
    StepShortened {
        /// Number of steps taken.
        steps: u64,
        /// Their length [s].
        time_step: f64,
    },
    /// A step that the case leaves open.
    #[error(
        "is taken, {}; stable up to {}",
        choice.reason(), Dimension::Time.pretty(*limit)
    )]
    StepChosen {
        /// What it was chosen by.
        choice: StepChoice,
        /// Longest stable step [s].
        limit: f64,
    },
    /// A tolerance without a step to choose.
    #[error("has no effect, since run.time_step is given; strike out one of the two")]
    ToleranceUnused,
    /// A time that is not a whole number of steps.
    #[error("is no whole number of time steps: {} is taken", Dimension::Time.pretty(*time))]
    TimeRounded {
        /// Time taken [s].
        time: f64,
    },
    /// A diameter that the drag law was not fitted for.
    #[error(
        "is outside {} to {}, the diameters drag.across = \"{law}\" was fitted for; the drag across the fibre is extrapolated, \
         \"{instead}\" is for any diameter",
        Dimension::Length.pretty(*from), Dimension::Length.pretty(*to)
    )]
    OutsideFit {
        /// Name of the law.
        law: &'static str,
        /// Thinnest fitted [m].
        from: f64,
        /// Thickest fitted [m].
        to: f64,
        /// A law for other diameters.
        instead: &'static str,
    },
    /// Reynolds numbers that the drag law is not for.
    #[error(
        "lets the air pass across the fibre at Reynolds numbers up to {}, beyond {}, where drag.across = \"{law}\" ends; \
         the drag across the fibre is extrapolated, no law here is for so thick a fibre in so fast air",
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
    /// Elements longer than eddies.
    #[error(
        "is shorter than the elements, {}: an element feels only the eddy at its centre; shorten fibre.element_length to feel all",
        Dimension::Length.pretty(*element_length)
    )]
    EddiesSkipped {
        /// Rest length of an element [m].
        element_length: f64,
    },
    /// Something about a CFD field.
    #[error("{0}")]
    Field(FieldWarning),
    /// A fibre longer than the air is known along it.
    #[error(
        "reaches from the root beyond what the flow of the case knows; out there the air of the nearest known place is taken"
    )]
    LeavesFlow,
    /// A root outside of the field.
    #[error(
        "is outside of the box around the field, {low} to {high}; the air of the nearest place of the field is taken there"
    )]
    RootOutside {
        /// Lowest coordinates of the box.
        low: String,
        /// Highest coordinates of the box.
        high: String,
    },
    /// Air that hardly flows along the fibre, or against it.
    #[error(
        "lets the air flow along the fibre with {} on average, where its speed is {}: {}; choose the direction in which the air leaves the spinneret",
        Dimension::Velocity.pretty_to(*along, 3), Dimension::Velocity.pretty_to(*speed, 3),
        if *along < 0.0 { "it blows from the end to the root" } else { "it blows across" }
    )]
    NotAlong {
        /// Mean velocity along the fibre [m/s].
        along: f64,
        /// Mean speed [m/s].
        speed: f64,
    },
    /// A field much larger or smaller than the fibre.
    #[error(
        "makes the field {} long, where the fibre is {}; is it the unit in which the mesh was drawn?",
        Dimension::Length.pretty_to(*field, 3), Dimension::Length.pretty(*fibre)
    )]
    FieldSize {
        /// Longest side of the box around the field [m].
        field: f64,
        /// Length of the fibre [m].
        fibre: f64,
    },
    /// Elements shorter than the fibre is thick.
    #[error("is longer than the elements, {}: the chain is finer than the fibre is thick", Dimension::Length.pretty(*element_length))]
    ElementsStubby {
        /// Rest length of an element [m].
        element_length: f64,
    },
}

impl Remark {
    /// Whether the results may mislead, rather than the input merely having been rounded.
    pub const fn is_warning(&self) -> bool {
        matches!(
            self,
            Self::OutsideFit { .. }
                | Self::ReynoldsOutsideFit { .. }
                | Self::EddiesSkipped { .. }
                | Self::Field(_)
                | Self::LeavesFlow
                | Self::RootOutside { .. }
                | Self::NotAlong { .. }
                | Self::FieldSize { .. }
                | Self::ElementsStubby { .. }
        )
    }
}
