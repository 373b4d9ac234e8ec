//! What can be wrong with any file that is read: case, study, record, field, table.

use super::{FieldFault, ProfileFault, RecordFault, memory};
use crate::units::{Dimension, Printable, Wanted, excerpt, shortest};
use std::fmt::{self, Write};
use std::path::Path;

/// What a file is read as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// A case.
    Case,
    /// A study.
    Study,
    /// A velocity record.
    Record,
    /// A field of air.
    Field,
    /// A profile or a spectrum.
    Table,
}

impl FileKind {
    const fn name(self) -> &'static str {
        match self {
            Self::Case => "case file",
            Self::Study => "study file",
            Self::Record => "velocity record",
            Self::Field => "field of air",
            Self::Table => "table",
        }
    }

    const fn formats(self) -> &'static str {
        match self {
            Self::Case | Self::Study => "UTF-8 text",
            Self::Record => "CSV in UTF-8 or Latin-1, or Parquet",
            Self::Field => "VTK (.vtu, .vti, .vts, .vtr, .vtk) or a table (.csv)",
            Self::Table => "CSV in UTF-8 or Latin-1",
        }
    }

    fn not_there(self) -> String {
        match self {
            Self::Case => "`spunlaid new` writes a case to start from".to_owned(),
            Self::Study => "`spunlaid help sweep` shows what a study looks like".to_owned(),
            Self::Table => "a path in a case counts from the folder of the case file".to_owned(),
            Self::Record | Self::Field => format!("name a {}, {}", self.name(), self.formats()),
        }
    }
}

/// Where in a file, or among what was given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FilePlace {
    /// Nowhere in particular.
    #[default]
    Whole,
    /// A line of a text file, from 1.
    Line(u64),
    /// A row of a binary table, from 1.
    Row(u64),
    /// A byte of a file, from 1.
    Byte(u64),
    /// A point, from 1.
    Point(u64),
    /// A cell of a mesh, from 1.
    Cell(u64),
}

/// A reason why a file cannot be used: reads as `wire.csv:12: column u_m_s: "x" is not a number…`.
#[derive(Clone, Debug, PartialEq)]
pub struct FileError {
    /// Name of the file, as given; empty where there is none.
    pub file: Box<str>,
    /// Where in it.
    pub place: FilePlace,
    /// The column or array, where one is to blame: `column u_m_s`.
    pub part: Option<Box<str>>,
    /// What is wrong.
    pub fault: FileFault,
}

impl FileError {
    /// The same, found at this place unless a place is known already.
    #[must_use]
    pub(crate) fn at(mut self, place: FilePlace) -> Self {
        if self.place == FilePlace::Whole {
            self.place = place;
        }
        self
    }

    /// The same, found in this array unless a part is known already.
    #[must_use]
    pub(crate) fn array(mut self, name: &str) -> Self {
        self.part.get_or_insert_with(|| excerpt(name, 40).into());
        self
    }

    /// The same, found in this column unless a part is known already.
    #[must_use]
    pub(crate) fn column(mut self, name: &str) -> Self {
        self.part.get_or_insert_with(|| format!("column {}", excerpt(name, 40)).into());
        self
    }

    /// The same, found in this file.
    #[must_use]
    pub(crate) fn file(self, file: &str) -> Self {
        Self { file: excerpt(file, 1000).into(), ..self }
    }

    /// The same, found in the file at this path.
    #[must_use]
    pub(crate) fn path(self, path: &Path) -> Self {
        self.file(&path.display().to_string())
    }
}

impl<F: Into<FileFault>> From<F> for FileError {
    fn from(fault: F) -> Self {
        Self { file: Box::default(), place: FilePlace::Whole, part: None, fault: fault.into() }
    }
}

impl std::error::Error for FileError {}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut f = Printable(f);
        f.write_str(&self.file)?;
        if let FilePlace::Line(line) = self.place {
            write!(f, ":{line}")?;
        }
        if !self.file.is_empty() {
            f.write_str(": ")?;
        }
        match self.place {
            FilePlace::Whole | FilePlace::Line(_) => {}
            FilePlace::Row(row) => write!(f, "row {row}: ")?,
            FilePlace::Byte(byte) => write!(f, "byte {byte}: ")?,
            FilePlace::Point(point) => write!(f, "point {point}: ")?,
            FilePlace::Cell(cell) => write!(f, "cell {cell}: ")?,
        }
        if let Some(part) = &self.part {
            write!(f, "{part}: ")?;
        }
        write!(f, "{}", self.fault)
    }
}

