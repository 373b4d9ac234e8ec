//! How a row of the table of keys is written.

use super::value::{DataFile, Kind, SWITCH, Sign, Value};
use super::{Condition, Key, Omission, Relations};
use crate::case::Case;
use crate::line::Line;
use spunlaid_air::{Flow, PlacedField};
use spunlaid_ground::{Dimension, Fault, Vec3};

/// How to get and set the value of a key in a case or another input.
pub struct AccessTo<T: 'static> {
    /// Reads it; None if the input has none.
    pub get: fn(&T) -> Option<Value>,
    /// Sets it.
    pub set: fn(&mut T, &Value) -> Result<(), Fault>,
}

/// Access to a case.
pub(super) type Access = AccessTo<Case>;

/// A fibre that is fed on to a belt.
pub(super) const FED: &Condition = &Condition { words: "of a fed fibre", holds: |case| case.line.is_some() };

/// What a key is in memory.
pub trait KeyField {
    /// Its value; None if there is none.
    fn report(&self) -> Option<Value>;

    /// Sets it.
    fn take(&mut self, value: &Value) -> Result<(), Fault>;
}

/// Fields of a plain type, each with what makes a value of them and what takes one.
macro_rules! fields {
    ($($type:ty: $report:expr, $take:ident;)+) => {
        $(impl KeyField for $type {
            fn report(&self) -> Option<Value> {
                let report: fn(&Self) -> Value = $report;
                Some(report(self))
            }

            fn take(&mut self, value: &Value) -> Result<(), Fault> {
                *self = $take(value)?;
                Ok(())
            }
        })+
    };
}

fields! {
    f64: |number| Value::Number(*number), number;
    u64: |number| Value::Whole(*number), whole;
    bool: |switch| Value::from_switch(*switch), switch;
    String: |text| Value::Text(text.clone()), text;
    usize: |number| Value::Whole(*number as u64), count;
    Vec3<f64>: |vector| Value::Vector(*vector), vector;
    Vec<f64>: |list| Value::Numbers(list.clone()), numbers;
}

impl<F: KeyField + Default> KeyField for Option<F> {
    fn report(&self) -> Option<Value> {
        self.as_ref()?.report()
    }

    fn take(&mut self, value: &Value) -> Result<(), Fault> {
        self.insert(F::default()).take(value)
    }
}

/// Fields that are one of several named options: `named_fields!(Root)`.
macro_rules! named_fields {
    ($($type:ty),+) => {
        $(impl $crate::case::keys::row::KeyField for $type {
            fn report(&self) -> Option<$crate::case::keys::Value> {
                Some(self.name().into())
            }

            fn take(&mut self, value: &$crate::case::keys::Value) -> Result<(), spunlaid_ground::Fault> {
                $crate::case::keys::row::change(self, value, &Self::ALL, |one| one.name())
            }
        })+
    };
}

/// Access to a field, `at!(fibre.diameter)`; or to one of a part that an input may lack, which two functions find,
/// `at!(placed, placed_mut, root)`.
#[doc(hidden)]
#[macro_export]
macro_rules! at {
    ($($field:ident).+) => {
        Access {
            get: |input| $crate::case::keys::row::KeyField::report(&input.$($field).+),
            set: |input, value| $crate::case::keys::row::KeyField::take(&mut input.$($field).+, value),
        }
    };
    ($get:ident, $set:ident, $($field:ident).+) => {
        Access {
            get: |input| $crate::case::keys::row::KeyField::report(&$get(input)?.$($field).+),
            set: |input, value| $crate::case::keys::row::KeyField::take(&mut $set(input)?.$($field).+, value),
        }
    };
}

/// Access to a field of a part that an input may lack: where the part is, to read and to change it, its pattern with
/// the field, and what is wrong without it.
#[doc(hidden)]
#[macro_export]
macro_rules! within {
    (|$input:ident| $get:expr, $set:expr, $pattern:pat => $part:ident $(.$field:ident)*, $fault:expr) => {
        Access {
            get: |$input| {
                use $crate::case::keys::row::KeyField as _;
                match $get {
                    $pattern => $part $(.$field)* .report(),
                    _ => None,
                }
            },
            set: |$input, value| {
                use $crate::case::keys::row::KeyField as _;
                match $set {
                    $pattern => $part $(.$field)* .take(value),
                    _ => Err($fault),
                }
            },
        }
    };
}

