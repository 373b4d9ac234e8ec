//! What matters? A base, changes of it, the base and what each change makes of it measured in pairs, and the
//! differences with their errors.
//!
//! ```text
//! keys of the table → changes (a key from one value to another) → both measured in the same chance
//!   → effects → the best ones once more
//! ```
//!
//! How a pair is measured is up to whoever asks: webs fly in the same air or lie on the paths of the same
//! fibres (`advice`), a spinline is solved
//! again (`input`), and a study fits lines to the replicates of its points.

use crate::error::Error;
use crate::statistics::Difference;
use crate::units::Dimension;

/// What is changed, as it is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Name in results: `air_speed`.
    pub name: &'static str,
    /// In words that stand behind “less” or “more”: `throughput per hole`.
    pub words: &'static str,
    /// When it can be turned.
    pub turned: Turned,
}

named! {
    /// When a setting of a machine can be turned.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Turned {
        /// While the machine runs.
        Running = "running",
        /// When the machine stands still.
        Stopped = "stopped",
        /// Only by building another machine.
        Rebuilt = "rebuilt",
    }
}

/// A key with its value before and after a change [SI].
#[derive(Clone, Debug, PartialEq)]
pub struct ChangedKey {
    /// Its name, as it is set: `layer.2.line.throughput`.
    pub key: String,
    /// Physical dimension of its values.
    pub dimension: Dimension,
    /// Whether its values are whole numbers.
    pub whole: bool,
    /// Whether it is changed by a number of kelvins: a temperature has no share of its value.
    pub by_kelvin: bool,
    /// The value before.
    pub from: f64,
    /// The value after.
    pub to: f64,
}

impl ChangedKey {
    /// A value for people, with its unit.
    pub fn pretty(&self, value: f64) -> String {
        if self.whole { format!("{value:.0}") } else { self.dimension.pretty(value) }
    }
}

/// A change of the base.
#[derive(Clone, Debug, PartialEq)]
pub struct Change<E> {
    /// What is changed.
    pub setting: Setting,
    /// Numbers of the layers in which it is changed, from 1: of one, or of equal ones together; none where it
    /// is changed in all.
    pub layers: Vec<usize>,
    /// The keys that differ.
    pub keys: Vec<ChangedKey>,
    /// What it makes of the base; where it cannot be made, the base.
    pub experiment: E,
    /// Why it cannot be made.
    pub refusal: Option<String>,
}

/// What a change does to a measure. A change has a list of them for its measures, and a measure one for the changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effect<M> {
    /// The measure of the list, or the change.
    pub of: M,
    /// What becomes of the measure: the difference, or that of its logarithm.
    pub difference: Difference,
    /// The part of the change of a CV that filaments make each for itself, to first order; the rest is that
    /// of the clouds which they make together. None where it is not known.
    pub own: Option<f64>,
    /// Correlation of the CV of the blocks of the two webs, if they hang in the same air: one where
    /// they have the same clouds, zero where they have other ones and the error is that of two webs by
    /// themselves.
    pub in_common: Option<f64>,
}

impl<M> Effect<M> {
    /// An effect of which only the difference is known.
    pub const fn new(of: M, difference: Difference) -> Self {
        Self { of, difference, own: None, in_common: None }
    }

    /// Whether the change is one of the clouds, and not of what each filament does for itself; None where
    /// that is not known.
    pub fn is_of_clouds(&self) -> Option<bool> {
        self.own.map(|own| (self.difference.value - own).abs() >= own.abs())
    }
}

/// A change with what it does.
#[derive(Clone, Debug, PartialEq)]
pub struct SensitivityRun<E, M> {
    /// The change.
    pub change: Change<E>,
    /// What it does to each measure.
    pub effects: Vec<Effect<M>>,
    /// What it did where it was chosen, if `effects` come from another chance; none of any other change.
    pub at_first: Vec<Effect<M>>,
}

impl<E, M: PartialEq> SensitivityRun<E, M> {
    /// What it does to a measure.
    pub fn on(&self, measure: M) -> Option<&Effect<M>> {
        self.effects.iter().find(|effect| effect.of == measure)
    }
}

