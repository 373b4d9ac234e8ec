//! Where a text comes from that is read, a file or a text in memory, and what it describes.

use super::file::read;
use super::{Overrides, Resources, document, spinline};
use crate::fibre::case::keys;
use crate::ground::{Error, FileKind};
use std::path::Path;
use toml::de::DeTable;

/// What is read: a file by its path, or a text and its name, `(text, name)`. Messages call it by that, and files
/// that it names are looked for beside it.
#[derive(Clone, Copy, Debug)]
pub enum Source<'a> {
    /// The path of a file.
    File(&'a Path),
    /// A text, and its name.
    Text(&'a str, &'a str),
}

impl<'a, P: AsRef<Path> + ?Sized> From<&'a P> for Source<'a> {
    fn from(path: &'a P) -> Self {
        Self::File(path.as_ref())
    }
}

impl<'a, T: AsRef<str> + ?Sized, N: AsRef<str> + ?Sized> From<(&'a T, &'a N)> for Source<'a> {
    fn from((text, name): (&'a T, &'a N)) -> Self {
        Self::Text(text.as_ref(), name.as_ref())
    }
}

impl Source<'_> {
    /// Does something with the text, its name, and the resources of what is set.
    pub(super) fn open<T>(
        self,
        kind: FileKind,
        set: Overrides<'_>,
        read_text: impl FnOnce(&str, &str, &Resources) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let own = Resources::default();
        let resources = set.resources.unwrap_or(&own);
        match self {
            Self::File(path) => read_text(&read(path, kind)?, &path.display().to_string(), resources),
            Self::Text(text, name) => read_text(text, name, resources),
        }
    }
}

/// What a file describes by its keys and tables: a study, a web, a spinline alone, or else a case. A file
/// that cannot be read counts as a case.
pub fn kind_of(path: &Path) -> FileKind {
    let Ok(text) = read(path, FileKind::Case) else { return FileKind::Case };
    let Ok(root) = DeTable::parse(&text) else { return FileKind::Case };
    let has = |name: &str| root.get_ref().contains_key(name);
    let is_spinline = || {
        document::read(&keys::CASE, &text, "", &[])
            .is_ok_and(|key_values| spinline::is_spinline_alone(&key_values))
    };
    if has("vary") || has("design") {
        FileKind::Study
    } else if document::is_of_web(&text) {
        FileKind::Web
    } else if is_spinline() {
        FileKind::Spinline
    } else {
        FileKind::Case
    }
}