pub use at;
pub use within;

/// Access to a number of the air that the flow may give instead.
macro_rules! of_air {
    ($field:ident) => {
        Access {
            get: |case| Some(Value::Number(case.air.$field)),
            set: |case, value| {
                case.air.$field = number(value)?;
                case.air.from_flow.$field = false;
                Ok(())
            },
        }
    };
}

/// Access to a factor on a number of the air that the flow gives: `of_flow!(length_scale, length_factor)`.
macro_rules! of_flow {
    ($number:ident, $factor:ident) => {
        Access {
            get: |case| case.air.from_flow.$number.then_some(Value::Number(case.air.$factor)),
            set: |case, value| {
                if !case.air.flow.numbers().$number {
                    let needed = concat!("a profile or a field that gives ", stringify!($number));
                    return Err(Fault::needs(needed, concat!("change air.", stringify!($number))));
                }
                case.air.$factor = number(value)?;
                Ok(())
            },
        }
    };
}

/// Access to the name of an array that a case gives for a field: `of_field_layout!(velocity)`.
macro_rules! of_field_layout {
    ($array:ident) => {
        Access {
            get: |case| placed(case)?.field.layout().$array.clone().map(Value::Text),
            set: |case, value| {
                let name = text(value)?;
                match placed_mut(case)?.field.layout().$array == Some(name) {
                    // The field has been read with it.
                    true => Ok(()),
                    false => Err(read_with_case()),
                }
            },
        }
    };
}

/// Access to what a case says of the file of a record: `of_record!(rate, Value::Number, number)`.
macro_rules! of_record {
    ($field:ident, $value:path, $read:ident) => {
        Access {
            get: |case| case.air.records.first()?.layout.clone().$field.map($value),
            set: |case, value| {
                let setting = $read(value)?;
                match case.air.records.first() {
                    None => Err(Fault::needs("air.record", "leave it out")),
                    // The records have been read with it.
                    Some(record) if record.layout.$field == Some(setting) => Ok(()),
                    Some(_) => Err(read_with_case()),
                }
            },
        }
    };
}

/// Access to a time that is a whole number of steps.
macro_rules! steps {
    ($field:ident, $time:ident, $least:expr) => {
        Access {
            get: |case| (case.run.time_step > 0.0).then(|| Value::Number(case.run.$time())),
            set: |case, value| {
                case.run.$field = whole_parts(number(value)?, case.run.time_step).0.max($least);
                Ok(())
            },
        }
    };
}

/// A key of which it is still to be said where its value is.
pub struct NewKey {
    name: &'static str,
    kind: Kind,
    varies: bool,
    usual: Option<(f64, f64)>,
}

/// A new key: its full name, and the kind of its values.
pub const fn key(name: &'static str, kind: Kind) -> NewKey {
    NewKey { name, kind, varies: false, usual: None }
}

/// A quantity of any size, which a study may vary.
pub(crate) const fn of_any_size(name: &'static str, dimension: Dimension, sign: Sign) -> NewKey {
    NewKey { varies: true, ..key(name, Kind::Quantity(dimension, sign)) }
}

/// A quantity, which a study may vary. Outside of `usual`, in SI units and of the magnitude, a value is most likely a
/// slip, unless it is zero.
pub const fn quantity(name: &'static str, dimension: Dimension, sign: Sign, usual: (f64, f64)) -> NewKey {
    NewKey { usual: Some(usual), ..of_any_size(name, dimension, sign) }
}

/// One of a few words, which a study may vary.
pub const fn choose(name: &'static str, names: fn() -> Vec<&'static str>) -> NewKey {
    NewKey { varies: true, ..key(name, Kind::Choice(names)) }
}

pub(super) const fn file(name: &'static str, kind: DataFile) -> NewKey {
    key(name, Kind::File(kind))
}

