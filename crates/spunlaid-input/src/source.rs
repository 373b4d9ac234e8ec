//! Where a text comes from that is read: a file, or a text in memory.

use super::file::read;
use super::{Overrides, Resources};
use spunlaid_ground::{Error, FileKind};
use std::path::Path;

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
