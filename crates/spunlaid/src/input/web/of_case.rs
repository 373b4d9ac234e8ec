//! Keys of a web that are those of its filament.

use crate::fibre::case::keys::{self, CASE};
use crate::simulation::layers::full_names::without_numbers;
use crate::simulation::layers::keys::WEB;

/// Whether a key is one of the cases. Both have some: where a case is flown, it says them.
pub(crate) fn is_of_case(name: &str, flies: bool) -> bool {
    keys::find(name).is_some() && (flies || WEB.find(name).is_none())
}

/// Why a key of a filament cannot be set or varied, in words.
pub(crate) fn flies_none() -> String {
    "is a key of a filament that flies, and this web flies none".to_owned()
}

/// Whether a key that is set takes the place of another one.
pub(crate) fn replaces(key: &str, other: &str) -> bool {
    let plain = |full: &str| {
        let name = without_numbers(full);
        name.strip_prefix("layer.").map_or(name.clone(), ToOwned::to_owned)
    };
    let (of_key, of_other) = (plain(key), plain(other));
    key == other || WEB.gives(&of_key, &of_other) || CASE.gives(&of_key, &of_other)
}
