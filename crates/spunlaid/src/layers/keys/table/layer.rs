//! The key of the table `[layer]`.

use super::super::access::{Access, WebKey, layer, layer_mut};
use crate::case::keys::Kind;
use crate::case::keys::row::{at, key};

/// In the order of the file.
pub(super) const KEYS: &[WebKey] = &[key("layer.name", Kind::Text("first beam"))
    .access(at!(layer, layer_mut, name))
    .follows("the layer's number")
    .meaning(
        "Name of a layer. A web of several layers has a `[[layer]]` for each beam, with its own \
             `[layer.line]`, `[layer.laydown]` and `[layer.fibre]` in place of the three tables below; \
             their basis weights add up. Tables of a filament that stand above the layers are those of all.",
    )];