/// The effects of a change on all measures, or why it could not be tried.
pub type Outcome<M> = Result<Vec<Effect<M>>, String>;

/// What changes do to a base.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity<E, M> {
    /// The changes, each with what it does.
    pub tried: Vec<SensitivityRun<E, M>>,
    /// Whether the best changes were tried once more, in another chance. Only these are [`Sensitivity::improvements`]
    /// then.
    pub is_confirmed: bool,
    /// Changes that could not be tried, and why.
    pub failed: Vec<(Change<E>, String)>,
    /// The measure by which they are judged; None if none is known.
    pub judged_by: Option<M>,
}

/// Least change of a measure that is an improvement, as a share of it.
const LEAST: f64 = 0.01;
/// Largest number of settings that are named.
pub const NAMED: usize = 2;
/// Most changes that are tried once more, where changes are confirmed.
pub const RACING: usize = 3;
/// How many standard errors a change may lie behind the best ones and still be tried once more.
const BEHIND: f64 = 2.0;

impl<E: Clone, M: Copy + PartialEq> Sensitivity<E, M> {
    /// Tries changes.
    ///
    /// * `measure` – measures the base and what these changes make of it in pairs
    ///
    /// # Errors
    /// Those of measuring.
    pub fn new(
        changes: Vec<Change<E>>,
        measure: impl FnOnce(&[Change<E>]) -> Result<Vec<Outcome<M>>, Error>,
    ) -> Result<Self, Error> {
        let (refused, changes): (Vec<_>, Vec<_>) =
            changes.into_iter().partition(|change| change.refusal.is_some());
        let failed =
            refused.into_iter().filter_map(|change| Some((change.clone(), change.refusal?))).collect();
        let mut trials = Self { tried: Vec::new(), is_confirmed: false, failed, judged_by: None };
        let outcomes = if changes.is_empty() { Vec::new() } else { measure(&changes)? };
        for (change, outcome) in changes.into_iter().zip(outcomes) {
            match outcome {
                Ok(effects) => trials.tried.push(SensitivityRun { change, effects, at_first: Vec::new() }),
                Err(why) => trials.failed.push((change, why)),
            }
        }
        Ok(trials)
    }

    /// Tries the changes once more that may be among the best, and takes what they do there. They were chosen
    /// for what they did in the first chance, which was kinder to them than to the others.
    ///                                                                  theory.md, "Two webs in the same air"
    ///
    /// # Errors
    /// Those of measuring.
    pub fn confirm(
        &mut self,
        measure: impl FnOnce(&[Change<E>]) -> Result<Vec<Outcome<M>>, Error>,
    ) -> Result<(), Error> {
        let racing = self.judged_by.map_or_else(Vec::new, |judged_by| self.racing(judged_by));
        let races = |tried: &SensitivityRun<E, M>| racing.iter().any(|racing| std::ptr::eq(*racing, tried));
        let best: Vec<usize> = (0..self.tried.len()).filter(|i| races(&self.tried[*i])).collect();
        let changes: Vec<Change<E>> = best.iter().map(|i| self.tried[*i].change.clone()).collect();
        self.is_confirmed = true;
        let outcomes = if changes.is_empty() { Vec::new() } else { measure(&changes)? };
        for (i, outcome) in best.into_iter().zip(outcomes) {
            if let Ok(effects) = outcome {
                let tried = &mut self.tried[i];
                tried.at_first = std::mem::replace(&mut tried.effects, effects);
            }
        }
        Ok(())
    }

    /// The changes that may be among those that lower a measure most, as far as is known of them: first those of the
    /// running machine.
    fn racing(&self, measure: M) -> Vec<&SensitivityRun<E, M>> {
        let (running, others): (Vec<_>, Vec<_>) = self
            .best(measure, |difference| difference.value < 0.0)
            .into_iter()
            .partition(|(tried, _)| tried.change.setting.turned == Turned::Running);
        let most = if others.is_empty() { RACING } else { NAMED };
        let mut racing = may_be_best(&running, most);
        let rest = RACING - racing.len();
        racing.extend(may_be_best(&others, rest));
        racing
    }

