//! `spunlaid live`: fibres that fly on a page while their case is changed.

use crate::args::Live;
use crate::failure::Failure;
use crate::live::{Start, live as fly};
use crate::say;
use spunlaid::error::FileKind;
use spunlaid::input::{Unread, read_case, read_text};
use spunlaid::paper;

/// Serves the page until the program is ended.
pub(crate) fn live(live: &Live) -> Result<(), Failure> {
    let text = match &live.case {
        Some(path) => {
            // Its mistakes are reported as by all commands.
            read_case(path, &[]).or_else(Unread::without_flights)?;
            read_text(path, FileKind::Case)?
        }
        None => paper::TABLE1.to_owned(),
    };
    let start = Start { text, file: live.case.clone(), port: live.port.unwrap_or(0) };
    fly(start, |address, remark| {
        remark.iter().for_each(|remark| say::remark(false, remark));
        say::line(address);
        say::aside("Open this address in a browser of this machine; Ctrl-C ends the program.");
        if !live.no_open
            && let Err(error) = open::that_detached(address)
        {
            say::warning(&format!("no browser could be opened: {error}"));
        }
    })
}
