//! `spunlaid man`.

use crate::args::{Arguments, Man};
use crate::failure::Failure;
use crate::say;
use clap::CommandFactory;
use spunlaid::error::Error;
use std::fs;

/// Writes a manual page for each command.
pub(crate) fn man(man: &Man) -> Result<(), Failure> {
    let folder = &man.folder;
    let written =
        fs::create_dir_all(folder).and_then(|()| clap_mangen::generate_to(Arguments::command(), folder));
    written.map_err(Error::unwritable(folder))?;
    say::line(&format!("wrote the manual pages to {}; man spunlaid shows the first", folder.display()));
    Ok(())
}
