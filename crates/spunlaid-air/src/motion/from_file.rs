//! What was read from a file beside the case.

use std::fmt;
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The content of a file, read once and shared by all fibres that fly in it.
pub struct FileContent<T> {
    file: Arc<File>,
    content: Arc<T>,
}

/// A file that was read.
#[derive(Clone)]
struct File {
    path: PathBuf,
    checksum: u32,
    /// Further files that this one names, relative to its folder.
    parts: Vec<PathBuf>,
}

impl<T> FileContent<T> {
    /// The content of the file at `path`; `checksum` distinguishes this content from another.
    pub fn new(path: PathBuf, checksum: u32, content: Arc<T>) -> Self {
        Self { file: Arc::new(File { path, checksum, parts: Vec::new() }), content }
    }

    /// The same content with the files that the file names, relative to its folder. The checksum is that of
    /// all of them.
    #[must_use]
    pub fn with_parts(mut self, parts: Vec<PathBuf>) -> Self {
        Arc::make_mut(&mut self.file).parts = parts;
        self
    }

    /// The same content with a checksum that distinguishes it from the content of the same file read in another way.
    ///
    /// * `way` – empty if there is only one
    #[must_use]
    pub fn read_as(mut self, way: &str) -> Self {
        let file = Arc::make_mut(&mut self.file);
        let mut sum = crc32fast::Hasher::new_with_initial(file.checksum);
        sum.update(way.as_bytes());
        file.checksum = sum.finalize();
        self
    }

    /// Path of the file.
    pub fn path(&self) -> &Path {
        &self.file.path
    }

    /// Further files that the file names, relative to its folder: those of a list of files.
    pub fn parts(&self) -> &[PathBuf] {
        &self.file.parts
    }

    /// Checksum of the file and its parts, and of the way in which they were read.
    pub fn checksum(&self) -> u32 {
        self.file.checksum
    }

    /// The same content at another path.
    pub fn moved_to(&self, path: PathBuf) -> Self {
        let mut moved = self.clone();
        Arc::make_mut(&mut moved.file).path = path;
        moved
    }
}

// A derived implementation would require `T: Clone`.
impl<T> Clone for FileContent<T> {
    fn clone(&self) -> Self {
        Self { file: Arc::clone(&self.file), content: Arc::clone(&self.content) }
    }
}

impl<T> Deref for FileContent<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.content
    }
}

/// Compares the contents; the folder of the file does not matter.
impl<T> PartialEq for FileContent<T> {
    fn eq(&self, other: &Self) -> bool {
        self.checksum() == other.checksum() && self.path().file_name() == other.path().file_name()
    }
}

/// Name and checksum stand for the content.
impl<T> fmt::Debug for FileContent<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.path().file_name().unwrap_or_default().to_string_lossy();
        write!(f, "{name}#{:08x}", self.checksum())
    }
}
