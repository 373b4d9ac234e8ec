//! What a key has to do with other keys. The builders belong to the rows of the table.

use super::{Key, Omission, Value};
use crate::fibre::case::Case;
use crate::ground::Fault;

/// A circumstance in which a key is needed, or has another default.
#[derive(Debug)]
pub struct Condition<T: 'static = Case> {
    /// When it holds, `of a fed fibre`.
    pub words: &'static str,
    pub(crate) holds: fn(&T) -> bool,
}

/// The relations of a key to other keys of its file.
#[derive(Debug)]
pub struct Relations<T: 'static = Case> {
    /// Keys whose values it gives in other words, all of them at once. What is set from outside, or varies,
    /// replaces what stands in the file in other words.
    pub alternative_to: &'static [&'static str],
    /// Whether it gives one of these values, whichever the input has, and not all of them.
    pub(crate) gives_one: bool,
    /// Why it cannot stand beside them, and the way out.
    pub(crate) remedy: &'static str,
    /// When it is needed, with an example value.
    pub needed_if: Option<(&'static Condition<T>, &'static str)>,
    /// When it has another default, and which.
    pub default_if: Option<(&'static Condition<T>, &'static str)>,
    /// Keys that have to be set before it.
    pub(crate) read_after: &'static [&'static str],
    /// Takes it from what has been set if it is left out, and says whether that gives it.
    pub(crate) infer: fn(&mut T) -> bool,
    /// What the file that it names may give: a key, or all keys whose names begin like this.
    pub(crate) gives: &'static str,
    /// Whether a unit alone is one of it.
    pub(crate) takes_unit: bool,
    /// Its value in an input that says it in other words.
    pub(crate) in_other_words: fn(&T) -> Option<Value>,
    /// The line of a study that stands in its place, `seed = 1`.
    pub(crate) in_study: Option<&'static str>,
    /// The key of a case that means the same, where it has another name.
    pub(crate) same_in_case: Option<&'static str>,
    /// Keys of the flown cases whose values it gives.
    pub(crate) gives_case: &'static [&'static str],
    /// Another key and its value, without which it cannot be set, and which a web in one air has anyway.
    pub(crate) with_in_one_air: Option<(&'static str, &'static str)>,
    /// Whether it is one number for all layers of a web, which any of them may give.
    pub(crate) of_all_layers: bool,
}

// Derived ones would ask the same of `T`.
impl<T> Clone for Relations<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Relations<T> {}

impl<T> Relations<T> {
    /// Those of a key that has nothing to do with others.
    pub(super) const NONE: Self = Self {
        alternative_to: &[],
        gives_one: false,
        remedy: "",
        needed_if: None,
        default_if: None,
        read_after: &[],
        infer: |_| false,
        gives: "",
        takes_unit: false,
        in_other_words: |_| None,
        in_study: None,
        same_in_case: None,
        gives_case: &[],
        with_in_one_air: None,
        of_all_layers: false,
    };
}

