//! Faults that any file can have: case, study, record, field, table, scan.

use super::{Fault, memory, shortest};
use std::fmt;

named! {
    /// The kind of a file that is read.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum FileKind {
        /// A case.
        Case = "case file",
        /// A study.
        Study = "study file",
        /// A web.
        Web = "file of a web",
        /// A spinline.
        Spinline = "file of a spinline",
        /// A velocity record.
        Record = "velocity record",
        /// A field of air.
        Field = "field of air",
        /// A profile or a spectrum.
        Table = "table",
        /// A scan or a map of a web.
        Scan = "scan of a web",
    }
}

impl FileKind {
    const fn formats(self) -> &'static str {
        match self {
            Self::Case | Self::Study | Self::Web | Self::Spinline => "UTF-8 text",
            Self::Record => "CSV in UTF-8 or Latin-1, or Parquet",
            Self::Field => {
                "VTK (.vtu, .vti, .vts, .vtr, .vtk), a list of its files (.vtm, .pvtu) or a table (.csv)"
            }
            Self::Table => "CSV in UTF-8 or Latin-1",
            Self::Scan => "an image (PNG or TIFF), a NumPy array (.npy) or a table (.csv)",
        }
    }

    /// There is no such file.
    pub(crate) fn not_there(self) -> Fault {
        let (remedy, option) = match self {
            Self::Case => ("name a case file".to_owned(), "`spunlaid new` writes one"),
            Self::Study => ("name a study file".to_owned(), "`spunlaid help sweep` shows one"),
            Self::Web => ("name the file of a web".to_owned(), "`spunlaid help web` shows one"),
            Self::Spinline => ("name the file of a spinline".to_owned(), "`spunlaid help spin` shows one"),
            Self::Table => ("a path in a case counts from the folder of the case file".to_owned(), ""),
            Self::Record | Self::Field | Self::Scan => {
                (format!("name a {}, {}", self.name(), self.formats()), "")
            }
        };
        Fault::new("there is no such file", remedy).option(option)
    }

    /// The path is a folder.
    pub(crate) fn is_folder(self) -> Fault {
        Fault::new("is a folder", format!("name the {} in it", self.name()))
    }

    /// The file is larger than `most` bytes.
    pub(crate) fn too_large(self, most: u64) -> Fault {
        let (most, name) = (memory(most as f64), self.name());
        Fault::new(format!("is larger than {most}, the limit for a {name}"), "is it the right file?")
    }

    /// The file is binary, or is text in two-byte characters.
    pub(crate) fn not_text(self) -> Fault {
        Fault::new("is not text", format!("a {} is {}", self.name(), self.formats()))
    }
}

impl Fault {
    /// The operating system cannot read the file.
    pub(crate) fn unreadable(source: &std::io::Error) -> Self {
        Self::plain(format!("cannot be read: {source}"))
    }

    /// The file is of another kind.
    ///
    /// * `found` – what it seems to be, with an article
    pub fn format(found: impl fmt::Display, remedy: &'static str) -> Self {
        Self::new(format!("is {found}"), remedy)
    }

    /// The file ends too early.
    ///
    /// * `wanted` – what should follow
    pub fn cut_off(wanted: &str) -> Self {
        Self::new(format!("ends where {wanted} should follow"), "is the file cut off?")
    }

    /// The table has no rows.
    pub fn no_rows() -> Self {
        Self::new("contains no rows of numbers", "is it the right file?")
    }

    /// The table has no header.
    ///
    /// * `example` – a line that would do
    pub fn no_header(example: &str) -> Self {
        Self::new("has no line of names above its numbers", format!("write one, like {example}"))
    }

    /// A cell is an infinite number.
    pub fn infinite(text: &str) -> Self {
        Self::new(format!("\"{text}\" is not finite"), "leave the cell empty where a value is missing")
    }

    /// Values that must increase do not.
    pub fn not_increasing(before: f64, after: f64) -> Self {
        Self::new(format!("goes from {} to {}", shortest(before), shortest(after)), "it must increase")
    }
}
