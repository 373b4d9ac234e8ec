//! From a scanned web back to the settings of the line: which values of some keys make webs that are as
//! uneven as the scan?
//!
//! ```text
//! scan ─ map, patches ────→ Target: logarithms of CV over patches, and of the spectrum
//! values of the keys → webs, laid with the same random numbers in every trial → the same numbers of the same window
//!   → misfit, weighted by how the numbers scatter from web to web → steps of Gauss and Newton → Fit
//! ```
//!
//! **The misfit** (theory.md (100)) is `rᵀ C⁻¹ r`, with the differences r between the logarithms of the scan
//! and the mean of those of n simulated webs, and the covariance C of these logarithms from web to web, of
//! which a tenth is taken away beside the diagonal.
//!
//! **The values** come from polynomials of second order through all trials within a standard error of the best one.
//!
//! **The intervals** come from the webs themselves: each simulated web takes the place of the scan, and the
//! values that would be found for it scatter as those for a real scan do (simulated method of moments: D.
//! McFadden, Econometrica 57 (1989) 995–1026; C. Gouriéroux, A. Monfort, E. Renault, Journal of Applied
//! Econometrics 8 (1993) S85–S118). An interval holds the values of which the scan may well be a web, by webs
//! that are laid at its ends. Errors of the camera, of the few simulated fibres and of the surrogate are added.
//!
//! **Whether such webs can look like the scan** is said by the misfit itself: that of the scan stands among
//! those that the simulated webs have when each is taken as the scan.

mod interval;
mod parameter;
mod polynomials;
mod results;
mod search;
mod simulator;
mod surface;
mod target;
#[cfg(test)]
mod tests;
mod texture;
mod values;
mod webs;
mod weights;

pub use interval::IntervalEnd;
pub use parameter::Parameter;
pub use parameter::USUAL_FACTOR;
pub use results::{Fit, FitTrial, FittedKey, FittedNumber, InseparableKeys, KeyWarning};
pub(crate) use simulator::MakeWeb;
pub use target::{MeasuredPatch, MeasuredWeb, Target};
pub use texture::Texture;
pub use webs::{MOST_TRIALS, WebInProgress};

use crate::study::{Experiment, Journal};
use spunlaid_ground::{Error, Fault, RunContext};
use spunlaid_simulation::{Flyer, WebSpec};

use simulator::{Simulator, WebSimulator};
use webs::Webs;

/// Most keys that are sought at a time.
pub(crate) const MOST_KEYS: usize = 4;
/// Fewest simulated webs of a trial.
pub const FEWEST_WEBS: u64 = 8;
/// Usual number of simulated webs of a trial: so many as are needed to say with 95 % confidence that no such
/// web looks like the scan.
pub const USUAL_WEBS: u64 = 20;

/// Most searches after the first one.
const ROUNDS: usize = 3;
/// Values that are further from the place where a search has ended are sought again from there [standard errors].
const FAR: f64 = 0.9;

/// What is sought, and in what.
#[derive(Clone, Copy)]
pub struct Question<'a> {
    /// The keys.
    pub parameters: &'a [Parameter],
    /// What the webs shall be like.
    pub target: &'a Target,
    /// Makes the web of some values of the keys [SI].
    pub make: MakeWeb<'a>,
    /// Simulated webs of each trial.
    pub webs: u64,
}

impl std::fmt::Debug for Question<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Question")
            .field("parameters", &self.parameters)
            .field("webs", &self.webs)
            .finish_non_exhaustive()
    }
}

/// A checksum over everything on which the records of a fit depend.
///
/// * `start` – the web before anything is sought
pub fn identity(start: &WebSpec, parameters: &[Parameter], target: &Target, webs: u64) -> u32 {
    let mut sum = crc32fast::Hasher::new();
    sum.update(&Experiment::from(start.clone()).checksum().to_le_bytes());
    sum.update(&target.checksum().to_le_bytes());
    sum.update(&webs.to_le_bytes());
    for Parameter { key, start, range, .. } in parameters {
        sum.update(key.name.as_bytes());
        [*start, range[0], range[1]].iter().for_each(|number| sum.update(&number.to_le_bytes()));
    }
    sum.finalize()
}

