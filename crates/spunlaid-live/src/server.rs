//! The server: hands out the page, and carries messages and pictures between pages and their session. Each
//! connection has a thread of its own, so that one that is slow or silent keeps nobody waiting.

use super::board::{Board, Bookmark, News, PageId, Picture};
use super::guard::Guard;
use super::http::{self, Request, Response};
use super::message::{self, Answer, Command, LARGEST, PageRequest};
use super::page;
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
///
/// * `M` – what the session hears
pub(super) struct Server<M, P> {
    pub(super) guard: Guard,
    pub(super) page: page::Page,
    pub(super) requests: SyncSender<M>,
    pub(super) board: Arc<Board<P>>,
    pub(super) strangers: Strangers,
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
enum Reaction {
    Answer(Response),
    /// A page has been opened; the key confirms it.
    Talk {
        page: PageId,
        key: String,
    },
}

impl Reaction {
    fn refusal(status: &'static str, line: &str) -> Self {
        Self::Answer(Response::plain(status, line))
    }
}

impl<M: From<PageRequest> + Send + 'static, P: Picture> Server<M, P> {
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
            Reaction::Talk { page, key } => {
                // However the talk ends, the page is gone.
                let _ = self.talk(stream, request.rest, page, &key);
                self.board.close(page);
            }
        }
    }

    fn reaction(&self, request: &Request, number: u64) -> Reaction {
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
        if file != Some("flight") {
            return Reaction::Answer(page::file(self.page, file));
        }
        let upgrades = request.lists("connection", "upgrade") && request.lists("upgrade", "websocket");
        let known = request.method == "GET" && request.only("sec-websocket-version") == Some("13");
        let Some(key) = request.only("sec-websocket-key").filter(|_| upgrades && known) else {
            return Reaction::refusal("400 Bad Request", "This address is for a WebSocket of version 13.\n");
        };
        match self.board.open() {
            Some(page) => Reaction::Talk { page, key: derive_accept_key(key.as_bytes()) },
            None => Reaction::refusal("503 Service Unavailable", "Too many pages are open; close one.\n"),
        }
    }

    /// Talks with a page until one of both has had enough: this thread reads, another one writes.
    fn talk(&self, stream: &mut TcpStream, rest: Vec<u8>, page: PageId, key: &str) -> io::Result<()> {
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
