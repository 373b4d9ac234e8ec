//! Pages on which fibres fly, or the web of a line grows, while their numbers are changed: what `spunlaid live` serves.
//!
//! ```text
//! page ←→ server (loopback only, token) ← board: pictures, numbers ← session of fibres, or of a line
//!                                        → messages                → (a thread of its own)
//!                                          session of a line        → session of its filament, for each layer
//! ```
//!
//! ```text
//! message, save               what pages ask and are answered; files
//! board                       what pages see
//! fibre                       a session of fibres that fly
//! line                        a session of a line, whose web is simulated by another thread
//! guard, http, page, server   the server, with threads for each connection
//! ```

mod board;
mod fibre;
mod guard;
mod http;
mod line;
mod message;
mod page;
mod save;
mod server;

use board::{Board, Picture};
use fibre::Document;
use guard::Guard;
use message::{PageDiagnostic, PageRequest};
use page::{Page, Tab};
use server::{Server, SessionSite, Site};
use spunlaid::ground::{Diagnostic, Error, Fault};
use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};
use std::sync::{Arc, mpsc};
use std::{io, panic, thread};

/// Messages that wait for the flight; then pages wait.
const WAITING: usize = 64;
/// What is to be shown.
pub struct Start {
    /// What pages show.
    pub subject: Subject,
    /// Its text.
    pub text: String,
    /// The file that it was read from.
    pub file: Option<PathBuf>,
    /// The port; 0 for any that is free.
    pub port: u16,
}

/// What pages show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Fibres of a case.
    Fibre,
    /// The web of a line whose filaments are simulated.
    Line,
}

/// Shows a case or a line on pages, until the program is ended.
///
/// * `ready` – gets the address of the page, and a remark if there is one
///
/// # Errors
/// The case cannot be simulated, the line cannot be read, or the server cannot start.
pub fn live(start: Start, ready: impl FnOnce(&str, Option<&str>)) -> Result<(), Error> {
    let Start { subject, text, file, port } = start;
    let folder = std::env::current_dir().map_err(not_served)?;
    let mut sessions = Sessions::default();
    match subject {
        Subject::Fibre => {
            let name = file.as_ref().map_or_else(|| "the case".to_owned(), |file| file.display().to_string());
            let rejected = |diagnostics: Vec<PageDiagnostic>| {
                let problem = |why: String| Diagnostic::with_path(Path::new(&name), Fault::plain(why));
                Error::Rejected(diagnostic_lines(&diagnostics).into_iter().map(problem).collect())
            };
            let (session, remark) = fibre::begin(Document::new(text, file), folder).map_err(rejected)?;
            let board = session.board();
            sessions.begin(Page::Fibre, Tab::first("Fibre"), board, |heard, _| session.fly(&heard))?;
            sessions.serve(port, |at| ready(at, remark.as_deref()))
        }
        Subject::Line => {
            let mut session = line::Session::new(text, file, folder.clone())?;
            for layer in session.layers_with_filament() {
                match fibre::begin(session.filament_of(layer), folder.clone()) {
                    Ok((fibre, _)) => {
                        let tab = session.tab_of_filament(layer);
                        let board = fibre.board();
                        let requests =
                            sessions.begin(Page::Fibre, tab, board, |heard, _| fibre.fly(&heard))?;
                        session.show_filament_to(layer, requests);
                    }
                    Err(diagnostics) => session.lacks_filament(layer, &diagnostic_lines(&diagnostics)),
                }
            }
            let board = session.board();
            let fly = |heard, sender| session.fly(&heard, sender);
            sessions.begin(Page::Line, Tab::first("Web"), board, fly)?;
            sessions.serve(port, |at| ready(at, None))
        }
    }
}

/// The sessions of a program, each with its thread, and their sites.
#[derive(Default)]
struct Sessions {
    sites: Vec<(Tab, MakeSite)>,
    threads: Vec<thread::JoinHandle<()>>,
}

/// Makes a site once all tabs are known, of the links to them.
type MakeSite = Box<dyn FnOnce(String) -> Box<dyn Site>>;

impl Sessions {
    /// Begins a session; returns where it hears requests.
    ///
    /// * `fly` – the session: hears what pages ask, and may send to itself
    fn begin<M, P>(
        &mut self,
        page: Page,
        tab: Tab,
        board: Arc<Board<P>>,
        fly: impl FnOnce(mpsc::Receiver<M>, mpsc::SyncSender<M>) + Send + 'static,
    ) -> Result<mpsc::SyncSender<M>, Error>
    where
        M: From<PageRequest> + Send + 'static,
        P: Picture,
    {
        let (sender, heard) = mpsc::sync_channel(WAITING);
        let (requests, at) = (sender.clone(), tab.at.clone());
        let site = move |tabs| -> Box<dyn Site> { Box::new(SessionSite { at, page, tabs, requests, board }) };
        self.sites.push((tab, Box::new(site)));
        let own = sender.clone();
        let session = thread::Builder::new().name("session".to_owned()).spawn(move || fly(heard, own));
        self.threads.push(session.map_err(not_served)?);
        Ok(sender)
    }

    /// Serves pages until the program is ended. The site that began last has no name of its own.
    fn serve(self, port: u16, ready: impl FnOnce(&str)) -> Result<(), Error> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(not_served)?;
        let guard = Guard::new(listener.local_addr().map_err(not_served)?.port())?;
        let address = guard.address();
        let links = page::links(&self.sites.iter().map(|(tab, _)| tab).collect::<Vec<_>>());
        let sites = self.sites.into_iter().zip(links).map(|((_, site), links)| site(links)).collect();
        let server = Server { guard, sites, strangers: Default::default() };
        let serving = thread::Builder::new().name("server".to_owned()).spawn(move || server.serve(&listener));
        serving.map_err(not_served)?;
        ready(&address);
        // A session ends by a fault of the program only. The server ends with that of the page without a name.
        let last = self.threads.into_iter().next_back();
        last.map_or(Ok(()), |session| session.join().or_else(|fault| panic::resume_unwind(fault)))
    }
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

fn diagnostic_lines(diagnostics: &[PageDiagnostic]) -> Vec<String> {
    let line = |line: Option<usize>| line.map_or_else(String::new, |line| format!("line {line}: "));
    diagnostics.iter().map(|diagnostic| format!("{}{}", line(diagnostic.line), diagnostic.text)).collect()
}