/// Finds the values of the keys whose webs are most like the target.
///
/// * `flyer` – flies the fibres of each trial
/// * `journal` – webs that are in it are not laid again
/// * `watch` – is reported of every web that is laid
///
/// # Errors
/// If there are too many keys, too few webs or too few numbers; if the webs of the start cannot be laid; if
/// it is stopped.
pub fn fit<'a>(
    question: Question<'a>,
    flyer: Flyer<'a>,
    by: RunContext<'a>,
    journal: &'a mut Journal,
    watch: &'a dyn Fn(WebInProgress<'_>),
) -> Result<Fit, Error> {
    check(question)?;
    let Question { parameters, target, make, webs: count } = question;
    let start: Vec<f64> = parameters.iter().map(|sought| sought.start).collect();
    let mut simulator = WebSimulator::new(make, target, flyer, by, &start)?;
    find(&mut Webs::new(parameters, target, &mut simulator, count, journal, watch))
}

/// How far the numbers of simulated webs are off at the start by causes other than chance: standard errors of
/// their logarithms by each cause, common to all numbers. These causes are the few filaments that are simulated
/// for all, and the surrogate.
///
/// # Errors
/// If the webs of the start cannot be laid; if it is stopped.
pub fn errors_of_model(
    question: Question<'_>,
    flyer: Flyer<'_>,
    by: RunContext<'_>,
) -> Result<Vec<Vec<f64>>, Error> {
    let start: Vec<f64> = question.parameters.iter().map(|sought| sought.start).collect();
    WebSimulator::new(question.make, question.target, flyer, by, &start)?.errors_of_model()
}

/// Searches until the values are near the place where the search has ended.
fn find(webs: &mut Webs<'_>) -> Result<Fit, Error> {
    let start: Vec<f64> = webs.parameters.iter().map(|sought| sought.coordinate(sought.start)).collect();
    let Some(mut start) = webs.trial(&start)? else {
        return Err(webs.refusal(&start).unwrap_or(Error::Interrupted));
    };
    // The scatter at the start gives the direction, that at the first end the scale of a misfit.
    let weights = search::weights_at(webs, start)?;
    start = search::search(webs, start, weights)?.trial;
    let mut rounds = 0;
    loop {
        rounds += 1;
        let weights = search::weights_at(webs, start)?;
        let place = search::search(webs, start, weights)?;
        webs.simulator.set(&webs.trials[place.trial].values)?;
        let others = webs.simulator.errors_of_model()?;
        let values = values::values(webs, &place, &others)?;
        // Far from the trials, straight lines do not hold.
        let next = if values.far > FAR && rounds < ROUNDS { webs.trial(&values.coordinates)? } else { None };
        match next {
            Some(next) if next != start => start = next,
            _ => {
                let ends = interval::ends(webs, &place, &values, &others)?;
                return Ok(results::collect_results(webs, &place, values, &ends, &others));
            }
        }
    }
}

fn check(question: Question<'_>) -> Result<(), Fault> {
    let (keys, numbers) = (question.parameters.len(), question.target.textures().len());
    if keys == 0 || keys > MOST_KEYS {
        let message = format!("{keys} keys are sought, and a fit finds 1 to {MOST_KEYS}");
        return Err(Fault::new(message, "name the keys that you know least"));
    }
    if question.webs < FEWEST_WEBS {
        let message =
            format!("{} webs are too few for a difference that is significant at 95 %", question.webs);
        return Err(Fault::new(message, format!("ask for {FEWEST_WEBS} or more")));
    }
    if numbers < keys {
        let message = format!("{keys} keys cannot be found from {numbers} patches");
        return Err(Fault::new(message, "name fewer keys, or analyse the scan with more patches"));
    }
    Ok(())
}
