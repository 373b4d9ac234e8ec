//! What a key has to do with other keys. The builders belong to the rows of the table.

use super::{Key, Omission};
use crate::case::Case;
use crate::error::Fault;

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
    /// Keys whose values it gives in other words, all of them at once. What is set from outside, or varies, replaces
    /// what stands in the file in other words.
    pub alternative_to: &'static [&'static str],
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
    /// The key of a case that means the same, where it has another name.
    pub(crate) same_in_case: Option<&'static str>,
    /// Keys of the flown cases whose values it gives.
    pub(crate) gives_case: &'static [&'static str],
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
        remedy: "",
        needed_if: None,
        default_if: None,
        read_after: &[],
        infer: |_| false,
        gives: "",
        takes_unit: false,
        same_in_case: None,
        gives_case: &[],
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

    pub(crate) const fn same_in_case(self, key: &'static str) -> Self {
        Self { relations: Relations { same_in_case: Some(key), ..self.relations }, ..self }
    }

    pub(crate) const fn gives_case(self, keys: &'static [&'static str]) -> Self {
        Self { relations: Relations { gives_case: keys, ..self.relations }, ..self }
    }

    pub(crate) const fn of_all_layers(self) -> Self {
        Self { relations: Relations { of_all_layers: true, ..self.relations }, ..self }
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
