//! The kinds of values that keys take, and what each kind allows.

use crate::drag::{DragTable, FrictionLaw, NormalLaw};
use crate::spinline::{AirTable, Polymer, PolymerFile};
use spunlaid_air::{Field, FileContent, Measured, Profile, SpectrumTable};
use spunlaid_ground::error::{nearest_word, one_of};
use spunlaid_ground::units::shortest;
use spunlaid_ground::{Dimension, Fault, UnitAdvice, Vec3};
use std::path::{Path, PathBuf};

/// The value of a key.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A quantity, in SI units.
    Number(f64),
    /// A whole number.
    Whole(u64),
    /// A name such as `clamped`; or any value as text, `20 m/s`.
    Text(String),
    /// Several quantities, in SI units.
    Numbers(Vec<f64>),
    /// A direction [-] or a point [m].
    Vector(Vec3<f64>),
    /// Files that are still to be read.
    Paths(Vec<PathBuf>),
    /// The content of files.
    Content(Content),
}

/// The content of the files that a key names.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// Values along the fibre.
    Profile(FileContent<Profile>),
    /// A CFD solution.
    Field(FileContent<Field>),
    /// A spectrum.
    Spectrum(FileContent<SpectrumTable>),
    /// Velocity records.
    Records(Vec<FileContent<Measured>>),
    /// The air along a spinline.
    SpinlineAir(FileContent<AirTable>),
    /// The constants of a polymer.
    Polymer(FileContent<PolymerFile>),
    /// Drag coefficients over the Reynolds number.
    DragLaw(FileContent<DragTable>),
}

impl Content {
    /// The files that it was read from.
    pub fn paths(&self) -> Vec<&Path> {
        self.files().into_iter().map(|(path, _)| path).collect()
    }

    /// The path and the checksum of each file.
    fn files(&self) -> Vec<(&Path, u32)> {
        fn of<T>(file: &FileContent<T>) -> (&Path, u32) {
            (file.path(), file.checksum())
        }
        match self {
            Self::Profile(file) => vec![of(file)],
            Self::Field(file) => vec![of(file)],
            Self::Spectrum(file) => vec![of(file)],
            Self::SpinlineAir(file) => vec![of(file)],
            Self::Polymer(file) => vec![of(file)],
            Self::DragLaw(file) => vec![of(file)],
            Self::Records(files) => files.iter().map(of).collect(),
        }
    }

    /// Together with further records.
    pub fn with(self, other: Self) -> Self {
        match (self, other) {
            (Self::Records(records), Self::Records(more)) => Self::Records([records, more].concat()),
            (content, _) => content,
        }
    }
}

/// Values of types that are one as they stand.
macro_rules! values {
    ($($type:ty: $variant:ident),+) => {
        $(impl From<$type> for Value {
            fn from(value: $type) -> Self {
                Self::$variant(value)
            }
        })+
    };
}

values!(f64: Number, u64: Whole, String: Text, Vec3<f64>: Vector, Content: Content);

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<[f64; 3]> for Value {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self::Vector(Vec3::new(x, y, z))
    }
}

impl Value {
    /// The value of a switch.
    pub(crate) fn from_switch(is_on: bool) -> Self {
        Self::Text(SWITCH[usize::from(is_on)].to_owned())
    }

    /// Its kind in words, with an article.
    pub(super) const fn what(&self) -> &'static str {
        match self {
            Self::Number(_) => "a number",
            Self::Whole(_) => "a whole number",
            Self::Text(_) => "a text",
            Self::Numbers(_) => "a list",
            Self::Vector(_) => "a vector",
            Self::Paths(_) | Self::Content(_) => "a file",
        }
    }

    /// Its bits: equal bytes mean equal values. Of files, the contents count and not where they are.
    pub fn bytes(&self) -> Vec<u8> {
        let numbers = |numbers: &[f64]| numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        match self {
            Self::Number(number) => numbers(&[*number]),
            Self::Whole(number) => number.to_le_bytes().to_vec(),
            Self::Text(text) => text.as_bytes().to_vec(),
            Self::Numbers(all) => numbers(all),
            Self::Vector(v) => numbers(&[v.x, v.y, v.z]),
            Self::Paths(paths) => {
                paths.iter().flat_map(|path| path.as_os_str().as_encoded_bytes()).copied().collect()
            }
            Self::Content(content) => {
                content.files().into_iter().flat_map(|(_, checksum)| checksum.to_le_bytes()).collect()
            }
        }
    }

    /// The number, if it is a quantity or a whole number.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value),
            Self::Whole(value) => Some(*value as f64),
            _ => None,
        }
    }
}

