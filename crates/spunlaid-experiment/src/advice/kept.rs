//! What flights have said of changes, as rows of a log.

use spunlaid_ground::{Difference, Effect, Outcome};

/// Numbers of an effect.
const EFFECT: usize = 6;

/// Outcomes as numbers: how many effects there are, and these; or how many letters say why not, below zero, and these.
pub(super) fn numbers_of(outcomes: &[Outcome<f64>]) -> Vec<f64> {
    let effect = |effect: &Effect<f64>| -> [f64; EFFECT] {
        let Difference { value, standard_error, degrees } = effect.difference;
        let [own, in_common] = [effect.own, effect.in_common].map(|part| part.unwrap_or(f64::NAN));
        [effect.of, value, standard_error, degrees, own, in_common]
    };
    let numbers = |outcome: &Outcome<f64>| match outcome {
        Ok(effects) => (effects.len() as f64, effects.iter().flat_map(effect).collect()),
        Err(why) => (-(why.chars().count() as f64), why.chars().map(|c| f64::from(u32::from(c))).collect()),
    };
    let joined = |(count, numbers): (f64, Vec<f64>)| std::iter::once(count).chain(numbers);
    outcomes.iter().map(numbers).flat_map(joined).collect()
}

/// The outcomes that such numbers stand for; none if they are of another kind.
pub(super) fn outcomes_of(mut numbers: &[f64]) -> Option<Vec<Outcome<f64>>> {
    let mut all = Vec::new();
    while let [count, rest @ ..] = numbers {
        let length = if *count < 0.0 { -count } else { *count * EFFECT as f64 };
        let (own, behind) = rest.split_at_checked(length as usize)?;
        let effect = |[of, value, standard_error, degrees, own, in_common]: &[f64; EFFECT]| {
            let difference = Difference { value: *value, standard_error: *standard_error, degrees: *degrees };
            let [own, in_common] = [own, in_common].map(|part| Some(*part).filter(|part| !part.is_nan()));
            Effect { of: *of, difference, own, in_common }
        };
        all.push(match *count < 0.0 {
            true => Err(own.iter().filter_map(|letter| char::from_u32(*letter as u32)).collect()),
            false => Ok(own.as_chunks().0.iter().map(effect).collect()),
        });
        numbers = behind;
    }
    Some(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What was torn or damaged is the business of the log.
    #[test]
    fn identical_what_was_kept_comes_back_to_the_bit() {
        let difference = Difference { value: -0.1, standard_error: 1.0 / 3.0, degrees: f64::INFINITY };
        let effects = vec![Effect { own: Some(0.2), ..Effect::new(0.01, difference) }; 2];
        let outcomes = [Ok(effects), Err("why – “so”\n".to_owned()), Ok(Vec::new())];
        let numbers = numbers_of(&outcomes);
        assert_eq!(outcomes_of(&numbers).as_deref(), Some(&outcomes[..]));
        assert_eq!(outcomes_of(&numbers[..numbers.len() - 2]), None);
    }
}
