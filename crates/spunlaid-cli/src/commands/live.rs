//! `spunlaid live`: fibres that fly on a page while their case is changed.

use crate::args::Live;
use crate::failure::Failure;

/// Serves the page until the program is ended.
#[cfg(feature = "live")]
pub(crate) fn live(live: &Live) -> Result<(), Failure> {
    use crate::say;
    use spunlaid::ground::FileKind;
    use spunlaid::input::{paper, read_case, read_text};

    let text = match &live.case {
        Some(path) => {
            // Its mistakes are reported as by all commands.
            read_case(path, &[])?;
            read_text(path, FileKind::Case)?
        }
        None => paper::TABLE1.to_owned(),
    };
    let start = spunlaid_live::Start { text, file: live.case.clone(), port: live.port.unwrap_or(0) };
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
    let message = "this program was built without the page on which fibres fly";
    Err(spunlaid::ground::Fault::new(message, "build it with the feature `live`, which is there by default")
        .into())
}
