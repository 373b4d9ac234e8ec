//! The server: hands out pages, and carries messages and pictures between pages and their session. Each
//! connection has a thread of its own, so that one that is slow or silent keeps nobody waiting.
//!
//! ```text
//! /TOKEN/          the page of a case, or of a line       /TOKEN/flight         its WebSocket
//! /TOKEN/fibre/    the page of the filament of the line   /TOKEN/fibre/flight   its WebSocket
//! ```

use super::board::{Board, Bookmark, News, PageId, Picture};
use super::guard::Guard;
use super::http::{self, Request, Response};
use super::message::{self, Answer, Command, LARGEST, PageRequest};
use super::page::{self, Page};
use spunlaid::ground::threads::lock;
use std::collections::BTreeMap;
use std::io::{self, ErrorKind, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::mpsc::SyncSender;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;
use tungstenite::handshake::derive_accept_key;
use tungstenite::protocol::frame::Frame;
use tungstenite::protocol::frame::coding::{Data, OpCode};
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Message, WebSocket};

/// Most connections that have not shown the token. One more ends the oldest: the owner's browser shows it at once.
const STRANGERS: usize = 256;
/// What a connection reads at once [bytes].
const PIECE: usize = 1 << 14;
/// Time after which a connection is accepted again, if the system has no more of them.
const PAUSE: Duration = Duration::from_millis(50);

/// What all connections share.
pub(super) struct Server {
    pub(super) guard: Guard,
    /// What is served, the site without a name of its own last.
    pub(super) sites: Vec<Box<dyn Site>>,
    pub(super) strangers: Strangers,
}

/// Pages with their session, below the address of the server.
pub(super) trait Site: Send + Sync {
    /// What the path of its files begins with: `fibre/`, or nothing.
    fn at(&self) -> &str;

    /// The answer with a file.
    fn file(&self, name: &str) -> Response;

    /// A place for a new page; `None` if too many are open.
    fn open(&self) -> Option<PageId>;

    /// Talks with a page until one of both has had enough, and closes it.
    fn talk(&self, stream: &mut TcpStream, rest: Vec<u8>, opened: OpenedPage);
}

/// A page that has been opened; the key confirms it.
pub(super) struct OpenedPage {
    page: PageId,
    key: String,
}

/// A site whose session hears `M` and shows `P`.
pub(super) struct SessionSite<M, P> {
    pub(super) at: String,
    pub(super) page: Page,
    pub(super) tabs: String,
    pub(super) requests: SyncSender<M>,
    pub(super) board: Arc<Board<P>>,
}

/// Connections that have not shown the token, by their numbers.
#[derive(Default)]
pub(super) struct Strangers(Mutex<BTreeMap<u64, TcpStream>>);

impl Strangers {
    /// Takes in a connection, and ends the oldest one if there are too many.
    fn admit(&self, number: u64, stream: &TcpStream) {
        let Ok(stream) = stream.try_clone() else { return };
        let mut all = lock(&self.0);
        all.insert(number, stream);
        if all.len() > STRANGERS
            && let Some((_, oldest)) = all.pop_first()
        {
            let _ = oldest.shutdown(Shutdown::Both);
        }
    }

    /// A connection has shown the token, or has ended.
    fn forget(&self, number: u64) {
        lock(&self.0).remove(&number);
    }
}

/// What a request leads to.
enum Reaction<'s> {
    Answer(Response),
    Talk(&'s dyn Site, OpenedPage),
}

impl Reaction<'_> {
    fn refusal(status: &'static str, line: &str) -> Self {
        Self::Answer(Response::plain(status, line))
    }
}

impl Server {
    /// Serves until the program ends.
    pub(super) fn serve(self, listener: &TcpListener) {
        let server = Arc::new(self);
        for (number, stream) in (0..).zip(listener.incoming()) {
            let Ok(mut stream) = stream else {
                thread::sleep(PAUSE);
                continue;
            };
            server.strangers.admit(number, &stream);
            let server = Arc::clone(&server);
            let thread = thread::Builder::new().name("connection".to_owned());
            // Without a thread, the connection closes.
            let _ = thread.spawn(move || {
                server.connect(&mut stream, number);
                server.strangers.forget(number);
            });
        }
    }

    /// Answers the request of a connection, or talks with the page that it is of.
    fn connect(&self, stream: &mut TcpStream, number: u64) {
        // A small message leaves at once; otherwise it waits until the page has confirmed the last one, 40 ms
        // and more. Where this cannot be had, it only comes later.
        let _ = stream.set_nodelay(true);
        let request = match Request::read(stream) {
            Ok(request) => request,
            Err(Some(refusal)) => return http::answer(stream, &refusal, &page::HEADERS, false),
            Err(None) => return,
        };
        match self.reaction(&request, number) {
            Reaction::Answer(response) => {
                http::answer(stream, &response, &page::HEADERS, request.method == "HEAD");
            }
            Reaction::Talk(site, opened) => site.talk(stream, request.rest, opened),
        }
    }