impl<T> Key<T> {
    /// It may be written instead of these keys, and gives all of them.
    ///
    /// * `remedy` – why both cannot be written, and the way out
    pub(crate) const fn alternative_to(self, keys: &'static [&'static str], remedy: &'static str) -> Self {
        Self { relations: Relations { alternative_to: keys, remedy, ..self.relations }, ..self }
    }

    /// The same of keys of which an input has one at most, which it gives.
    pub(crate) const fn alternative_to_one_of(
        self,
        keys: &'static [&'static str],
        remedy: &'static str,
    ) -> Self {
        let other = self.alternative_to(keys, remedy);
        Self { relations: Relations { gives_one: true, ..other.relations }, ..other }
    }

    pub(crate) const fn needed_if(self, when: &'static Condition<T>, example: &'static str) -> Self {
        Self { relations: Relations { needed_if: Some((when, example)), ..self.relations }, ..self }
    }

    pub(crate) const fn default_if(self, when: &'static Condition<T>, value: &'static str) -> Self {
        Self { relations: Relations { default_if: Some((when, value)), ..self.relations }, ..self }
    }

    pub(crate) const fn read_after(self, keys: &'static [&'static str]) -> Self {
        Self { relations: Relations { read_after: keys, ..self.relations }, ..self }
    }

    pub(crate) const fn inferred(self, infer: fn(&mut T) -> bool) -> Self {
        Self { relations: Relations { infer, ..self.relations }, ..self }
    }

    pub(crate) const fn gives(self, gives: &'static str) -> Self {
        Self { relations: Relations { gives, ..self.relations }, ..self }
    }

    pub(crate) const fn or_unit(self) -> Self {
        Self { relations: Relations { takes_unit: true, ..self.relations }, ..self }
    }

    pub(crate) const fn in_other_words(self, value: fn(&T) -> Option<Value>) -> Self {
        Self { relations: Relations { in_other_words: value, ..self.relations }, ..self }
    }

    pub(crate) const fn in_study(self, line: &'static str) -> Self {
        Self { relations: Relations { in_study: Some(line), ..self.relations }, ..self }
    }

    pub(crate) const fn same_in_case(self, key: &'static str) -> Self {
        Self { relations: Relations { same_in_case: Some(key), ..self.relations }, ..self }
    }

    pub(crate) const fn gives_case(self, keys: &'static [&'static str]) -> Self {
        Self { relations: Relations { gives_case: keys, ..self.relations }, ..self }
    }

    pub(crate) const fn with_in_one_air(self, key: &'static str, value: &'static str) -> Self {
        Self { relations: Relations { with_in_one_air: Some((key, value)), ..self.relations }, ..self }
    }

    pub(crate) const fn of_all_layers(self) -> Self {
        Self { relations: Relations { of_all_layers: true, ..self.relations }, ..self }
    }

    /// Its value in an input, which may say it in other words.
    pub(crate) fn value_in(&self, input: &T) -> Option<Value> {
        self.get(input).or_else(|| (self.relations.in_other_words)(input))
    }

    /// Its default in an input, if it has one there.
    pub fn default_in(&self, input: &T) -> Option<&'static str> {
        match (self.omission, self.relations.default_if) {
            (Omission::Value(_), Some((when, value))) if (when.holds)(input) => Some(value),
            (Omission::Value(value), _) => Some(value),
            _ => None,
        }
    }

    /// Whether it has to be written in an input that does not give it in another way.
    pub(crate) fn is_needed(&self, input: &T) -> bool {
        matches!(self.omission, Omission::Required(_))
            || self.relations.needed_if.is_some_and(|(when, _)| (when.holds)(input))
    }

    /// Takes it from what else is known of an input, and says whether that gives it.
    pub(crate) fn infer(&self, input: &mut T) -> bool {
        self.is_derived(input) || (self.relations.infer)(input)
    }

    /// The fault of this key beside one that it stands instead of.
    pub(crate) fn beside_alternative(&self, is_written: impl Fn(&str) -> bool) -> Option<Fault> {
        let Relations { alternative_to, remedy, .. } = self.relations;
        let other = alternative_to.iter().find(|other| is_written(other))?;
        Some(Fault::excludes(other, remedy))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{CASE, KeyTable, Kind};
    use super::*;

    /// Whether a value is one of a key, as text.
    fn takes<T>(key: &Key<T>, value: &str) -> bool {
        key.words.contains(&value) || key.kind.accept(value.trim_matches('"').into()).is_ok()
    }

    impl<T> KeyTable<T> {
        /// Panics where a row names a key that is not there, or a value that its key does not take.
        pub(crate) fn check_relations(&self) {
            let is_known = |name: &&str| self.find(name).is_some() || self.list(name).is_some();
            for key in self.rows {
                let Relations { alternative_to, remedy, read_after, .. } = key.relations;
                assert!([alternative_to, read_after].concat().iter().all(is_known), "{}", key.name);
                assert_eq!(alternative_to.is_empty(), remedy.is_empty(), "{}", key.name);
                // Two keys that give the same one are refused beside each other, or the last would win.
                let shares = |other: &&Key<T>| {
                    other.relations.alternative_to.iter().any(|name| alternative_to.contains(name))
                };
                let others = self.rows.iter().filter(|other| other.name != key.name).filter(shares);
                others
                    .for_each(|other| assert!(self.are_alternatives(key.name, other.name), "{}", other.name));
                assert_eq!(
                    matches!(key.kind, Kind::File(_)),
                    !key.relations.gives.is_empty(),
                    "{}",
                    key.name
                );
                let of_case = key.relations.same_in_case.iter().chain(key.relations.gives_case);
                assert!(of_case.copied().all(|name| CASE.find(name).is_some()), "{}", key.name);
                if let Some((name, value)) = key.relations.with_in_one_air {
                    assert!(self.find(name).is_some_and(|other| takes(other, value)), "{}", key.name);
                }
                let texts = [key.relations.needed_if, key.relations.default_if];
                assert!(texts.iter().flatten().all(|(_, value)| takes(key, value)), "{}", key.name);
                if let Omission::Required(value) | Omission::Value(value) = key.omission
                    && !matches!(key.kind, Kind::File(_) | Kind::Direction | Kind::Other(_))
                {
                    assert!(takes(key, value), "{}: {value}", key.name);
                }
            }
        }
    }

    #[test]
    fn relations_name_keys_that_are_there_and_values_that_they_take() {
        CASE.check_relations();
    }

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