/// Which numbers a quantity may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// Above zero.
    Positive,
    /// Zero or above.
    NotNegative,
    /// From zero to one.
    Share,
    /// Any.
    Any,
}

/// What a file contains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DataFile {
    /// Values along the fibre.
    Profile,
    /// A CFD solution.
    Field,
    /// A spectrum. The key also takes the name of a spectrum's shape.
    Spectrum,
    /// One velocity record or several.
    Records,
    /// The air along a spinline.
    SpinlineAir,
    /// The constants of a polymer. The key also takes the name of a polymer.
    Polymer,
    /// Coefficients of the friction along the fibre. The key also takes the name of a law.
    FrictionLaw,
    /// Coefficients of the drag across the fibre. The key also takes the name of a law.
    NormalLaw,
}

impl DataFile {
    /// The words that a key takes in place of a file, and an example of a file.
    fn words(self) -> (Vec<&'static str>, &'static str) {
        match self {
            Self::Spectrum => (SPECTRA.to_vec(), "spectrum.csv"),
            Self::Polymer => (Polymer::ALL.map(Polymer::name).to_vec(), "polymer.toml"),
            Self::FrictionLaw => (FrictionLaw::ALL.map(FrictionLaw::name).to_vec(), "coefficients.csv"),
            Self::NormalLaw => (NormalLaw::ALL.map(NormalLaw::name).to_vec(), "coefficients.csv"),
            Self::Profile | Self::Field | Self::Records | Self::SpinlineAir => (Vec::new(), ""),
        }
    }

    /// Whether a text is a word and not the name of a file.
    pub fn is_word(self, text: &str) -> bool {
        !text.is_empty() && !text.contains('.') && !self.words().0.is_empty()
    }
}

