//! The files that the filaments of a web name.

use super::{LaydownSource, WebSpec};
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl WebSpec {
    /// The files from which the cases that it flies were read, each with the parts that it names, relative to
    /// its folder.
    pub fn files(&self) -> Vec<(&Path, &[PathBuf])> {
        let flown = self.layers.iter().filter_map(|layer| match &layer.source {
            LaydownSource::Case { case, .. } => Some(case),
            _ => None,
        });
        flown.flat_map(|case| case.files()).collect()
    }

    /// The same web with these files at other paths.
    pub fn with_files_at(&self, place: impl Fn(&Path) -> PathBuf) -> Self {
        let mut web = self.clone();
        for layer in &mut web.layers {
            if let LaydownSource::Case { case, .. } = &mut layer.source {
                *case = Arc::new(case.with_files_at(&place));
            }
        }
        web
    }
}
