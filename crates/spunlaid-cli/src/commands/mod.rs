//! What the program can be asked to do.

mod check;
mod run;
mod small;

pub(crate) use check::check;
pub(crate) use run::run;
pub(crate) use small::{completions, new};