/// What is wrong with a file, and the way out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FileFault {
    /// No such file.
    #[error("there is no such file; {}", .0.not_there())]
    NotThere(FileKind),
    /// A folder.
    #[error("is a folder; name the {} in it", .0.name())]
    IsFolder(FileKind),
    /// The system does not let it be read.
    #[error("cannot be read: {message}")]
    Unreadable {
        /// What the system says.
        message: String,
    },
    /// Larger than any such file.
    #[error("is larger than {}, which no {} is; is it the right file?", memory(*most as f64), kind.name())]
    TooLarge {
        /// What it was read as.
        kind: FileKind,
        /// The largest size read [bytes].
        most: u64,
    },
    /// A binary file, or text in two-byte characters.
    #[error("is not text; a {} is {}", .0.name(), .0.formats())]
    NotText(FileKind),
    /// Text in another encoding.
    #[error(
        "byte {byte:#04x} (number {position} of the file) is not UTF-8 text; save the file as UTF-8, or write um for µm"
    )]
    NotUtf8 {
        /// The first byte that is not UTF-8.
        byte: u8,
        /// Which byte of the file it is, from 1.
        position: usize,
    },
    /// A line without end.
    #[error(
        "this line is longer than {most} bytes, which no row of a table is; end each row with a line break"
    )]
    LineTooLong {
        /// The longest line read [bytes].
        most: usize,
    },
    /// The file ends before its time.
    #[error("ends where {wanted} should follow; is the file cut off?")]
    CutOff {
        /// What should follow.
        wanted: &'static str,
    },
    /// No rows of data.
    #[error("holds no rows of numbers; is it the right file?")]
    NoRows,
    /// A table without names.
    #[error("has no line of names above its numbers; write one, like {example}")]
    NoHeader {
        /// A line that would do.
        example: &'static str,
    },
    /// A row with cells missing or too many.
    #[error("this row has {found} cells where {wanted} are needed; {}", if found < wanted { "is the file cut off here?" } else { "do decimal commas meet a comma between cells?" })]
    Cells {
        /// Cells there are.
        found: usize,
        /// Cells needed.
        wanted: usize,
    },
    /// A text that is no number.
    #[error("\"{text}\" is not a number; write one, or leave the cell empty where a value is missing")]
    NotANumber {
        /// As written.
        text: String,
    },
    /// An infinite number.
    #[error("\"{text}\" is not finite; leave the cell empty where a value is missing")]
    NotFinite {
        /// As written.
        text: String,
    },
    /// Decimal points and decimal commas in one file.
    #[error(
        "\"{text}\" has the other decimal sign than the rows before; write all numbers with a point, or all with a comma"
    )]
    MixedDecimals {
        /// As written.
        text: String,
    },
    /// Values that must increase and do not.
    #[error("goes from {} to {}; it must increase", shortest(*before), shortest(*after))]
    NotIncreasing {
        /// A value.
        before: f64,
        /// The next one.
        after: f64,
    },
    /// A column without a unit.
    #[error("holds {} and has no unit; write the unit into its name, like {example}", dimension.name())]
    NoUnit {
        /// What it measures.
        dimension: Dimension,
        /// A header that would do.
        example: &'static str,
    },
    /// A unit of something else, or one that is not known.
    #[error("has the unit \"{unit}\"; {} is needed", Wanted(*wanted))]
    WrongUnit {
        /// As written.
        unit: String,
        /// What is needed.
        wanted: Dimension,
    },
    /// Something that only a velocity record has.
    #[error(transparent)]
    Record(#[from] RecordFault),
    /// Something that only a field has.
    #[error(transparent)]
    Field(#[from] FieldFault),
    /// Something that only a profile or a spectrum has.
    #[error(transparent)]
    Profile(#[from] ProfileFault),
}

impl FileFault {
    /// A cell that is no number.
    pub(crate) fn not_a_number(text: &str) -> Self {
        Self::NotANumber { text: excerpt(text, 40) }
    }
}
