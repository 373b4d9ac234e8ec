//! Pages on which fibres fly, or the web of a line grows, while their numbers are changed: what `spunlaid live` serves.
//!
//! ```text
//! page ←→ server (loopback only, token) ← board: pictures, numbers ← session of fibres, or of a line
//!                                        → messages                → (a thread of its own)
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
use guard::Guard;
use message::{Complaint, PageRequest};
use page::Page;
use server::Server;
use spunlaid::ground::{Error, Fault, Problem};
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
    match subject {
        Subject::Fibre => {
            let name = file.as_ref().map_or_else(|| "the case".to_owned(), |file| file.display().to_string());
            let rejected = |complaints: Vec<Complaint>| {
                let problem = |why: String| Problem::with_path(Path::new(&name), Fault::plain(why));
                Error::Rejected(complaint_lines(&complaints).into_iter().map(problem).collect())
            };
            let (session, remark) = fibre::begin(text, file, folder).map_err(rejected)?;
            let remark = remark.as_deref();
            serve(Page::Fibre, port, session.board(), |heard, _| session.fly(&heard), |at| ready(at, remark))
        }
        Subject::Line => {
            let session = line::Session::new(text, file, folder)?;
            let board = session.board();
            let fly = |heard, sender| session.fly(&heard, sender);
            serve(Page::Line, port, board, fly, |at| ready(at, None))
        }
    }
}

/// Serves pages until the program is ended.
///
/// * `fly` – the session: hears what pages ask, and may send to itself
fn serve<M, P>(
    page: Page,
    port: u16,
    board: Arc<Board<P>>,
    fly: impl FnOnce(mpsc::Receiver<M>, mpsc::SyncSender<M>) + Send + 'static,
    ready: impl FnOnce(&str),
) -> Result<(), Error>
where
    M: From<PageRequest> + Send + 'static,
    P: Picture,
{
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(not_served)?;
    let guard = Guard::new(listener.local_addr().map_err(not_served)?.port())?;
    let (sender, heard) = mpsc::sync_channel(WAITING);
    let server = Server { guard, page, requests: sender.clone(), board, strangers: Default::default() };
    let address = server.guard.address();
    let session = thread::Builder::new().name("session".to_owned()).spawn(move || fly(heard, sender));
    let session = session.map_err(not_served)?;
    let serving = thread::Builder::new().name("server".to_owned()).spawn(move || server.serve(&listener));
    serving.map_err(not_served)?;
    ready(&address);
    // The session ends by a fault of the program only, and the server with it.
    session.join().or_else(|fault| panic::resume_unwind(fault))
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
