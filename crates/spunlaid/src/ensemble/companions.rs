//! A replicate with its companions in the same air.

use super::{Job, Keep, RunControl, Trajectory, fly_each};
use crate::case::Case;
use crate::error::Error;
use crate::fibre::Place;
use crate::lanes::WIDTH;
use crate::observe::{Kind, Value};

/// Flies a replicate and its companions, as many beside it as a flight takes. In each further flight the
/// replicate flies again, with the same bits, and is compared with the others. It is lost if one of them is.
///
/// # Errors
/// As of [`fly_each`].
pub(super) fn fly_beside(
    case: &Case,
    replicate: u64,
    keep: Keep,
    computing: RunControl<'_>,
) -> Result<Result<Trajectory, Error>, Error> {
    let places: Vec<Place> = case.companions.places().collect();
    let mut whole: Option<Trajectory> = None;
    for some in places.chunks(WIDTH - 1) {
        let first = Job::new(case, replicate);
        let jobs: Vec<Job<'_>> =
            std::iter::once(first).chain(some.iter().map(|place| Job { place: *place, ..first })).collect();
        let (keep, computing) = match whole {
            None => (keep, computing),
            Some(_) => (Keep::CURVES, RunControl { recorder: None, ..computing }),
        };
        let flown: Result<Vec<Trajectory>, Error> = fly_each(&jobs, keep, computing)?.into_iter().collect();
        let flown = match flown {
            Ok(flown) => flown.into_iter().next().ok_or_else(Error::no_fibre)?,
            Err(lost) => return Ok(Err(lost)),
        };
        match &mut whole {
            None => whole = Some(flown),
            Some(whole) => complete(whole, flown),
        }
    }
    Ok(whole.ok_or_else(Error::no_fibre))
}

/// Adds the companions of a further flight to the measures of a replicate.
fn complete(whole: &mut Trajectory, further: Trajectory) {
    for ((measure, value), (_, more)) in whole.values.iter_mut().zip(further.values) {
        if let (Kind::Neighbour, Value::Curve(_, values), Value::Curve(_, more)) = (measure.kind, value, more)
        {
            values
                .iter_mut()
                .zip(more)
                .filter(|(value, _)| value.is_nan())
                .for_each(|(value, more)| *value = more);
        }
    }
}
