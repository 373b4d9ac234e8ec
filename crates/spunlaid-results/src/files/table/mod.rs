//! Tables as files: what a column holds, and the formats in which rows are written.

mod csv;
pub(crate) mod parquet;

use crate::Failure;
use std::path::PathBuf;

/// A format of tables: a file beside this one, which says how rows are written.
#[derive(Debug)]
pub struct TableFormat {
    /// The ending of its files.
    pub name: &'static str,
    /// Begins a table at its present path, whose final path is reported in messages.
    create: fn(PathBuf, PathBuf, &[Column]) -> Begun,
}

/// A table that has been begun.
type Begun = Result<Box<dyn Rows>, Failure>;

/// All formats.
static FORMATS: [TableFormat; 3] = [csv::FORMAT, parquet::FORMAT, csv::WITH_TABS];

/// The folder of tables in formats that are asked for besides the usual ones.
pub const TABLES: &str = "tables";

/// Takes the rows of a table that is being written.
trait Rows {
    fn add(&mut self, row: &[Value]) -> Result<(), Failure>;

    /// Writes what is left. The file survives a power cut then.
    fn finish(self: Box<Self>) -> Result<(), Failure>;
}

/// A column of a table.
#[derive(Clone, Debug)]
pub struct Column {
    /// Its name with the unit.
    pub name: String,
    /// Its values.
    pub holds: ColumnValues,
}

/// The values of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnValues {
    /// Whole numbers.
    Whole,
    /// Words.
    Text,
    /// Numbers, which may be NaN.
    Number,
    /// Finite numbers; other values are missing.
    Optional,
}

/// A value in a row.
#[derive(Clone, Copy, Debug)]
pub enum Value {
    /// In a column of whole numbers.
    Whole(i64),
    /// In a column of numbers; NaN counts as missing.
    Number(f64),
    /// In a column of words.
    Word(&'static str),
}

/// A table that is being written, in each of its formats. Rows are written as they come, so that memory does
/// not grow with their number.
pub struct Table(Vec<Box<dyn Rows>>);

impl TableFormat {
    /// The format of this name.
    ///
    /// # Errors
    /// What to write, if there is none.
    pub fn named(name: &str) -> Result<&'static Self, String> {
        let known = FORMATS.iter().find(|format| format.name.eq_ignore_ascii_case(name.trim()));
        known.ok_or_else(|| format!("write one of {}, or several of them with commas", Self::names()))
    }

    /// The names of all formats.
    pub fn names() -> String {
        FORMATS.each_ref().map(|format| format.name).join(", ")
    }
}

impl Table {
    /// Begins a table, in the formats in which it is always written and in those that are asked for.
    ///
    /// * `name` – of its files, without the ending
    /// * `begin` – begins a file: its present and its final path
    pub(super) fn create(
        name: &str,
        usual: &[&str],
        asked: &[&'static TableFormat],
        columns: &[Column],
        begin: impl Fn(&str) -> Result<(PathBuf, PathBuf), Failure>,
    ) -> Result<Self, Failure> {
        let usual = FORMATS.iter().filter(|format| usual.contains(&format.name));
        let usual = usual.map(|format| (format, format!("{name}.{}", format.name)));
        let asked = asked.iter().map(|format| (*format, format!("{TABLES}/{name}.{}", format.name)));
        let create = |(format, file): (&TableFormat, String)| {
            let (now, later) = begin(&file)?;
            (format.create)(now, later, columns)
        };
        usual.chain(asked).map(create).collect::<Result<_, _>>().map(Self)
    }

    /// Adds a row.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn add(&mut self, row: &[Value]) -> Result<(), Failure> {
        self.0.iter_mut().try_for_each(|rows| rows.add(row))
    }

    /// Writes what is left.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn finish(self) -> Result<(), Failure> {
        self.0.into_iter().try_for_each(Rows::finish)
    }
}

/// A column of whole numbers.
pub fn whole(name: impl Into<String>) -> Column {
    Column { name: name.into(), holds: ColumnValues::Whole }
}

/// A column of numbers, none of which is missing.
pub fn number(name: impl Into<String>) -> Column {
    Column { name: name.into(), holds: ColumnValues::Number }
}
