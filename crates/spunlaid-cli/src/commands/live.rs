//! `spunlaid live`: fibres that fly on a page while their case is changed, or the web of a line whose knobs are turned.

use crate::args::Live;
use crate::failure::Failure;
#[cfg(feature = "live")]
use spunlaid::ground::{Fault, FileKind};
#[cfg(feature = "live")]
use spunlaid::input::kind_of;
#[cfg(feature = "live")]
use std::path::Path;

/// Serves the page until the program is ended.
#[cfg(feature = "live")]
pub(crate) fn live(live: &Live) -> Result<(), Failure> {
    use crate::say;
    use spunlaid::input::{paper, read_case, read_text};
    use spunlaid_live::{Start, Subject};

    let (subject, text) = match &live.case {
        Some(path) if kind_of(path) == FileKind::Web => (Subject::Line, read_text(path, FileKind::Web)?),
        Some(path) => {
            has_page(path)?;
            // Its mistakes are reported as by all commands.
            read_case(path, &[])?;
            (Subject::Fibre, read_text(path, FileKind::Case)?)
        }
        None => (Subject::Fibre, paper::TABLE1.to_owned()),
    };
    if live.case.is_none() {
        say::aside(
            "The page of a line, with its web: spunlaid new --web line.toml, then spunlaid live line.toml",
        );
    }
    let start = Start { subject, text, file: live.case.clone(), port: live.port.unwrap_or(0) };
    let ready = |address: &str, remark: Option<&str>| {
        remark.iter().for_each(|remark| say::remark(false, remark));
        say::line(address);
        say::aside("Open this address in a browser of this machine; Ctrl-C ends the program.");
        if !live.no_open
            && let Err(error) = open_browser(address)
        {
            say::warning(&format!("no browser could be opened: {error}"));
        }
    };
    Ok(spunlaid_live::live(start, ready)?)
}

/// Refuses files of which there is no page.
#[cfg(feature = "live")]
fn has_page(path: &Path) -> Result<(), Failure> {
    let kind = kind_of(path);
    let command = match kind {
        FileKind::Study => "sweep",
        FileKind::Spinline => "spin",
        _ => return Ok(()),
    };
    let message = format!("{} is a {}, and a page shows a case or a line", path.display(), kind.name());
    let remedy = format!("`spunlaid {command} {}` computes it", path.display());
    Err(Fault::new(message, remedy).into())
}

/// Opens a page in the browser. Every user of the machine sees the arguments of a command, and the address has the
/// token. So the browser gets a file that only this user may read, which leads there.
#[cfg(feature = "live")]
fn open_browser(address: &str) -> std::io::Result<()> {
    use std::io::Write;
    /// Time in which a browser has read the file.
    const READ: std::time::Duration = std::time::Duration::from_secs(60);
    let mut file = tempfile::Builder::new().prefix("spunlaid-live-").suffix(".html").tempfile()?;
    write!(file, "<!doctype html><meta charset=utf-8><meta http-equiv=refresh content='0;url={address}'>")?;
    open::that_detached(file.path())?;
    std::thread::spawn(move || {
        std::thread::sleep(READ);
        drop(file);
    });
    Ok(())
}

/// Says that this program has no page.
#[cfg(not(feature = "live"))]
pub(crate) fn live(_: &Live) -> Result<(), Failure> {
    let message = "this program was built without the live page";
    Err(spunlaid::ground::Fault::new(message, "build it with the feature `live`, which is there by default")
        .into())
}