/// Which values a key takes.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A quantity with its unit.
    Quantity(Dimension, Sign),
    /// A whole number between a smallest and a largest one.
    Whole(u64, u64),
    /// Yes or no: `true` or `false`.
    Switch,
    /// One of several names.
    Choice(fn() -> Vec<&'static str>),
    /// Any text, with an example.
    Text(&'static str),
    /// A direction in space: a vector of any length except zero.
    Direction,
    /// A point in space.
    Point,
    /// Several lengths above zero.
    Lengths,
    /// The path of a file.
    File(DataFile),
    /// What another key takes, in words.
    Other(&'static str),
}

/// The words of a switch that is off, and of one that is on.
pub(super) const SWITCH: [&str; 2] = ["false", "true"];

/// The names of the built-in shapes of spectra.
pub(super) const SPECTRA: [&str; 2] = ["flat", "von-karman"];

impl Kind {
    /// Converts a value to the form that the key stores: texts are parsed, directions are normalised.
    ///
    /// # Errors
    /// If the key does not take this value.
    pub fn accept(&self, value: Value) -> Result<Value, Fault> {
        let value = match (self, value) {
            (_, Value::Text(text)) => self.read(&text)?,
            (Self::Quantity(..), Value::Whole(number)) => Value::Number(number as f64),
            (Self::Whole(..), Value::Number(number))
                if number.fract() == 0.0 && (0.0..1.8e19).contains(&number) =>
            {
                Value::Whole(number as u64)
            }
            (Self::Direction, Value::Vector(vector)) => Value::Vector(unit(vector)?),
            (_, value) => value,
        };
        self.fault(&value).map_or(Ok(value), Err)
    }

    /// What is wrong with a value, if anything.
    pub fn fault(&self, value: &Value) -> Option<Fault> {
        let not_finite = |v: &Vec3<f64>| ![v.x, v.y, v.z].iter().all(|c| c.is_finite());
        match (self, value) {
            (Self::Quantity(_, _), Value::Number(value)) if !value.is_finite() => Some(Fault::not_finite()),
            (Self::Quantity(dimension, sign), Value::Number(value)) => {
                let quantity = dimension.name();
                match sign {
                    Sign::Positive if *dimension == Dimension::Temperature && *value <= 0.0 => {
                        let remedy = "a temperature above 0 K, which is -273.15 °C, is needed";
                        Some(Fault::new("is not above absolute zero", remedy))
                    }
                    Sign::Share if !(0.0..=1.0).contains(value) => {
                        Some(Fault::new("is not a fraction", "a number from 0 to 1 is needed"))
                    }
                    Sign::Positive if *value <= 0.0 => {
                        Some(Fault::new("is not positive", format!("{quantity} above zero is needed")))
                    }
                    Sign::NotNegative if *value < 0.0 => {
                        Some(Fault::new("is negative", format!("{quantity} of zero or more is needed")))
                    }
                    _ => None,
                }
            }
            (&Self::Whole(least, most), Value::Whole(value)) => {
                (!(least..=most).contains(value)).then(|| Fault::out_of_range(least, most))
            }
            (Self::Direction | Self::Point, Value::Vector(v)) if not_finite(v) => Some(Fault::not_finite()),
            (Self::Direction, Value::Vector(v)) => ((v.norm() - 1.0).abs() > 1e-12)
                .then(|| Fault::new("is not a unit vector", "divide it by its length")),
            (Self::Choice(_) | Self::Switch | Self::File(_), Value::Text(text)) => {
                let names = self.names();
                if names.contains(&text.as_str()) {
                    return None;
                }
                let nearest = nearest_word(text, names.iter().copied());
                Some(Fault::not_one_of(nearest, &names))
            }
            (Self::Text(_), Value::Text(text)) => {
                text.trim().is_empty().then(|| Fault::wrong_type("an empty text", self.wanted()))
            }
            (Self::Lengths, Value::Numbers(lengths)) => lengths_fault(lengths, self),
            (Self::Point, Value::Vector(_)) | (Self::File(_), Value::Paths(_) | Value::Content(_)) => None,
            (&Self::Whole(least, most), Value::Number(number)) if !(0.0..1.8e19).contains(number) => {
                Some(Fault::out_of_range(least, most))
            }
            (_, value) => Some(Fault::wrong_type(value.what(), self.wanted())),
        }
    }

    /// The words that the key takes, if any.
    pub fn words(&self) -> Vec<&'static str> {
        match self {
            Self::Choice(names) => names(),
            Self::Switch => SWITCH.to_vec(),
            Self::File(kind) => kind.words().0,
            _ => Vec::new(),
        }
    }

    /// The words that the key takes, with an example of a file if it also takes one.
    pub(crate) fn names(&self) -> Vec<&'static str> {
        let words = self.words();
        let file = match self {
            Self::File(kind) if !words.is_empty() => Some(kind.words().1),
            _ => None,
        };
        words.into_iter().chain(file).collect()
    }

    /// In words, what to write.
    pub fn wanted(&self) -> String {
        match self {
            Self::Quantity(dimension, _) => UnitAdvice(*dimension).to_string(),
            Self::Whole(..) => "a whole number without quotes, like 10".to_owned(),
            Self::Switch => "true or false, without quotes".to_owned(),
            Self::Choice(_) => one_of(&self.names()),
            Self::File(kind) if !kind.words().0.is_empty() => one_of(&self.names()),
            Self::Text(example) => format!("a text like \"{example}\""),
            Self::Direction => "three plain numbers, like [1.0, 0.0, 0.0]".to_owned(),
            Self::Point => "three lengths, like [\"0 m\", \"50 mm\", \"0 m\"]".to_owned(),
            Self::Lengths => "a list of lengths, like [\"1 mm\", \"5 mm\"]".to_owned(),
            Self::File(DataFile::Records) => {
                "the path of a record, \"probe.csv\", or a list with one for each eddy".to_owned()
            }
            Self::File(_) => "the path of a file, in quotes".to_owned(),
            Self::Other(words) => (*words).to_owned(),
        }
    }

    /// The dimension of a quantity; none for other kinds.
    pub const fn dimension(&self) -> Option<Dimension> {
        match self {
            Self::Quantity(dimension, _) => Some(*dimension),
            Self::Point | Self::Lengths => Some(Dimension::Length),
            _ => None,
        }
    }

    /// The allowed values in words: `a length above zero`.
    pub fn allowed(&self) -> String {
        match *self {
            Self::Quantity(Dimension::Temperature, Sign::Positive) => {
                "a temperature above absolute zero".to_owned()
            }
            Self::Quantity(dimension, Sign::Share) => format!("{} from 0 to 1", dimension.name()),
            Self::Quantity(dimension, Sign::Positive) => format!("{} above zero", dimension.name()),
            Self::Quantity(dimension, Sign::NotNegative) => format!("{}, zero or above", dimension.name()),
            Self::Quantity(dimension, Sign::Any) => format!("{}, of either sign", dimension.name()),
            Self::Whole(0, _) => "a whole number".to_owned(),
            Self::Whole(least, most) if most > 1 << 50 => format!("a whole number from {least} up"),
            Self::Whole(least, most) => format!("a whole number from {least} to {most}"),
            Self::Switch => "true or false".to_owned(),
            Self::Choice(_) | Self::Text(_) | Self::Other(_) => self.wanted(),
            Self::File(kind) if !kind.words().0.is_empty() => {
                let names = self.words().iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>();
                format!("{} or the path of a file", names.join(", "))
            }
            Self::Direction => "three numbers, like [1.0, 0.0, 0.0]".to_owned(),
            Self::Lengths => "a list of lengths above zero, like [\"1 mm\", \"5 mm\"]".to_owned(),
            Self::Point => "three lengths, like [\"0 m\", \"50 mm\", \"0 m\"]".to_owned(),
            Self::File(DataFile::Records) => {
                "the path of a file, or a list with one for each eddy".to_owned()
            }
            Self::File(_) => "the path of a file".to_owned(),
        }
    }

    /// Parses a text such as `20 m/s`.
    fn read(&self, text: &str) -> Result<Value, Fault> {
        let parts = || -> Vec<&str> {
            let list = text.trim().trim_start_matches('[').trim_end_matches(']');
            list.split(',').map(|part| part.trim().trim_matches(['"', '\''])).collect()
        };
        let vector = |dimension: Dimension| match parts()[..] {
            [x, y, z] => {
                Ok(Value::Vector(Vec3::new(dimension.parse(x)?, dimension.parse(y)?, dimension.parse(z)?)))
            }
            _ => Err(Fault::wrong_type("a text", self.wanted())),
        };
        match self {
            Self::Quantity(dimension, _) => Ok(Value::Number(dimension.parse(text)?)),
            Self::Whole(..) => {
                text.trim().parse().map(Value::Whole).map_err(|_| Fault::wrong_type("a text", self.wanted()))
            }
            Self::Direction => match vector(Dimension::Ratio)? {
                Value::Vector(v) => Ok(Value::Vector(unit(v)?)),
                other => Ok(other),
            },
            Self::Point => vector(Dimension::Length),
            Self::Lengths => {
                let lengths: Result<_, _> =
                    parts().into_iter().map(|part| Dimension::Length.parse(part)).collect();
                Ok(Value::Numbers(lengths?))
            }
            Self::Choice(_) | Self::Text(_) | Self::Other(_) => Ok(Value::Text(text.to_owned())),
            Self::Switch => Ok(Value::Text(text.trim().to_owned())),
            Self::File(kind) if kind.is_word(text) => Ok(Value::Text(text.to_owned())),
            Self::File(_) => Ok(Value::Paths(vec![PathBuf::from(text)])),
        }
    }

    /// The value as text for people.
    pub fn pretty(&self, value: &Value) -> String {
        match (self, value) {
            (Self::Quantity(dimension, _), Value::Number(value)) => dimension.pretty(*value),
            (_, Value::Number(value)) => shortest(*value),
            (_, Value::Whole(value)) => value.to_string(),
            (Self::Switch, Value::Text(text)) => text.clone(),
            (_, Value::Text(text)) => format!("\"{}\"", spunlaid_ground::units::excerpt(text, 60)),
            (_, Value::Numbers(values)) => {
                let shown = |value: &f64| {
                    self.dimension().map_or_else(|| shortest(*value), |dimension| dimension.pretty(*value))
                };
                values.iter().map(shown).collect::<Vec<_>>().join(", ")
            }
            (_, Value::Vector(v)) => format!("[{}, {}, {}]", v.x, v.y, v.z),
            (_, Value::Paths(paths)) => listed(paths.iter().map(PathBuf::as_path)),
            (_, Value::Content(content)) => listed(content.paths().into_iter()),
        }
    }
}

