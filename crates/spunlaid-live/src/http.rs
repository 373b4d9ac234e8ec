//! As much of HTTP/1.1 as the page needs: one request for each connection, and its answer.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::time::{Duration, Instant};

/// Size of the largest head of a request [bytes], and its most headers.
const LARGEST_HEAD: usize = 1 << 14;
const MOST_HEADERS: usize = 64;
/// A client that takes longer to ask, or to take a message, is given up; it may come back.
pub(super) const PATIENCE: Duration = Duration::from_secs(10);
/// A connection without a word ends sooner.
const SILENCE: Duration = Duration::from_secs(1);
/// How long a client that has its answer may go on sending [bytes, time]. Closed at once, it could lose the answer.
const LEFTOVER: usize = 1 << 16;
const FAREWELL: Duration = Duration::from_secs(1);

/// The head of a request.
#[derive(Debug)]
pub(super) struct Request {
    pub(super) method: String,
    /// The path without a query.
    pub(super) path: String,
    headers: Vec<(String, Vec<u8>)>,
    /// What came after the head.
    pub(super) rest: Vec<u8>,
}

/// An answer. The body is a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Response {
    pub(super) status: &'static str,
    /// The type of the body.
    pub(super) kind: &'static str,
    pub(super) body: String,
}

impl Response {
    /// A line of plain text.
    pub(super) fn plain(status: &'static str, line: &str) -> Self {
        Self { status, kind: "text/plain; charset=utf-8", body: line.to_owned() }
    }
}

impl Request {
    /// Reads the head of a request.
    ///
    /// # Errors
    /// The answer to a request that cannot be read; `None` if nobody waits for one.
    pub(super) fn read(stream: &mut TcpStream) -> Result<Self, Option<Response>> {
        let (mut bytes, mut piece) = (Vec::new(), [0; 4096]);
        let end = Instant::now() + PATIENCE;
        loop {
            let left = end.saturating_duration_since(Instant::now()).max(Duration::from_millis(1));
            let left = if bytes.is_empty() { left.min(SILENCE) } else { left };
            stream.set_read_timeout(Some(left)).map_err(|_| None)?;
            match stream.read(&mut piece) {
                Ok(0) => return Err(None),
                Ok(count) => bytes.extend_from_slice(&piece[..count]),
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(_) => return Err(None),
            }
            if let Some(request) = Self::parse(&bytes).map_err(Some)? {
                return Ok(request);
            }
            if bytes.len() > LARGEST_HEAD {
                let line = "The head of the request is too long.\n";
                return Err(Some(Response::plain("431 Request Header Fields Too Large", line)));
            }
            if Instant::now() >= end {
                return Err(None);
            }
        }
    }

    /// The request at the start of these bytes; `None` while its head is not complete.
    fn parse(bytes: &[u8]) -> Result<Option<Self>, Response> {
        let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
        let mut head = httparse::Request::new(&mut headers);
        let length = match head.parse(bytes) {
            Ok(httparse::Status::Complete(length)) => length,
            Ok(httparse::Status::Partial) => return Ok(None),
            Err(error) => {
                let line = format!("This request cannot be answered: {error}.\n");
                return Err(Response::plain("400 Bad Request", &line));
            }
        };
        let path = head.path.unwrap_or_default().split(['?', '#']).next().unwrap_or_default();
        Ok(Some(Self {
            method: head.method.unwrap_or_default().to_owned(),
            path: path.to_owned(),
            headers: head
                .headers
                .iter()
                .map(|one| (one.name.to_ascii_lowercase(), one.value.to_vec()))
                .collect(),
            rest: bytes[length..].to_vec(),
        }))
    }

    fn all(&self, name: &str) -> impl Iterator<Item = Option<&str>> {
        let values = self.headers.iter().filter(move |(other, _)| other == name);
        values.map(|(_, value)| std::str::from_utf8(value).ok())
    }

    /// How many headers have this name, in small letters.
    pub(super) fn count(&self, name: &str) -> usize {
        self.all(name).count()
    }