    fn reaction(&self, request: &Request, number: u64) -> Reaction<'_> {
        let needs_origin = request.count("upgrade") > 0 || request.count("origin") > 1;
        let (host, origin) = (request.only("host"), request.only("origin"));
        if let Err(refusal) = self.guard.check(&request.path, host, origin, needs_origin) {
            return Reaction::refusal("403 Forbidden", refusal.text());
        }
        self.strangers.forget(number);
        if !["GET", "HEAD"].contains(&request.method.as_str()) {
            return Reaction::refusal("405 Method Not Allowed", "The page and its files can only be read.\n");
        }
        // The first part of the path is the token.
        let file = request.path.splitn(3, '/').nth(2);
        let found = self.sites.iter().find_map(|site| Some((site, file?.strip_prefix(site.at())?)));
        let Some((site, file)) = found else {
            return Reaction::Answer(page::not_there());
        };
        if file != "flight" {
            return Reaction::Answer(site.file(file));
        }
        let upgrades = request.lists("connection", "upgrade") && request.lists("upgrade", "websocket");
        let known = request.method == "GET" && request.only("sec-websocket-version") == Some("13");
        let Some(key) = request.only("sec-websocket-key").filter(|_| upgrades && known) else {
            return Reaction::refusal("400 Bad Request", "This address is for a WebSocket of version 13.\n");
        };
        match site.open() {
            Some(page) => {
                Reaction::Talk(&**site, OpenedPage { page, key: derive_accept_key(key.as_bytes()) })
            }
            None => Reaction::refusal("503 Service Unavailable", "Too many pages are open; close one.\n"),
        }
    }
}

impl<M: From<PageRequest> + Send + 'static, P: Picture> Site for SessionSite<M, P> {
    fn at(&self) -> &str {
        &self.at
    }

    fn file(&self, name: &str) -> Response {
        page::file(self.page, &self.tabs, name)
    }

    fn open(&self) -> Option<PageId> {
        self.board.open()
    }

    fn talk(&self, stream: &mut TcpStream, rest: Vec<u8>, OpenedPage { page, key }: OpenedPage) {
        // However the talk ends, the page is gone.
        let _ = self.exchange(stream, rest, page, &key);
        self.board.close(page);
    }
}

impl<M: From<PageRequest> + Send + 'static, P: Picture> SessionSite<M, P> {
    /// Talks with a page until one of both has had enough: this thread reads, another one writes.
    fn exchange(&self, stream: &mut TcpStream, rest: Vec<u8>, page: PageId, key: &str) -> io::Result<()> {
        let head = format!(
            "HTTP/1.1 101 Switching Protocols\r\nconnection: Upgrade\r\nupgrade: websocket\r\n\
            sec-websocket-accept: {key}\r\n"
        );
        let headers: String = page::HEADERS.map(|(name, value)| format!("{name}: {value}\r\n")).concat();
        http::send(stream, format!("{head}{headers}\r\n").as_bytes())?;
        stream.set_read_timeout(None)?;
        let mut outward = stream.try_clone()?;
        self.ask(page, Command::Look { visible: true })?;
        let talked = thread::scope(|scope| {
            let writer = thread::Builder::new().name("page".to_owned()).spawn_scoped(scope, || {
                // A page that does not take its messages is given up; the reader hears of it.
                let _ = write(&mut outward, page, &self.board);
                self.board.close(page);
                let _ = outward.shutdown(Shutdown::Both);
            })?;
            let _ = self.read(stream, rest, page);
            self.board.post(page, News::End);
            writer.join().map_err(|_| io::Error::from(ErrorKind::Other))
        });
        self.ask(page, Command::Look { visible: false })?;
        talked
    }

    /// Hands on what a page asks. If many pages ask much, they wait.
    fn ask(&self, page: PageId, command: Command) -> io::Result<()> {
        self.requests.send(PageRequest { page, command }.into()).map_err(|_| ErrorKind::BrokenPipe.into())
    }

    /// Reads the messages of a page, until it leaves.
    fn read(&self, stream: &TcpStream, rest: Vec<u8>, page: PageId) -> tungstenite::Result<()> {
        let config = WebSocketConfig::default()
            .read_buffer_size(PIECE)
            .max_message_size(Some(LARGEST))
            .max_frame_size(Some(LARGEST));
        let inward = PageStream { stream, page, board: &self.board };
        let mut socket = WebSocket::from_partially_read(inward, rest, Role::Server, Some(config));
        loop {
            let answer = match socket.read()? {
                Message::Text(text) => match message::read(&text) {
                    Ok(command) => {
                        self.ask(page, command)?;
                        continue;
                    }
                    Err(answer) => answer,
                },
                Message::Binary(_) => Answer::refused("messages are text"),
                Message::Close(_) => return socket.flush(),
                Message::Ping(_) | Message::Pong(_) | Message::Frame(_) => continue,
            };
            if !self.board.post(page, News::Text(answer.json().into())) {
                return Ok(());
            }
        }
    }
}

/// The stream of a page as its reader has it. What the protocol answers by itself, a ping and the end, is
/// written between the messages of the writer.
struct PageStream<'a, P> {
    stream: &'a TcpStream,
    page: PageId,
    board: &'a Board<P>,
}

impl<P> Read for PageStream<'_, P> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.stream.read(bytes)
    }
}

impl<P> Write for PageStream<'_, P> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let posted = self.board.post(self.page, News::Raw(bytes.to_vec()));
        if posted { Ok(bytes.len()) } else { Err(ErrorKind::BrokenPipe.into()) }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Writes what there is for a page, until it leaves.
fn write<P: Picture>(stream: &mut TcpStream, page: PageId, board: &Board<P>) -> tungstenite::Result<()> {
    let (mut mark, mut had) = (Bookmark::default(), Default::default());
    let mut bytes = Vec::new();
    loop {
        bytes.clear();
        match board.next(page, &mut mark) {
            News::Text(text) => {
                let payload = text.as_bytes().to_vec();
                Frame::message(payload, OpCode::Data(Data::Text), true).format(&mut bytes)?;
            }
            News::Picture(latest) => {
                for payload in latest.messages(&mut had) {
                    Frame::message(payload, OpCode::Data(Data::Binary), true).format(&mut bytes)?;
                }
            }
            News::Raw(frame) => bytes = frame,
            News::End => return Ok(()),
        }
        http::send(stream, &bytes)?;
    }
}