/// What is wrong with a list of lengths, if anything.
fn lengths_fault(lengths: &[f64], kind: &Kind) -> Option<Fault> {
    if lengths.is_empty() {
        return Some(Fault::wrong_type("an empty list", kind.wanted()));
    }
    let of_one = Kind::Quantity(Dimension::Length, Sign::Positive);
    lengths.iter().find_map(|length| of_one.fault(&Value::Number(*length)))
}

fn listed<'a>(paths: impl Iterator<Item = &'a Path>) -> String {
    paths.map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ")
}

/// The unit vector along `v`. If `v` already is one apart from rounding, it is returned unchanged.
fn unit(v: Vec3<f64>) -> Result<Vec3<f64>, Fault> {
    if (v.norm() - 1.0).abs() <= 4.0 * f64::EPSILON {
        return Ok(v);
    }
    let largest = v.x.abs().max(v.y.abs()).max(v.z.abs());
    if largest == 0.0 {
        return Err(Fault::new("has length zero", "write a vector like [1.0, 0.0, 0.0] of any other length"));
    }
    // Dividing by the largest component first keeps the squares from overflowing or vanishing.
    let v = Vec3::new(v.x / largest, v.y / largest, v.z / largest);
    let norm = v.norm();
    Ok(Vec3::new(v.x / norm, v.y / norm, v.z / norm))
}