    /// The changes that lower a measure by at least one per cent of it and beyond chance: the best of each
    /// setting. Those of the running machine come first, and of these the best.
    pub fn improvements(&self, measure: M) -> Vec<(&SensitivityRun<E, M>, &Effect<M>)> {
        self.best(measure, |difference| difference.value <= -LEAST && difference.is_significant())
    }

    /// The best change of each setting among some, the best first.
    fn best(
        &self,
        measure: M,
        is_one: impl Fn(&Difference) -> bool,
    ) -> Vec<(&SensitivityRun<E, M>, &Effect<M>)> {
        let reported = self.tried.iter().filter(|tried| !(self.is_confirmed && tried.at_first.is_empty()));
        let some = reported.filter_map(|tried| Some((tried, tried.on(measure)?)));
        let mut improvements: Vec<_> = some.filter(|(_, effect)| is_one(&effect.difference)).collect();
        improvements.sort_by(|(_, one), (_, other)| one.difference.value.total_cmp(&other.difference.value));
        improvements.sort_by_key(|(tried, _)| tried.change.setting.turned);
        let mut settings = Vec::new();
        improvements.retain(|(tried, _)| {
            let setting = (tried.change.setting, tried.change.layers.clone());
            let is_new = !settings.contains(&setting);
            settings.push(setting);
            is_new
        });
        improvements
    }

    /// The least and the greatest value of a measure among all that were tried and the base, over that of the
    /// base. What is within chance does not count.
    pub fn range(&self, measure: M) -> [f64; 2] {
        let differences = self.tried.iter().filter_map(|tried| Some(tried.on(measure)?.difference));
        differences.filter(Difference::is_significant).fold([1.0, 1.0], |[least, most], difference| {
            let ratio = 1.0 + difference.value;
            [least.min(ratio), most.max(ratio)]
        })
    }
}

