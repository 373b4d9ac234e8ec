//! `spunlaid keys`: explains the keys of a case, of a web and of a study.

use crate::args::Keys;
use crate::failure::Failure;
use crate::say;
use spunlaid::ground::FileKind;
use spunlaid_results::page::keys::{keys_page, keys_text};

pub(crate) fn keys(arguments: &Keys) -> Result<(), Failure> {
    let word = arguments.pattern.as_deref().unwrap_or_default();
    let of = match arguments {
        Keys { web: true, .. } => Some(FileKind::Web),
        Keys { study: true, .. } => Some(FileKind::Study),
        _ => None,
    };
    say::text(&match arguments.markdown {
        true => keys_page(word, of)?,
        false => keys_text(word, of, say::columns())?,
    });
    Ok(())
}
