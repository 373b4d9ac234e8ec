//! What a file describes.

use super::{document, file, spinline};
use crate::case::keys;
use crate::error::FileKind;
use std::path::Path;
use toml::de::DeTable;

/// What a file describes by its keys and tables: a study, a web, a spinline alone, or else a case. A file that cannot be read
/// counts as a case.
pub fn kind_of(path: &Path) -> FileKind {
    let Ok(text) = file::read(path, FileKind::Case) else { return FileKind::Case };
    let Ok(root) = DeTable::parse(&text) else { return FileKind::Case };
    let has = |name: &str| root.get_ref().contains_key(name);
    let is_table = |name: &str| root.get_ref().get(name).is_some_and(|value| value.get_ref().is_table());
    let is_spinline = || {
        document::read(&keys::CASE, &text, "", &[])
            .is_ok_and(|key_values| spinline::is_spinline_alone(&key_values))
    };
    if has("vary") || has("design") {
        FileKind::Study
    } else if ["layer", "laydown", "line"].into_iter().any(has) || is_table("web") {
        FileKind::Web
    } else if is_spinline() {
        FileKind::Spinline
    } else {
        FileKind::Case
    }
}