impl NewKey {
    /// Where its value is.
    pub const fn access<T>(self, access: AccessTo<T>) -> Key<T> {
        let (Self { name, kind, varies, usual }, AccessTo { get, set }) = (self, access);
        Key {
            name,
            kind,
            omission: Omission::Follows(""),
            meaning: "",
            synonyms: &[],
            label: name,
            varies,
            in_flight: false,
            slider: None,
            usual,
            read_last: false,
            words: &[],
            relations: Relations::NONE,
            needed_if: None,
            default_if: None,
            infer: |_| false,
            in_other_words: |_| None,
            get,
            set,
            derived: |_| false,
        }
    }

    /// A key of a file that is read as a whole: its value can be reported, and is never set alone.
    pub const fn reported<T>(self, get: fn(&T) -> Option<Value>) -> Key<T> {
        self.access(AccessTo { get, set: |_, _| Err(read_with_case()) })
    }
}

impl<T> Key<T> {
    setters! {
        pub fn:
        /// It must be written: an example.
        required(example: &'static str) { omission: Omission::Required(example) }
        /// Its default.
        value(value: &'static str) { omission: Omission::Value(value) }
        /// Without it, its value follows from this.
        follows(words: &'static str) { omission: Omission::Follows(words) }
        /// What it means, in words.
        meaning(meaning: &'static str) { meaning }
        /// Other words for it.
        synonyms(synonyms: &'static [&'static str]) { synonyms }
        /// Its name on an axis.
        label(label: &'static str) { label }
        /// The range of its slider.
        slider(least: f64, greatest: f64) { slider: Some((least, greatest)) }
        /// Its usual range.
        usual(least: f64, greatest: f64) { usual: Some((least, greatest)) }
        /// A study may vary it.
        varies() { varies: true }
        /// No study varies it.
        fixed() { varies: false }
        /// It may change during a flight.
        in_flight() { in_flight: true }
        /// It is read after all other keys.
        read_last() { read_last: true }
        /// Words that may stand in place of a number.
        or_words(words: &'static [&'static str]) { words }
        /// Whether an input gives it in another way.
        derived(derived: fn(&T) -> bool) { derived }
        /// Another name, for another key with the same words.
        named(name: &'static str) { name }
        /// It has no relations to other keys.
        unrelated() { relations: Relations::NONE }
        /// It must be written if this holds: an example.
        needed_if(when: &'static Condition<T>, example: &'static str) { needed_if: Some((when, example)) }
        /// Its default if this holds.
        default_if(when: &'static Condition<T>, value: &'static str) { default_if: Some((when, value)) }
        /// How it follows from other values; whether it does.
        inferred(infer: fn(&mut T) -> bool) { infer }
        /// Its value in an input that says it with other keys.
        in_other_words(value: fn(&T) -> Option<Value>) { in_other_words: value }
    }

    /// The same key of another input: its values, its words and its relations.
    pub const fn of_input<U>(&self, access: AccessTo<U>) -> Key<U> {
        let Self { name, kind, varies, usual, omission, meaning, synonyms, label, .. } = *self;
        let read_last = self.read_last;
        let words = self.words;
        let relations = self.relations;
        let new = NewKey { name, kind, varies, usual }.access(access);
        Key { omission, meaning, synonyms, label, read_last, words, relations, ..new }
    }

    /// The same key of a web, where it has another name.
    pub const fn called(self, name: &'static str) -> Self {
        Self { name, ..self.same_in_case(self.name) }
    }

    /// A quantity with the same words that is above zero.
    pub const fn above_zero(self) -> Self {
        let Kind::Quantity(dimension, _) = self.kind else { return self };
        Self { kind: Kind::Quantity(dimension, Sign::Positive), ..self }
    }
}

impl AccessTo<()> {
    /// Of a file that describes several inputs: its keys have no access to any.
    pub const NONE: Self = Self { get: |()| None, set: |(), _| Ok(()) };
}

/// The fault of a value of the wrong kind. It only occurs if the caller has not checked the value.
fn wrong_type(value: &Value, wanted: &str) -> Fault {
    Fault::wrong_type(value.what(), wanted)
}

/// The fault of a value that can only be set by reading the case again.
pub(crate) fn read_with_case() -> Fault {
    Fault::new(
        "is read from a file together with the case",
        "write it in the case file and read the case again",
    )
}

/// The number of a value.
pub fn number(value: &Value) -> Result<f64, Fault> {
    value.number().ok_or_else(|| wrong_type(value, "a number"))
}

/// The whole number of a value.
pub fn whole(value: &Value) -> Result<u64, Fault> {
    match value {
        Value::Whole(number) => Ok(*number),
        _ => Err(wrong_type(value, "a whole number")),
    }
}

fn count(value: &Value) -> Result<usize, Fault> {
    Ok(usize::try_from(whole(value)?).unwrap_or(usize::MAX))
}

/// A list of numbers; one alone makes a list.
fn numbers(value: &Value) -> Result<Vec<f64>, Fault> {
    match value {
        Value::Numbers(numbers) => Ok(numbers.clone()),
        _ => Ok(vec![number(value)?]),
    }
}

/// The text of a value.
pub fn text(value: &Value) -> Result<String, Fault> {
    match value {
        Value::Text(text) => Ok(text.clone()),
        _ => Err(wrong_type(value, "a text")),
    }
}

pub(crate) fn switch(value: &Value) -> Result<bool, Fault> {
    match value {
        Value::Text(text) if text == SWITCH[1] => Ok(true),
        Value::Text(text) if text == SWITCH[0] => Ok(false),
        _ => Err(wrong_type(value, "true or false")),
    }
}

pub(super) fn vector(value: &Value) -> Result<Vec3<f64>, Fault> {
    match value {
        Value::Vector(vector) => Ok(*vector),
        _ => Err(wrong_type(value, "a vector")),
    }
}

/// The option that a value names.
pub fn named<T: Copy>(value: &Value, all: &[T], name: impl Fn(T) -> &'static str) -> Result<T, Fault> {
    let found = match value {
        Value::Text(text) => all.iter().copied().find(|one| name(*one) == text),
        _ => None,
    };
    found.ok_or_else(|| wrong_type(value, "a name"))
}

/// Takes a number that a file may give, and says whether it does.
pub(super) fn take(number: &mut f64, of_file: Option<f64>) -> bool {
    *number = of_file.unwrap_or(*number);
    of_file.is_some()
}

/// Changes to another of several named options. One that is chosen already keeps its numbers.
pub(super) fn change<T: Copy>(
    chosen: &mut T,
    value: &Value,
    all: &[T],
    name: impl Fn(T) -> &'static str,
) -> Result<(), Fault> {
    let other = named(value, all, &name)?;
    if name(other) != name(*chosen) {
        *chosen = other;
    }
    Ok(())
}

pub(super) fn placed(case: &Case) -> Option<&PlacedField> {
    match &case.air.flow {
        Flow::Field(placed) => Some(placed),
        _ => None,
    }
}

pub(super) fn placed_mut(case: &mut Case) -> Result<&mut PlacedField, Fault> {
    match &mut case.air.flow {
        Flow::Field(placed) => Ok(placed),
        _ => {
            let remedy = "leave it out, or name the file of a CFD field";
            Err(Fault::needs("air.field", remedy))
        }
    }
}

pub(super) fn fed(case: &Case) -> Option<&Line> {
    case.line.as_ref()
}

/// Feed and belt of a fed fibre.
pub(super) fn line(case: &mut Case) -> Result<&mut Line, Fault> {
    let remedy = "leave it out, or feed the fibre on to a belt";
    case.line.as_mut().ok_or_else(|| Fault::needs("feed.speed", remedy))
}

/// Refuses a value that the spinline of the case gives.
pub(super) fn without_spinline(case: &Case) -> Result<(), Fault> {
    if case.spinline.is_none() {
        return Ok(());
    }
    Err(Fault::excludes(
        "[spinline]",
        "the spinline gives this number; leave it out, or leave out [spinline]",
    ))
}
