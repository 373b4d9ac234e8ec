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
    /// A standard error is judged from few replicates.
    #[error(
        "is too few to trust a standard error, so the study often stops before its results are as exact as asked; write 6 \
         or more"
    )]
    FewReplicates,
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
                | Self::FewReplicates
                | Self::ElementsStubby { .. }
        )
    }
}
