//! The files that the filaments of a web name.

use super::{LaydownSource, WebSpec};
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl WebSpec {
    /// The files from which the cases that it flies were read, each with the parts that it names, relative to its folder.
    pub fn files(&self) -> Vec<(&Path, &[PathBuf])> {
        let of_layer = |source| match source {
            &LaydownSource::Case { ref case, .. } => case.files(),
            _ => Vec::new(),
        };
        self.layers.iter().flat_map(|layer| of_layer(&layer.source)).collect()
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
