//! What somebody claims of a study, judged by its results.

use super::effects::Ranking;
use super::journal::Journal;
use super::{PointResults, Quantity, Study};
use crate::claim::{CHANCE, Claim, REAL, Verdict, goes, significance};
use spunlaid_ground::{Difference, Error};
use std::borrow::Cow;

/// A claim about a result of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyClaim {
    /// In a sentence.
    pub sentence: String,
    /// As it is written in the file, `sigma_md: fibre.linear_density > 5 * fibre.density`.
    pub text: String,
    /// The name of the result.
    pub result: String,
    /// What is claimed of it.
    pub statement: Statement,
}

/// What is claimed of a result. Factors are named by their indices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Statement {
    /// A factor moves it by more than so many times what another one does, over their ranges.
    Matters {
        /// The factor that is said to matter more.
        more: usize,
        /// How many times as much.
        times: f64,
        /// The factor that is said to matter less.
        less: usize,
    },
    /// It follows a factor with this trend, while the other factors are as at the first point.
    Follows(usize, Trend),
}

named! {
    /// How a result follows a factor.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Trend {
        /// It rises from the least to the greatest value.
        Rises = "rises",
        /// It falls.
        Falls = "falls",
        /// It has its greatest or its least value between the ends.
        Turns = "turns",
    }
}

/// Judges the claims of a study.
///
/// A factor matters more if its effect is larger than so many times that of the other one by more than three
/// standard errors. A result rises or falls if its ends differ by more than three standard errors, and no step
/// between two values goes the other way by more than 2.5. It turns if the greatest or the least value between
/// the ends differs from both ends by more than three. Results in which nothing is by chance have no errors, and every
/// difference counts.
///
/// # Errors
/// When the journal cannot be read.
pub fn judge(
    study: &Study,
    results: &[PointResults],
    rankings: &[Ranking],
    journal: &mut Journal,
) -> Result<Vec<Claim>, Error> {
    let mut judged = Vec::with_capacity(study.claims.len());
    for claim in &study.claims {
        let open = |why: &str| (why.to_owned(), Verdict::Open);
        let (evidence, verdict) = match (study.quantity(&claim.result), claim.statement) {
            (None, _) => open("no point has this result"),
            (Some(quantity), Statement::Matters { more, times, less }) => {
                let ranking = rankings.iter().find(|ranking| ranking.measure == quantity);
                let effect = |factor: usize| {
                    ranking?.effects.iter().find(|effect| effect.of.factor == factor).map(|of| of.difference)
                };
                match effect(more).zip(effect(less)) {
                    Some((more_effect, less_effect)) => {
                        let words = [(more, more_effect), (less, less_effect)].map(|(factor, effect)| {
                            let effect = in_words(&study.quantities[quantity], effect);
                            format!("{effect} over {}", study.factors[factor].key.name)
                        });
                        (words.join(", "), Verdict::of_difference(excess(more_effect, less_effect, times)))
                    }
                    None => open("these effects cannot be separated"),
                }
            }
            (Some(quantity), Statement::Follows(factor, trend)) => {
                let points = points_along(study, results, quantity, factor);
                if points.len() < 3 {
                    open("fewer than three points differ in this key alone")
                } else {
                    let differences = Differences { study, quantity, points: &points, results };
                    follows(&differences, factor, trend, journal)?
                }
            }
        };
        let sentence = Cow::Owned(claim.sentence.clone());
        judged.push(Claim { figure: "", claim: sentence, evidence, verdict });
    }
    Ok(judged)
}

/// By how much one effect is larger than so many times another one.
fn excess(more: Difference, less: Difference, times: f64) -> Difference {
    Difference {
        value: more.value.abs() - times * less.value.abs(),
        standard_error: more.standard_error.hypot(times * less.standard_error),
        degrees: f64::INFINITY,
    }
}

/// A difference in the unit of a quantity, and its standard error if it is known and there is one.
fn in_words(quantity: &Quantity, difference: Difference) -> String {
    let scale = quantity.unit.per_si;
    let (value, error) = (difference.value * scale, difference.standard_error * scale);
    let size = if error > 0.0 { error } else { 0.01 * value.abs() };
    let digits = if size > 0.0 { (1.0 - size.log10().floor()).clamp(0.0, 6.0) as usize } else { 0 };
    let error = if error > 0.0 { format!(" ± {error:.digits$}") } else { String::new() };
    let unit = quantity.unit.shown;
    let space = if unit.is_empty() { "" } else { " " };
    format!("{value:+.digits$}{error}{space}{unit}").replace('-', "−")
}

