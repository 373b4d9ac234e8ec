//! Errors that any file can have: case, study, record, field, table.

use super::{FieldFault, ProfileFault, RecordFault, ScanFault, memory};
use crate::units::{Dimension, Printable, Wanted, excerpt, shortest};
use std::fmt::{self, Write};
use std::path::Path;

/// The kind of a file that is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// A case.
    Case,
    /// A study.
    Study,
    /// A web.
    Web,
    /// A velocity record.
    Record,
    /// A field of air.
    Field,
    /// A profile or a spectrum.
    Table,
    /// A scan or a map of a web.
    Scan,
}

impl FileKind {
    const fn name(self) -> &'static str {
        match self {
            Self::Case => "case file",
            Self::Study => "study file",
            Self::Web => "file of a web",
            Self::Record => "velocity record",
            Self::Field => "field of air",
            Self::Table => "table",
            Self::Scan => "scan of a web",
        }
    }

    const fn formats(self) -> &'static str {
        match self {
            Self::Case | Self::Study | Self::Web => "UTF-8 text",
            Self::Record => "CSV in UTF-8 or Latin-1, or Parquet",
            Self::Field => {
                "VTK (.vtu, .vti, .vts, .vtr, .vtk), a list of its files (.vtm, .pvtu) or a table (.csv)"
            }
            Self::Table => "CSV in UTF-8 or Latin-1",
            Self::Scan => "a picture (PNG or TIFF), a NumPy array (.npy) or a table (.csv)",
        }
    }

    fn not_there(self) -> String {
        match self {
            Self::Case => "name a case file".to_owned(),
            Self::Study => "name a study file".to_owned(),
            Self::Web => "name the file of a web".to_owned(),
            Self::Table => "a path in a case counts from the folder of the case file".to_owned(),
            Self::Record | Self::Field | Self::Scan => format!("name a {}, {}", self.name(), self.formats()),
        }
    }
}

/// A position in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FilePlace {
    /// The whole file.
    #[default]
    Whole,
    /// A line of a text file, counted from 1.
    Line(u64),
    /// A row of a binary table, counted from 1.
    Row(u64),
    /// A byte of a file, counted from 1.
    Byte(u64),
    /// A point, counted from 1.
    Point(u64),
    /// A cell of a mesh, counted from 1.
    Cell(u64),
}

/// The reason why a file cannot be used. It is shown as `wire.csv:12: column u_m_s: "x" is not a number…`.
#[derive(Clone, Debug, PartialEq)]
pub struct FileError {
    /// Name of the file, as given. Empty if there is no file.
    pub file: Box<str>,
    /// The position in it.
    pub place: FilePlace,
    /// The column or array that is wrong, if it is known: `column u_m_s`.
    pub part: Option<Box<str>>,
    /// What is wrong.
    pub fault: FileFault,
}

impl FileError {
    /// Adds a place, unless one is known already.
    #[must_use]
    pub(crate) fn at(mut self, place: FilePlace) -> Self {
        if self.place == FilePlace::Whole {
            self.place = place;
        }
        self
    }

    /// Adds the name of an array, unless a part is known already.
    #[must_use]
    pub(crate) fn array(mut self, name: &str) -> Self {
        self.part.get_or_insert_with(|| excerpt(name, 40).into());
        self
    }

    /// Adds the name of a column, unless a part is known already.
    #[must_use]
    pub(crate) fn column(mut self, name: &str) -> Self {
        self.part.get_or_insert_with(|| format!("column {}", excerpt(name, 40)).into());
        self
    }

    /// Adds the name of the file.
    #[must_use]
    pub(crate) fn file(self, file: &str) -> Self {
        Self { file: excerpt(file, 1000).into(), ..self }
    }

