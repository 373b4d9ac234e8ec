//! What a file describes.

use super::{document, file, spinline};
use crate::fibre::case::keys;
use crate::ground::FileKind;
use std::path::Path;
use toml::de::DeTable;

/// What a file describes by its keys and tables: a study, a web, a spinline alone, or else a case. A file
/// that cannot be read counts as a case.
pub fn kind_of(path: &Path) -> FileKind {
    let Ok(text) = file::read(path, FileKind::Case) else { return FileKind::Case };
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