    /// The text of a header that is there once.
    pub(super) fn only(&self, name: &str) -> Option<&str> {
        let mut all = self.all(name);
        all.next()?.filter(|_| all.next().is_none())
    }

    /// Whether a header lists a word, in whatever letters.
    pub(super) fn lists(&self, name: &str, word: &str) -> bool {
        self.all(name)
            .flatten()
            .flat_map(|text| text.split(','))
            .any(|one| one.trim().eq_ignore_ascii_case(word))
    }
}

/// Sends bytes; a client has to take them within [`PATIENCE`].
///
/// # Errors
/// It does not, or is gone.
pub(super) fn send(stream: &mut TcpStream, mut bytes: &[u8]) -> io::Result<()> {
    let end = Instant::now() + PATIENCE;
    while !bytes.is_empty() {
        let left = end.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        stream.set_write_timeout(Some(left))?;
        match stream.write(bytes) {
            Ok(0) => return Err(ErrorKind::WriteZero.into()),
            Ok(count) => bytes = &bytes[count..],
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

/// Sends an answer, and ends the connection.
///
/// * `headers` – what every answer says besides its kind and length
/// * `head_only` – the body is left out
pub(super) fn answer(stream: &mut TcpStream, response: &Response, headers: &[(&str, &str)], head_only: bool) {
    let Response { status, kind, body } = response;
    let mut text = format!(
        "HTTP/1.1 {status}\r\ncontent-type: {kind}\r\ncontent-length: {}\r\nconnection: close\r\n",
        body.len()
    );
    headers.iter().for_each(|(name, value)| text.extend([name, ": ", value, "\r\n"]));
    text.push_str("\r\n");
    if !head_only {
        text.push_str(body);
    }
    if send(stream, text.as_bytes()).is_ok() && stream.shutdown(Shutdown::Write).is_ok() {
        say_farewell(stream);
    }
}

/// Waits for a short while until the client has closed the connection as well.
fn say_farewell(stream: &mut TcpStream) {
    let end = Instant::now() + FAREWELL;
    let mut left = LEFTOVER;
    let mut piece = [0; 4096];
    while left > 0 && Instant::now() < end && stream.set_read_timeout(Some(FAREWELL)).is_ok() {
        match stream.read(&mut piece) {
            Ok(count) if count > 0 => left = left.saturating_sub(count),
            _ => return,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(text: &str) -> Request {
        Request::parse(text.as_bytes()).unwrap().unwrap()
    }

    #[test]
    fn a_head_is_read_with_what_comes_after_it() {
        let text =
            "GET /a/b?c=1 HTTP/1.1\r\nHost: x\r\nConnection: keep-alive, Upgrade\r\nA: 1\r\na: 2\r\n\r\nmore";
        let request = request(text);
        assert_eq!((request.method.as_str(), request.path.as_str()), ("GET", "/a/b"));
        assert_eq!((request.only("host"), request.only("a"), request.only("b")), (Some("x"), None, None));
        assert_eq!((request.count("a"), request.count("b")), (2, 0));
        assert!(request.lists("connection", "upgrade") && !request.lists("connection", "close"));
        assert_eq!(request.rest, b"more");
        // Every beginning of it wants more.
        for length in 0..text.len() - "more".len() {
            assert!(Request::parse(&text.as_bytes()[..length]).unwrap().is_none(), "{length}");
        }
    }

    #[test]
    fn rejects_heads_that_are_none() {
        let many = format!("GET / HTTP/1.1\r\n{}\r\n", "a: b\r\n".repeat(MOST_HEADERS + 1));
        for text in
            ["GET\r\n\r\n", "\0\0\0\0", "GET / HTTP/9\r\n\r\n", "GET / HTTP/1.1\r\na b: c\r\n\r\n", &many]
        {
            assert_eq!(Request::parse(text.as_bytes()).unwrap_err().status, "400 Bad Request", "{text:?}");
        }
        // Bytes that are no text are no value.
        let request = Request::parse(b"GET / HTTP/1.1\r\nhost: \xff\r\n\r\n").unwrap().unwrap();
        assert_eq!((request.only("host"), request.count("host")), (None, 1));
    }
}
