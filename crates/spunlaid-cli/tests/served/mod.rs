//! `spunlaid live` in a folder of its own, and the connection of a page.
#![allow(dead_code, clippy::unwrap_used, clippy::panic)]

use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use tungstenite::client::IntoClientRequest;
use tungstenite::{HandshakeError, Message, WebSocket};

/// The program in a folder of its own, ended when dropped.
pub struct Live {
    pub folder: tempfile::TempDir,
    pub program: Child,
    pub port: u16,
    pub token: String,
}

impl Live {
    /// * `case` – the case in `cases/` that it flies; none for its own
    pub fn start(case: &[&str]) -> Self {
        let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
        Self::start_in(|_| case.iter().map(|name| cases.join(name)).collect())
    }

    /// * `prepare` – writes files into the folder; says with which one the program is started
    pub fn start_in(prepare: impl FnOnce(&Path) -> Vec<PathBuf>) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let files = prepare(folder.path());
        let mut program = Command::new(env!("CARGO_BIN_EXE_spunlaid"))
            .args(["live", "--no-open"])
            .args(files)
            .current_dir(&folder)
            .stdout(Stdio::piped())
            .stderr(fs::File::create(folder.path().join(".said")).unwrap())
            .spawn()
            .unwrap();
        let mut address = String::new();
        BufReader::new(program.stdout.take().unwrap()).read_line(&mut address).unwrap();
        let rest = address.trim().strip_prefix("http://127.0.0.1:").unwrap();
        let (port, token) = rest.split_once('/').unwrap();
        Self { folder, program, port: port.parse().unwrap(), token: token.trim_end_matches('/').to_owned() }
    }

    /// A connection without a word.
    pub fn connect(&self) -> TcpStream {
        TcpStream::connect(("127.0.0.1", self.port)).unwrap()
    }

    /// The answer to a request with these lines at its head.
    pub fn request(&self, lines: &[String]) -> String {
        let mut stream = self.connect();
        stream.write_all(format!("{}\r\nConnection: close\r\n\r\n", lines.join("\r\n")).as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        String::from_utf8_lossy(&answer).into_owned()
    }

    /// The line of a request's head that names the host.
    pub fn host(&self) -> String {
        format!("Host: 127.0.0.1:{}", self.port)
    }

    /// The answer to a request for a file.
    pub fn get(&self, file: &str) -> String {
        self.request(&[format!("GET /{}/{file} HTTP/1.1", self.token), self.host()])
    }

    /// A new page. If too many are open, it waits until some are gone.
    pub fn page(&self) -> Page {
        self.page_at("")
    }

    /// A new page of a tab: `fibre/`.
    pub fn page_at(&self, tab: &str) -> Page {
        loop {
            let address = format!("ws://127.0.0.1:{}/{}/{tab}flight", self.port, self.token);
            let mut request = address.into_client_request().unwrap();
            let origin = format!("http://127.0.0.1:{}", self.port).parse().unwrap();
            request.headers_mut().insert("Origin", origin);
            match tungstenite::client(request, self.connect()) {
                Ok((socket, _)) => return Page(socket),
                Err(HandshakeError::Failure(tungstenite::Error::Http(answer))) if answer.status() == 503 => {
                    std::thread::sleep(std::time::Duration::from_millis(20));
                }
                Err(error) => panic!("{error}"),
            }
        }
    }

    /// What the program has said besides the address.
    pub fn said(&self) -> String {
        fs::read_to_string(self.folder.path().join(".said")).unwrap()
    }

    /// Time of all processors that the program has taken [s]; 0 where the system does not say it.
    pub fn processor_seconds(&self) -> f64 {
        /// Ticks of Linux in a second.
        const TICKS: f64 = 100.0;
        let Ok(stat) = fs::read_to_string(format!("/proc/{}/stat", self.program.id())) else { return 0.0 };
        // The name of the program, which may have spaces, stands in parentheses; user and system time are the 12th and
        // 13th number behind it.
        let numbers = stat.rsplit_once(')').unwrap().1.split_whitespace();
        numbers.skip(11).take(2).map(|ticks| ticks.parse::<f64>().unwrap()).sum::<f64>() / TICKS
    }

    /// What the program has saved.
    pub fn files(&self) -> Vec<String> {
        let names =
            fs::read_dir(&self.folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.filter(|name| name != ".said").collect();
        names.sort();
        names
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

/// The connection of a page.
pub struct Page(pub WebSocket<TcpStream>);

impl Page {
    /// Sends a message.
    pub fn ask(&mut self, message: &Value) {
        self.0.send(Message::text(message.to_string())).unwrap();
    }

    /// The next message of a kind.
    pub fn message(&mut self, is: &str) -> Value {
        loop {
            if let Message::Text(text) = self.0.read().unwrap() {
                let message: Value = serde_json::from_str(&text).unwrap();
                if message["is"] == is {
                    return message;
                }
            }
        }
    }

    /// Generation, bits and time of the next frame.
    pub fn frame(&mut self) -> (u32, u8, f64) {
        loop {
            if let Message::Binary(bytes) = self.0.read().unwrap() {
                let generation = u32::from_le_bytes(bytes[..4].try_into().unwrap());
                return (generation, bytes[4], f64::from_le_bytes(bytes[8..16].try_into().unwrap()));
            }
        }
    }

    /// The first problem of a message that is refused.
    pub fn refused(&mut self, message: &Value) -> Value {
        self.ask(message);
        self.message("refused")["problems"][0].clone()
    }
}
