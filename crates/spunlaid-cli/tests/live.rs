//! `spunlaid live` as a browser meets it: addresses, messages, frames, files; and what no browser sends.
#![allow(clippy::unwrap_used, clippy::panic)]

use serde_json::{Value, json};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpStream, UdpSocket};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use tungstenite::client::IntoClientRequest;
use tungstenite::protocol::Role;
use tungstenite::{HandshakeError, Message, WebSocket};

/// The program in a folder of its own, ended when dropped.
struct Live {
    folder: tempfile::TempDir,
    program: Child,
    port: u16,
    token: String,
}

impl Live {
    fn start(case: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
        let mut program = Command::new(env!("CARGO_BIN_EXE_spunlaid"))
            .args(["live", "--no-open"])
            .args(case.iter().map(|name| cases.join(name)))
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

    fn connect(&self) -> TcpStream {
        TcpStream::connect(("127.0.0.1", self.port)).unwrap()
    }

    /// The answer to a request with these lines at its head.
    fn request(&self, lines: &[String]) -> String {
        let mut stream = self.connect();
        stream.write_all(format!("{}\r\nConnection: close\r\n\r\n", lines.join("\r\n")).as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        String::from_utf8_lossy(&answer).into_owned()
    }

    fn host(&self) -> String {
        format!("Host: 127.0.0.1:{}", self.port)
    }

    fn get(&self, file: &str) -> String {
        self.request(&[format!("GET /{}/{file} HTTP/1.1", self.token), self.host()])
    }

    /// A new page. If too many are open, it waits until some are gone.
    fn page(&self) -> Page {
        loop {
            let address = format!("ws://127.0.0.1:{}/{}/flight", self.port, self.token);
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
    fn said(&self) -> String {
        fs::read_to_string(self.folder.path().join(".said")).unwrap()
    }

    fn files(&self) -> Vec<String> {
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
struct Page(WebSocket<TcpStream>);

impl Page {
    fn ask(&mut self, message: &Value) {
        self.0.send(Message::text(message.to_string())).unwrap();
    }

    /// The next message of a kind.
    fn told(&mut self, is: &str) -> Value {
        loop {
            if let Message::Text(text) = self.0.read().unwrap() {
                let told: Value = serde_json::from_str(&text).unwrap();
                if told["is"] == is {
                    return told;
                }
            }
        }
    }

    /// Generation, bits and time of the next frame.
    fn frame(&mut self) -> (u32, u8, f64) {
        loop {
            if let Message::Binary(bytes) = self.0.read().unwrap() {
                let generation = u32::from_le_bytes(bytes[..4].try_into().unwrap());
                return (generation, bytes[4], f64::from_le_bytes(bytes[8..16].try_into().unwrap()));
            }
        }
    }

    fn refused(&mut self, message: &Value) -> Value {
        self.ask(message);
        self.told("refused")["problems"][0].clone()
    }
}

#[test]
fn page_and_files_are_of_the_program_and_load_nothing_from_elsewhere() {
    let live = Live::start(&[]);
    let page = live.get("");
    assert!(page.starts_with("HTTP/1.1 200 "), "{page}");
    assert!(page.contains(&format!("spunlaid {}", env!("CARGO_PKG_VERSION"))));
    for header in [
        "content-security-policy: default-src 'none'; script-src 'self'",
        "cache-control: no-store",
        "referrer-policy: no-referrer",
    ] {
        assert!(page.contains(header), "{header}");
    }
    for file in page.split('"').filter(|part| part.ends_with(".js") || part.ends_with(".css")) {
        assert!(live.get(file).starts_with("HTTP/1.1 200 "), "{file}");
    }
    for file in ["nothing.js", "..%2f..%2fetc%2fpasswd", "a/b", "%2e%2e/"] {
        assert!(live.get(file).starts_with("HTTP/1.1 404 "), "{file}");
    }
}

#[test]
fn rejects_other_tokens_hosts_origins_and_machines() {
    let live = Live::start(&[]);
    let path = format!("GET /{}/live.js HTTP/1.1", live.token);
    let upgrade = |more: &[&str]| {
        let mut lines = vec![format!("GET /{}/flight HTTP/1.1", live.token), live.host()];
        lines.extend(
            [
                "Upgrade: websocket",
                "Sec-WebSocket-Version: 13",
                "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==",
            ]
            .map(str::to_owned),
        );
        lines.extend(more.iter().map(|line| (*line).to_owned()));
        // The last "Connection" counts for both.
        lines.push("Connection: Upgrade".to_owned());
        live.request(&lines)
    };
    let own = format!("Origin: http://127.0.0.1:{}", live.port);
    for (what, answer) in [
        ("no token", live.request(&["GET / HTTP/1.1".to_owned(), live.host()])),
        ("another token", live.request(&[format!("GET /{}/ HTTP/1.1", "0".repeat(32)), live.host()])),
        ("half a token", live.request(&[format!("GET /{}/ HTTP/1.1", &live.token[..16]), live.host()])),
        ("another host", live.request(&[path.clone(), "Host: evil.example".to_owned()])),
        ("two hosts", live.request(&[path.clone(), live.host(), "Host: evil.example".to_owned()])),
        ("another port", live.request(&[path.clone(), "Host: 127.0.0.1:1".to_owned()])),
        (
            "another origin",
            live.request(&[path.clone(), live.host(), "Origin: http://evil.example".to_owned()]),
        ),
        ("two origins", live.request(&[path.clone(), live.host(), own.clone(), own.clone()])),
        ("a flight without an origin", upgrade(&[])),
        ("a flight of another origin", upgrade(&["Origin: http://evil.example"])),
        ("a flight of no origin", upgrade(&["Origin: null"])),
    ] {
        let refused = answer.starts_with("HTTP/1.1 403 ") || answer.starts_with("HTTP/1.1 400 ");
        assert!(refused, "{what}: {answer}");
        assert!(!answer.contains(&live.token), "{what}");
    }
    // Not from other machines: the port is closed on every other address of this one.
    let elsewhere = UdpSocket::bind("0.0.0.0:0").and_then(|socket| {
        socket.connect("192.0.2.1:9")?;
        socket.local_addr()
    });
    if let Ok(own) = elsewhere.map(|address| address.ip()).as_ref().map(|ip| *ip)
        && !own.is_loopback()
    {
        assert!(TcpStream::connect((own, live.port)).is_err(), "{own}");
    }
    let mut page = live.page();
    assert!(page.frame().2 >= 0.0);
}

#[test]
fn what_can_change_in_flight_changes_at_once_and_the_case_follows() {
    let live = Live::start(&["table1.toml"]);
    let mut page = live.page();
    let settings = page.told("settings");
    let keys: Vec<&str> =
        settings["settings"].as_array().unwrap().iter().map(|s| s["key"].as_str().unwrap()).collect();
    assert!(keys.contains(&"air.velocity") && keys.contains(&"drag.along"), "{keys:?}");
    let before = page.told("state");
    assert!(before["text"].as_str().unwrap().contains("scheme = \"implicit-tension\""), "{before}");
    assert!(before["remark"].as_str().unwrap().contains("semi-implicit-euler"), "{before}");
    let (_, _, time) = page.frame();

    page.ask(&json!({ "do": "set", "key": "air.velocity", "value": 20, "stamp": 5 }));
    let applied = page.told("applied");
    assert_eq!(applied["stamp"], 5);
    let state = page.told("state");
    assert!(state["text"].as_str().unwrap().contains("velocity = \"20 m/s\""), "{state}");
    assert!(state["command"].as_str().unwrap().contains("--set 'air.velocity=20 m/s'"), "{state}");
    assert_eq!(state["air"], 20.0);
    let (generation, _, later) = page.frame();
    assert!(u64::from(generation) >= applied["generation"].as_u64().unwrap() && later >= time);

    page.ask(&json!({ "do": "set", "key": "air.length_scale", "value": "60 mm", "stamp": 6 }));
    assert_eq!(page.told("applied")["stamp"], 6);
    // A new flight, but the time of the page goes on.
    assert!(page.frame().2 >= later);
}

#[test]
fn rejects_bad_values_by_key_and_bad_cases_by_line() {
    let live = Live::start(&["table1.toml"]);
    let mut page = live.page();
    let text = page.told("state")["text"].as_str().unwrap().to_owned();
    let set = |key: &str, value: Value| json!({ "do": "set", "key": key, "value": value, "stamp": 1 });
    for (message, line, wanted) in [
        (set("air.velocitiy", json!(1)), None, "did you mean"),
        (set("fibre.diameter", json!(-1e-5)), Some(6), "fibre.diameter = \"-10 µm\" is not positive"),
        (set("fibre.diameter", json!("5 s")), Some(6), "is a time; write a length"),
        (set("fibre.root", json!("glued")), Some(9), "is unknown"),
        (set("air.profile", json!("/etc/passwd")), None, "may not name other files"),
        (json!({ "do": "case", "text": text.replace("50 mm", "50 mmm") }), Some(14), "air.length_scale"),
        (json!({ "do": "case", "text": "a =\n= b" }), Some(1), ""),
        (json!({ "do": "case", "text": "" }), None, "fibre"),
        (json!({ "do": "dance" }), None, "not understood"),
    ] {
        let problem = page.refused(&message);
        assert!(problem["text"].as_str().unwrap().contains(wanted), "{message}: {problem}");
        assert_eq!(problem["line"].as_u64(), line, "{message}: {problem}");
    }
    page.0.send(Message::binary(vec![1, 2, 3])).unwrap();
    assert!(page.told("refused")["problems"][0]["text"].as_str().unwrap().contains("messages are text"));
    page.ask(&json!({ "do": "forget" }));
    assert_eq!(page.told("state")["text"], text);
}

#[test]
fn only_what_is_saved_by_a_plain_name_is_written() {
    let live = Live::start(&["spunbond.toml"]);
    let mut page = live.page();
    let save = |name: &str, replace: bool| json!({ "do": "save", "name": name, "replace": replace });
    for name in ["../a", "/tmp/a", "a/b", "", ".hidden", "..", "a\u{0}b"] {
        assert!(
            page.refused(&save(name, true))["text"].as_str().unwrap().contains("no plain name"),
            "{name}"
        );
    }
    assert_eq!(live.files(), Vec::<String>::new());
    page.ask(&save("mine", false));
    assert_eq!(page.told("saved")["name"], "mine.toml");
    page.ask(&save("mine.toml", false));
    assert_eq!(page.told("exists")["name"], "mine.toml");
    page.ask(&save("mine.toml", true));
    assert_eq!(page.told("saved")["name"], "mine.toml");
    assert_eq!(live.files(), ["mine.toml"]);
    // The saved case runs from where it is, with the profile that it names.
    let done = Command::new(env!("CARGO_BIN_EXE_spunlaid"))
        .args(["check", "mine.toml"])
        .current_dir(&live.folder)
        .output();
    let done = done.unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

#[test]
fn time_stands_goes_step_by_step_and_rests_when_nobody_looks() {
    let live = Live::start(&["table1.toml"]);
    let (mut page, mut other) = (live.page(), live.page());
    page.ask(&json!({ "do": "pause" }));
    let standing = |page: &mut Page| loop {
        let (_, bits, time) = page.frame();
        if bits & 1 == 1 {
            return time;
        }
    };
    let time = standing(&mut page);
    assert_eq!(standing(&mut other), time);
    // The picture is that of the last step but one, from the first step on.
    let mut stepped = |from: f64| {
        page.ask(&json!({ "do": "step" }));
        loop {
            let (_, bits, time) = page.frame();
            assert_eq!(bits & 1, 1);
            if time != from {
                return time;
            }
        }
    };
    let first = stepped(time);
    let second = stepped(first);
    assert!((second - first - 1e-3).abs() < 1e-9, "{time} {first} {second}");
    // Nobody looks any more: the time does not go on, and a message is answered all the same.
    page.ask(&json!({ "do": "go" }));
    for page in [&mut page, &mut other] {
        page.ask(&json!({ "do": "look", "visible": false }));
    }
    other.0.close(None).unwrap();
    let rested = |page: &mut Page| {
        page.ask(&json!({ "do": "forget" }));
        page.told("state");
        page.frame().2
    };
    let first = loop {
        let [first, second] = [rested(&mut page), rested(&mut page)];
        if first == second {
            break first;
        }
    };
    page.ask(&json!({ "do": "look", "visible": true }));
    while page.frame().2 <= first {}
    page.ask(&json!({ "do": "pace", "pace": "free" }));
    assert_eq!(page.told("state")["pace"], "free");
}

/// Numbers that look random (Knuth's linear congruence).
struct Chance(u64);

impl Chance {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % end.max(1)
    }

    fn of<'a>(&mut self, all: &[&'a str]) -> &'a str {
        all[self.below(all.len())]
    }

    /// A message: mostly almost right, sometimes right, sometimes noise.
    fn message(&mut self, case: &str) -> Message {
        const VALUES: &[&str] = &[
            "20",
            "-1",
            "1e-300",
            "1e308",
            "1e999",
            "null",
            "\"20 m/s\"",
            "\"NaN\"",
            "\"\"",
            "[]",
            "{}",
            "\"clamped\"",
            "true",
            "0",
            "\"\\u0000\"",
            "\"/etc/passwd\"",
            "0.2",
        ];
        const KEYS: &[&str] = &[
            "air.velocity",
            "fibre.diameter",
            "fibre.root",
            "air.length_scale",
            "run.seed",
            "air.profile",
            "run.scheme",
            "belt.speed",
            "",
            ".",
            "a.b.c",
            "fibre.length",
            "drag.across",
            "run",
            "\\u0000",
        ];
        let mut text = match self.below(12) {
            0 => format!(r#"{{"do":"set","key":"{}","value":{},"stamp":{}}}"#, self.of(KEYS), self.of(VALUES), self.of(&["1", "-1", "1e9"])),
            1 => {
                let mut case = case.as_bytes().to_vec();
                for _ in 0..1 + self.below(4) {
                    let at = self.below(case.len());
                    case[at] = self.below(256) as u8;
                }
                json!({ "do": "case", "text": String::from_utf8_lossy(&case) }).to_string()
            }
            2 => format!(r#"{{"do":"pace","pace":"{}"}}"#, self.of(&["real", "tenth", "free", "", "REAL"])),
            3 => format!(r#"{{"do":"{}"}}"#, self.of(&["pause", "go", "step", "reset", "forget", "look", "save", "case"])),
            4 => json!({ "do": "save", "name": self.of(&["../x", "", "a/b", "/etc/x", "\u{0}", "a:b"]), "replace": self.below(2) == 1 }).to_string(),
            5 => self.of(&["[[[[[[[[", "{\"do\":", "\"", "0", "{}", "{\"do\":{\"do\":1}}"]).repeat(1 + self.below(200)),
            6 => format!(r#"{{"do":"look","visible":{}}}"#, self.of(VALUES)),
            7 => return Message::binary((0..self.below(300)).map(|_| self.below(256) as u8).collect::<Vec<u8>>()),
            8 => return Message::Ping(vec![0; self.below(126)].into()),
            _ => (0..self.below(80)).filter_map(|_| char::from_u32(self.below(0x500) as u32)).collect(),
        };
        if self.below(3) == 0 && !text.is_empty() {
            let mut bytes = text.into_bytes();
            let at = self.below(bytes.len());
            bytes[at] = self.below(256) as u8;
            text = String::from_utf8_lossy(&bytes).into_owned();
        }
        Message::text(text)
    }
}

/// Whether a text comes out of a stream before it ends.
fn contains(stream: &mut TcpStream, text: &[u8]) -> bool {
    let (mut kept, mut bytes) = (Vec::new(), [0; 1 << 16]);
    loop {
        match stream.read(&mut bytes) {
            Ok(read) if read > 0 => kept.extend_from_slice(&bytes[..read]),
            _ => return false,
        }
        if kept.windows(text.len()).any(|window| window == text) {
            return true;
        }
        kept.drain(..kept.len().saturating_sub(text.len()));
    }
}

/// `SPUNLAID_LIVE_MESSAGES` sets how many; 1000000 take some minutes.
#[test]
fn whatever_comes_through_the_socket_the_program_goes_on() {
    let messages = std::env::var("SPUNLAID_LIVE_MESSAGES").map_or(20_000, |count| count.parse().unwrap());
    let mut live = Live::start(&["table1.toml"]);
    let mut chance = Chance(7);
    let case = live.page().told("state")["text"].as_str().unwrap().to_owned();
    let mut sent = 0;
    while sent < messages {
        // Frames and answers are read by a thread, so that the program can send them. The answer to the last message comes
        // when the program has read all others.
        let Page(socket) = live.page();
        let stream = socket.get_ref().try_clone().unwrap();
        let last = format!("last-{sent}");
        let reading = std::thread::spawn({
            let (mut reader, last) = (stream.try_clone().unwrap(), last.clone().into_bytes());
            move || contains(&mut reader, &last)
        });
        let mut socket = WebSocket::from_raw_socket(stream.try_clone().unwrap(), Role::Client, None);
        for _ in 0..5000.min(messages - sent) {
            socket.send(chance.message(&case)).unwrap();
            sent += 1;
        }
        socket.send(Message::text(json!({ "do": last }).to_string())).unwrap();
        assert!(reading.join().unwrap(), "{sent}: {}", live.said());
        // And what is no message: raw bytes after them, headers that do not end, halves of requests.
        let mut stream = stream;
        let noise: Vec<u8> = (0..500).map(|_| chance.below(256) as u8).collect();
        let _ = stream.write_all(&noise);
        let _ = live.connect().write_all(&noise);
        let _ = live.connect().write_all(format!("GET /{}/flight HTTP/1.1\r\nHost: ", live.token).as_bytes());
        let _ = stream.shutdown(std::net::Shutdown::Both);
    }
    assert!(live.program.try_wait().unwrap().is_none(), "{}", live.said());
    assert!(!live.said().contains("panicked"), "{}", live.said());
    let mut page = live.page();
    page.ask(&json!({ "do": "case", "text": case }));
    page.ask(&json!({ "do": "go" }));
    page.ask(&json!({ "do": "set", "key": "air.velocity", "value": 15, "stamp": 99 }));
    while page.told("applied")["stamp"] != 99 {}
    let (first, second) = (
        page.frame().2,
        loop {
            let (_, bits, time) = page.frame();
            if bits & 1 == 0 {
                break time;
            }
        },
    );
    assert!(second >= first);
    // A message that has become right by chance may save a case, and nothing else.
    assert!(live.files().iter().all(|name| name.ends_with(".toml")), "{:?}", live.files());
}

#[test]
fn messages_that_are_too_large_end_the_connection_only() {
    let live = Live::start(&[]);
    let mut page = live.page();
    let _ = page.0.send(Message::text("x".repeat(1 << 20)));
    while page.0.read().is_ok() {}
    assert!(live.page().frame().2 >= 0.0);
    assert!(!live.said().contains("panicked"));
}

#[test]
fn rejects_a_case_that_is_wrong_and_a_port_that_is_taken() {
    let program = || Command::new(env!("CARGO_BIN_EXE_spunlaid"));
    let missing = program().args(["live", "not_there.toml", "--no-open"]).output().unwrap();
    assert_eq!(missing.status.code(), Some(1), "{}", String::from_utf8_lossy(&missing.stderr));
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let refused = program().args(["live", "--no-open", "--port", &port]).output().unwrap();
    let said = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(said.contains("name another port with --port"), "{said}");
}
