//! What a key has to do with other keys. The builders belong to the rows of the table.

use super::{Key, Omission, Value};
use crate::case::Case;
use spunlaid_ground::Fault;

/// A circumstance in which a key is needed, or has another default.
#[derive(Debug)]
pub struct Condition<T: 'static = Case> {
    /// When it holds, `of a fed fibre`.
    pub words: &'static str,
    /// Whether it holds in an input.
    pub holds: fn(&T) -> bool,
}

/// The relations of a key to other keys of its file, by their names.
#[derive(Clone, Copy, Debug)]
pub struct Relations {
    /// Keys whose values it gives in other words, all of them at once. What is set from outside, or varies,
    /// replaces what stands in the file in other words.
    pub alternative_to: &'static [&'static str],
    /// Whether it gives one of these values, whichever the input has, and not all of them.
    pub(crate) gives_one: bool,
    /// Why it cannot stand beside them, and the way out.
    pub remedy: &'static str,
    /// Keys that have to be set before it.
    pub read_after: &'static [&'static str],
    /// What the file that it names may give: a key, or all keys whose names begin like this.
    pub gives: &'static str,
    /// Whether a unit alone is one of it.
    pub takes_unit: bool,
    /// The line of a study that stands in its place, `seed = 1`.
    pub in_study: Option<&'static str>,
    /// The key of a case that means the same, where it has another name.
    pub same_in_case: Option<&'static str>,
    /// Keys of the simulated cases whose values it gives.
    pub gives_case: &'static [&'static str],
    /// Another key and its value, without which it cannot be set, and which a web in shared turbulence has anyway.
    pub with_in_one_air: Option<(&'static str, &'static str)>,
    /// Why it is one number for all layers of a web, which any of them may give; none of one of each layer.
    pub of_all_layers: Option<&'static str>,
}

impl Relations {
    /// Those of a key that has nothing to do with others.
    pub(crate) const NONE: Self = Self {
        alternative_to: &[],
        gives_one: false,
        remedy: "",
        read_after: &[],
        gives: "",
        takes_unit: false,
        in_study: None,
        same_in_case: None,
        gives_case: &[],
        with_in_one_air: None,
        of_all_layers: None,
    };
}

impl<T> Key<T> {
    setters! {
        pub fn in relations: Relations:
        /// It may be written instead of these keys, and gives all of them: why both cannot be written, and the way out.
        alternative_to(keys: &'static [&'static str], remedy: &'static str) { alternative_to: keys, remedy }
        /// The same of keys of which an input has one at most, which it gives.
        alternative_to_one_of(keys: &'static [&'static str], remedy: &'static str) {
            alternative_to: keys, remedy, gives_one: true
        }
        /// It is read after these keys.
        read_after(keys: &'static [&'static str]) { read_after: keys }
        /// What it gives, in words.
        gives(gives: &'static str) { gives }
        /// A number with a unit may stand in its place.
        or_unit() { takes_unit: true }
        /// What the file of a study says of it.
        in_study(line: &'static str) { in_study: Some(line) }
        /// The key of a case that means the same.
        same_in_case(key: &'static str) { same_in_case: Some(key) }
        /// The keys of a case that it gives.
        gives_case(keys: &'static [&'static str]) { gives_case: keys }
        /// The value of another key in shared turbulence.
        with_in_one_air(key: &'static str, value: &'static str) { with_in_one_air: Some((key, value)) }
        /// All layers share it: why.
        of_all_layers(why: &'static str) { of_all_layers: Some(why) }
    }

    /// Its value in an input, which may say it in other words.
    pub fn value_in(&self, input: &T) -> Option<Value> {
        self.get(input).or_else(|| (self.in_other_words)(input))
    }

    /// Its default in an input, if it has one there.
    pub fn default_in(&self, input: &T) -> Option<&'static str> {
        match (self.omission, self.default_if) {
            (Omission::Value(_), Some((when, value))) if (when.holds)(input) => Some(value),
            (Omission::Value(value), _) => Some(value),
            _ => None,
        }
    }

    /// Whether it has to be written in an input that does not give it in another way.
    pub(crate) fn is_needed(&self, input: &T) -> bool {
        matches!(self.omission, Omission::Required(_))
            || self.needed_if.is_some_and(|(when, _)| (when.holds)(input))
    }

    /// Takes it from what else is known of an input, and says whether that gives it.
    pub fn infer(&self, input: &mut T) -> bool {
        self.is_derived(input) || (self.infer)(input)
    }

    /// The fault of this key beside one that it stands instead of.
    pub fn beside_alternative(&self, is_written: impl Fn(&str) -> bool) -> Option<Fault> {
        let Relations { alternative_to, remedy, .. } = self.relations;
        let other = alternative_to.iter().find(|other| is_written(other))?;
        Some(Fault::excludes(other, remedy))
    }
}

#[cfg(test)]
mod tests {
    use super::super::CASE;

    #[test]
    fn a_key_is_replaced_by_those_that_give_all_of_it() {
        let of_case = |names: &[&str]| CASE.replaced_by(names);
        assert_eq!(of_case(&["fibre.diameter"]), ["fibre.linear_density"]);
        assert_eq!(of_case(&["fibre.linear_density"]), ["fibre.diameter"]);
        assert_eq!(of_case(&["air.temperature"]), ["air.density", "air.kinematic_viscosity"]);
        // The density alone says nothing of the viscosity, which the temperature gives too.
        assert_eq!(of_case(&["air.density"]), [""; 0]);
        assert_eq!(of_case(&["air.kinematic_viscosity", "air.density"]), ["air.temperature"]);
        // A pressure gives the one or the other, whichever the case has.
        assert_eq!(of_case(&["air.velocity"]), ["air.cabin_pressure"]);
        assert_eq!(of_case(&["air.speed_factor"]), ["air.cabin_pressure"]);
        assert_eq!(of_case(&["air.cabin_pressure"]), ["air.velocity", "air.speed_factor"]);
    }
}