/// Of changes of which the best comes first, some that may be the best ones.
fn may_be_best<'a, E, M>(
    best: &[(&'a SensitivityRun<E, M>, &Effect<M>)],
    most: usize,
) -> Vec<&'a SensitivityRun<E, M>> {
    let Some((_, last)) = best.get(NAMED - 1).or(best.last()) else { return Vec::new() };
    let may_be_better = |(_, effect): &&(&SensitivityRun<E, M>, &Effect<M>)| {
        let [own, other] = [effect.difference, last.difference];
        own.value - other.value <= BEHIND * own.standard_error.hypot(other.standard_error)
    };
    best.iter().filter(may_be_better).take(most).map(|(tried, _)| *tried).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    const NAMES: [&str; 6] = ["depth", "holes", "air", "melt", "quench", "belt"];

    fn effect(value: f64) -> Effect<u8> {
        Effect::new(0, Difference { standard_error: 0.001, ..Difference::exact(value) })
    }

    fn change(number: usize, turned: Turned) -> Change<()> {
        let setting = Setting { name: NAMES[number], words: "", turned };
        Change { setting, layers: Vec::new(), keys: Vec::new(), experiment: (), refusal: None }
    }

    /// What is turned on the running line comes first and is tried once more, however much more another line would do.
    #[test]
    fn what_is_turned_while_the_line_runs_comes_first() {
        let turned = [Turned::Stopped, Turned::Rebuilt, Turned::Running, Turned::Running, Turned::Running];
        let effects = [-0.3, -0.4, -0.02, -0.05, 0.1];
        let changes = turned.into_iter().enumerate().map(|(number, turned)| change(number, turned)).collect();
        let mut trials =
            Sensitivity::new(changes, |_| Ok(effects.map(|value| Ok(vec![effect(value)])).to_vec())).unwrap();
        trials.judged_by = Some(0);
        let names = |trials: &Sensitivity<(), u8>| -> Vec<&str> {
            trials.improvements(0).iter().map(|(tried, _)| tried.change.setting.name).collect()
        };
        assert_eq!(names(&trials), ["melt", "air", "depth", "holes"]);
        let again = |changes: &[Change<()>]| {
            let again = changes.iter().map(|change| {
                let number = NAMES.iter().position(|name| *name == change.setting.name).unwrap();
                Ok(vec![effect(effects[number])])
            });
            Ok(again.collect())
        };
        trials.confirm(again).unwrap();
        assert_eq!(names(&trials), ["melt", "air", "holes"]);
        // What is not confirmed counts in the range too.
        assert!(trials.range(0).iter().zip([0.6, 1.1]).all(|(found, wanted)| (found - wanted).abs() < 1e-12));
    }

    /// Changes with these effects on measure 0.
    fn trials(changes: &[(Turned, f64)]) -> Sensitivity<(), u8> {
        let outcomes = changes.iter().map(|(_, value)| Ok(vec![effect(*value)])).collect();
        let changes =
            changes.iter().enumerate().map(|(number, (turned, _))| change(number, *turned)).collect();
        let trials = Sensitivity::new(changes, |_| Ok(outcomes)).unwrap();
        Sensitivity { judged_by: Some(0), ..trials }
    }

    /// Two of the running line and one other, or three of a kind, if all are as good as the second best.
    #[test]
    fn as_many_changes_are_tried_once_more_as_may_be_the_best() {
        let (running, rebuilt) = (Turned::Running, Turned::Rebuilt);
        let as_good = |turned: Turned, value: f64| [(turned, value); 3];
        for (changes, wanted) in [
            ([(running, -0.3), (running, -0.2), (running, -0.1)].to_vec(), &[0, 1][..]),
            (as_good(running, -0.3).to_vec(), &[0, 1, 2]),
            ([as_good(running, -0.3), as_good(rebuilt, -0.5)].concat(), &[0, 1, 3]),
            ([vec![(running, -0.05)], as_good(rebuilt, -0.3).to_vec()].concat(), &[0, 1, 2]),
            // No change for the better.
            (vec![(running, 0.0), (rebuilt, 0.1)], &[]),
        ] {
            let mut again = Vec::new();
            let measure = |changes: &[Change<()>]| {
                again.extend(changes.iter().map(|change| change.setting.name));
                Ok(changes.iter().map(|_| Ok(vec![effect(-0.3)])).collect())
            };
            trials(&changes).confirm(measure).unwrap();
            assert_eq!(again, wanted.iter().map(|number| NAMES[*number]).collect::<Vec<_>>(), "{changes:?}");
        }
    }

    #[test]
    fn less_than_one_per_cent_or_within_the_error_is_no_improvement_and_widens_no_range() {
        let mut trials =
            trials(&[(Turned::Running, -0.009), (Turned::Running, 0.009), (Turned::Running, -0.5)]);
        trials.tried[2].effects[0].difference.standard_error = 1.0;
        assert_eq!(trials.improvements(0), []);
        assert!(
            trials.range(0).iter().zip([0.991, 1.009]).all(|(found, wanted)| (found - wanted).abs() < 1e-12)
        );
    }

    #[test]
    fn a_change_is_one_of_clouds_if_most_of_it_is_not_that_of_each_filament() {
        for (value, own, wanted) in [
            (0.3, Some(0.1), Some(true)),
            (0.15, Some(0.1), Some(false)),
            (0.1, Some(-0.1), Some(true)),
            (0.3, None, None),
        ] {
            assert_eq!(Effect { own, ..effect(value) }.is_of_clouds(), wanted, "{value} {own:?}");
        }
    }

    #[test]
    fn values_of_keys_have_units_unless_they_are_counts() {
        let key = |whole: bool| ChangedKey {
            key: String::new(),
            dimension: Dimension::Length,
            whole,
            by_kelvin: false,
            from: 0.0,
            to: 0.0,
        };
        assert_eq!([key(true).pretty(12.0), key(false).pretty(0.05)], ["12", "50 mm"]);
    }
}