/// The points that differ from the first one in a factor alone, and the first one, by the values of the factor.
fn points_along(study: &Study, results: &[PointResults], quantity: usize, factor: usize) -> Vec<usize> {
    let values = |point: usize| &study.points[point].values[..study.factors.len()];
    let differs_alone = |point: &usize| {
        let mut others = values(*point).iter().zip(values(0)).enumerate().filter(|(i, _)| *i != factor);
        others.all(|(_, (here, first))| here.to_bits() == first.to_bits())
    };
    let is_known = |point: &usize| results[*point].mean(quantity).is_finite();
    let mut along: Vec<usize> = (0..results.len()).filter(differs_alone).filter(is_known).collect();
    along.sort_by(|a, b| values(*a)[factor].total_cmp(&values(*b)[factor]));
    along.dedup_by(|a, b| values(*a)[factor].to_bits() == values(*b)[factor].to_bits());
    along
}

/// Differences of a result between points.
struct Differences<'a> {
    study: &'a Study,
    quantity: usize,
    points: &'a [usize],
    results: &'a [PointResults],
}

impl Differences<'_> {
    /// From one of the points to another one: replicate by replicate where these share their turbulence.
    fn between(&self, from: usize, to: usize, journal: &mut Journal) -> Result<Difference, Error> {
        let [from, to] = [from, to].map(|i| self.points[i]);
        let known = |point: usize| {
            let results = &self.results[point];
            (results.mean(self.quantity), results.error(self.quantity))
        };
        let ((before, error_before), (after, error_after)) = (known(from), known(to));
        if [from, to].iter().all(|point| self.study.points[*point].experiment.is_exact()) {
            return Ok(Difference::exact(after - before));
        }
        let apart = Difference {
            value: after - before,
            standard_error: error_before.hypot(error_after),
            degrees: f64::INFINITY,
        };
        if !self.study.common_phases {
            return Ok(apart);
        }
        let mut values = |point: usize| -> Result<Vec<f64>, Error> {
            let mut values = Vec::new();
            for record in journal.records(point, u64::MAX)? {
                let place = record.replicate as usize;
                values.resize(values.len().max(place + 1), f64::NAN);
                values[place] =
                    record.outcome.measured().map_or(f64::NAN, |measured| measured[self.quantity]);
            }
            Ok(values)
        };
        Ok(Difference::paired(&values(from)?, &values(to)?).unwrap_or(apart))
    }
}

fn follows(
    of: &Differences<'_>,
    factor: usize,
    trend: Trend,
    journal: &mut Journal,
) -> Result<(String, Verdict), Error> {
    let (last, quantity) = (of.points.len() - 1, &of.study.quantities[of.quantity]);
    let place = |i: usize| of.study.factors[factor].key.pretty(of.study.points[of.points[i]].values[factor]);
    let ends = of.between(0, last, journal)?;
    let steps = (0..last).map(|i| of.between(i, i + 1, journal)).collect::<Result<Vec<_>, _>>()?;
    let reported = format!("{} from {} to {}", in_words(quantity, ends), place(0), place(last));
    if trend != Trend::Turns {
        let direction = if trend == Trend::Rises { 1.0 } else { -1.0 };
        let (back, verdict) = goes(ends, &steps, direction);
        let evidence = match ends.standard_error {
            0.0 if back > CHANCE => format!("{reported}, without error; a step goes the other way"),
            0.0 => format!("{reported}, without error; no step goes the other way"),
            error if error.is_nan() => format!("{reported}; the error of a single replicate is not known"),
            _ => format!("{reported}; largest step in the other direction {back:.1} standard errors"),
        };
        return Ok((evidence, verdict));
    }
    let mean = |i: usize| of.results[of.points[i]].mean(of.quantity);
    let between = || 1..last;
    let greatest = between().max_by(|a, b| mean(*a).total_cmp(&mean(*b)));
    let least = between().min_by(|a, b| mean(*a).total_cmp(&mean(*b)));
    // The turn that stands out most, from the end that is nearer to it.
    let (mut most, mut at) = (f64::NEG_INFINITY, None);
    for (turn, direction) in greatest.map(|i| (i, 1.0)).into_iter().chain(least.map(|i| (i, -1.0))) {
        let ends = [of.between(0, turn, journal)?, of.between(last, turn, journal)?];
        let [before, after] = ends.map(|end| direction * significance(end));
        if at.is_none() || before.min(after) > most {
            (most, at) = (before.min(after), Some((turn, ends)));
        }
    }
    let Some((turn, turn_ends)) = at else { return Ok((reported, Verdict::Open)) };
    let [before, after] = turn_ends.map(|difference| in_words(quantity, difference));
    let evidence =
        format!("at {}: {before} relative to {}, {after} relative to {}", place(turn), place(0), place(last));
    let overall = significance(ends);
    let is_monotone = goes(ends, &steps, overall.signum()).0 <= CHANCE;
    let verdict = match most {
        most if most > REAL => Verdict::Holds,
        // Without error, the steps are as they are.
        _ if is_monotone && (overall.abs() > REAL || ends.standard_error == 0.0) => Verdict::Fails,
        _ => Verdict::Open,
    };
    Ok((evidence, verdict))
}