    /// Adds the path of the file.
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

/// What is wrong with a file, and how to correct it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FileFault {
    /// There is no such file.
    #[error("there is no such file; {}", .0.not_there())]
    NotThere(FileKind),
    /// The path is a folder.
    #[error("is a folder; name the {} in it", .0.name())]
    IsFolder(FileKind),
    /// The operating system cannot read the file.
    #[error("cannot be read: {message}")]
    Unreadable {
        /// Message of the operating system.
        message: String,
    },
    /// The file is too large.
    #[error("is larger than {}, the limit for a {}; is it the right file?", memory(*most as f64), kind.name())]
    TooLarge {
        /// The kind of file that was expected.
        kind: FileKind,
        /// The largest size that is read [bytes].
        most: u64,
    },
    /// The file is binary, or is text in two-byte characters.
    #[error("is not text; a {} is {}", .0.name(), .0.formats())]
    NotText(FileKind),
    /// The text has another encoding.
    #[error(
        "byte {byte:#04x} (number {position} of the file) is not UTF-8 text; save the file as UTF-8, or write um for µm"
    )]
    NotUtf8 {
        /// The first byte that is not UTF-8.
        byte: u8,
        /// Its position in the file, counted from 1.
        position: usize,
    },
    /// A line is too long.
    #[error(
        "this line is longer than {most} bytes, the limit for a row of a table; end each row with a line break"
    )]
    LineTooLong {
        /// The longest line that is read [bytes].
        most: usize,
    },
    /// The file ends too early.
    #[error("ends where {wanted} should follow; is the file cut off?")]
    CutOff {
        /// What should follow.
        wanted: &'static str,
    },
    /// The table has no rows.
    #[error("contains no rows of numbers; is it the right file?")]
    NoRows,
    /// The table has no header.
    #[error("has no line of names above its numbers; write one, like {example}")]
    NoHeader {
        /// An example line.
        example: &'static str,
    },
    /// A row has too few or too many cells.
    #[error("this row has {found} cells and needs {wanted}; {}", if found < wanted { "is the file cut off here?" } else { "are both decimals and cells separated by commas?" })]
    Cells {
        /// Number of cells found.
        found: usize,
        /// Number of cells needed.
        wanted: usize,
    },
    /// A cell is not a number.
    #[error("\"{text}\" is not a number; write one, or leave the cell empty where a value is missing")]
    NotANumber {
        /// As written.
        text: String,
    },
    /// A cell is an infinite number.
    #[error("\"{text}\" is not finite; leave the cell empty where a value is missing")]
    NotFinite {
        /// As written.
        text: String,
    },
    /// The file has both decimal points and decimal commas.
    #[error(
        "\"{text}\" has another decimal sign than the rows above; write all numbers with a point, or all with a comma"
    )]
    MixedDecimals {
        /// As written.
        text: String,
    },
    /// Values that must increase do not.
    #[error("goes from {} to {}; it must increase", shortest(*before), shortest(*after))]
    NotIncreasing {
        /// A value.
        before: f64,
        /// The next one.
        after: f64,
    },
    /// A column has no unit.
    #[error("contains {} and has no unit; write the unit in its name, like {example}", dimension.name())]
    NoUnit {
        /// What it measures.
        dimension: Dimension,
        /// An example header.
        example: &'static str,
    },
    /// A unit is unknown or belongs to another quantity.
    #[error("has the unit \"{unit}\"; {} is needed", Wanted(*wanted))]
    WrongUnit {
        /// As written.
        unit: String,
        /// What is needed.
        wanted: Dimension,
    },
    /// A fault of a velocity record.
    #[error(transparent)]
    Record(#[from] RecordFault),
    /// A fault of a field.
    #[error(transparent)]
    Field(#[from] FieldFault),
    /// A fault of a profile or a spectrum.
    #[error(transparent)]
    Profile(#[from] ProfileFault),
    /// A fault of a scan of a web.
    #[error(transparent)]
    Scan(#[from] ScanFault),
}

impl FileFault {
    /// The fault of a cell that is not a number.
    pub(crate) fn not_a_number(text: &str) -> Self {
        Self::NotANumber { text: excerpt(text, 40) }
    }
}
