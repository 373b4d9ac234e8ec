//! A page on which fibres fly, and change while they do: what `spunlaid live` serves.
//!
//! ```text
//! page ←→ server (loopback only, token) ← board: frames, statistics ← session: clock → fibres → measured
//!                                        → messages                 → (a thread of its own)
//! ```
//!
//! ```text
//! message                     what pages ask and are answered
//! document, settings, save    the case as text; what can be changed; files
//! fibres, clock               eight fibres in one flight; how much time goes by
//! laid, measured              statistics since the last change
//! frame                       the moving picture
//! session                     the thread
//! board                       what pages see
//! guard, http, page, server   the server, with threads for each connection
//! ```

mod board;
mod clock;
mod document;
mod fibres;
mod frame;
mod guard;
mod http;
mod laid;
mod measured;
mod message;
mod page;
mod save;
mod server;
mod session;
mod settings;

use document::Document;
use guard::Guard;
use message::Complaint;
use server::Server;
use session::Session;
use spunlaid::fibre::case::keys;
use spunlaid::fibre::chain::Scheme;
use spunlaid::ground::{Dimension, Error, Fault, Problem};
use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::{io, panic, thread};

/// Messages that wait for the flight; then pages wait.
const WAITING: usize = 64;
/// Error of the free end's path over its amplitude that a page may cause by its time step, if the case does
/// not say: four times that of a run. At Table 1 the amplitude is then 0.2 to 1 % low, which a page shows
/// after a minute or so.
const ERROR_TOLERANCE: f64 = 0.012;

/// A case to be flown.
pub struct Start {
    /// The case as text.
    pub text: String,
    /// The file that it was read from.
    pub file: Option<PathBuf>,
    /// The port; 0 for any that is free.
    pub port: u16,
}

/// Flies a case for pages, until the program is ended.
///
/// * `ready` – gets the address of the page, and a remark on the scheme if there is one
///
/// # Errors
/// The case cannot be flown, or the server cannot start.
pub fn live(start: Start, ready: impl FnOnce(&str, Option<&str>)) -> Result<(), Error> {
    let name = start.file.as_ref().map_or_else(|| "the case".to_owned(), |file| file.display().to_string());
    let rejected = |complaints: Vec<Complaint>| {
        let problem = |why: String| Problem::with_path(Path::new(&name), Fault::plain(why));
        Error::Rejected(complaint_lines(&complaints).into_iter().map(problem).collect())
    };
    let (document, remark) = adapt_to_clock(Document::new(start.text, start.file)).map_err(rejected)?;
    let folder = std::env::current_dir().map_err(not_served)?;
    let session = Session::new(document, remark.clone(), folder).map_err(rejected)?;
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, start.port)).map_err(not_served)?;
    let guard = Guard::new(listener.local_addr().map_err(not_served)?.port())?;

    let (sender, requests) = mpsc::sync_channel(WAITING);
    let server = Server { guard, requests: sender, board: session.board(), strangers: Default::default() };
    let address = server.guard.address();
    let flight = thread::Builder::new().name("flight".to_owned()).spawn(move || session.fly(&requests));
    let flight = flight.map_err(not_served)?;
    let serving = thread::Builder::new().name("server".to_owned()).spawn(move || server.serve(&listener));
    serving.map_err(not_served)?;
    ready(&address, remark.as_deref());
    // The flight ends by a fault of the program only, and the server with it.
    flight.join().or_else(|fault| panic::resume_unwind(fault))
}

/// The case with the scheme and the step that keep up with the clock, and what is to be said of it.
fn adapt_to_clock(document: Document) -> Result<(Document, Option<String>), Vec<Complaint>> {
    let run = document.read()?.case.run;
    if run.scheme == Scheme::ImplicitTension {
        return Ok((document, None));
    }
    let mut other = document.clone();
    let mut values: Vec<(_, Option<toml_edit::Value>)> =
        vec![("run.scheme", Some(Scheme::ImplicitTension.name().into())), ("run.time_step", None)];
    if !document.gives("run", "error_tolerance") {
        values.push(("run.error_tolerance", Some(ERROR_TOLERANCE.into())));
    }
    for (name, value) in values {
        if let Some(key) = keys::find(name) {
            other = other.with(key, value)?;
        }
    }
    let Ok(read) = other.read() else {
        return Ok((document, None));
    };
    let step = read.case.run.time_step;
    let [asked_step, step] = [run.time_step, step].map(|step| Dimension::Time.pretty_to(step, 3));
    let note = format!(
        "the case asks for run.scheme = \"{}\" and steps of {asked_step}; to keep up with the clock, the \
        fibres fly with \"{}\" and {step}",
        run.scheme.name(),
        Scheme::ImplicitTension.name()
    );
    Ok((other, Some(note)))
}

/// The page cannot be served.
fn not_served(source: io::Error) -> Error {
    let message = format!("the page cannot be served: {source}");
    let fault = match source.kind() {
        io::ErrorKind::AddrInUse | io::ErrorKind::PermissionDenied => {
            Fault::new(message, "name another port with --port, or leave it out")
        }
        _ => Fault::plain(message),
    };
    Error::System(Box::new(fault.into()))
}

fn complaint_lines(complaints: &[Complaint]) -> Vec<String> {
    let line = |line: Option<usize>| line.map_or_else(String::new, |line| format!("line {line}: "));
    complaints.iter().map(|complaint| format!("{}{}", line(complaint.line), complaint.text)).collect()
}
