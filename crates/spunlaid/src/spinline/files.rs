//! The files that a spinline names.

use super::{PolymerSource, Spinline, Surroundings};
use crate::air::FromFile;
use std::path::{Path, PathBuf};

impl Spinline {
    /// The files that it names, each with the files that this one names: constants of a polymer, air along the line.
    pub fn files(&self) -> Vec<(&Path, &[PathBuf])> {
        let polymer = match &self.polymer {
            PolymerSource::Known(_) => None,
            PolymerSource::File(file) => Some((file.path(), file.parts())),
        };
        let air = match &self.air {
            Surroundings::Table(table) => Some((table.path(), table.parts())),
            Surroundings::Uniform(_) | Surroundings::Field { .. } | Surroundings::Behind(_) => None,
        };
        polymer.into_iter().chain(air).collect()
    }

    /// The same spinline with its files at other paths.
    #[must_use]
    pub fn with_files_at(&self, place: impl Fn(&Path) -> PathBuf) -> Self {
        fn moved<T>(file: &mut FromFile<T>, place: impl Fn(&Path) -> PathBuf) {
            *file = file.moved_to(place(file.path()));
        }
        let mut spinline = self.clone();
        if let PolymerSource::File(file) = &mut spinline.polymer {
            moved(file, &place);
        }
        if let Surroundings::Table(table) = &mut spinline.air {
            moved(table, &place);
        }
        spinline
    }
}
