//! `spunlaid live`: whatever comes through its socket, it goes on.

use crate::served::{Live, Page};
use serde_json::json;
use std::io::{Read, Write};
use std::net::TcpStream;
use tungstenite::protocol::Role;
use tungstenite::{Message, WebSocket};

/// Numbers that look random (Knuth's linear congruence).
struct Chance(u64);

impl Chance {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % end.max(1)
    }

    fn one_of<'a>(&mut self, all: &[&'a str]) -> &'a str {
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
            "spinline.throughput",
            "spinline.material.viscosity",
            "run",
            "\\u0000",
            "throughput",
            "slot_gap",
            "belt_speed",
            "basis_weight",
            "air_speed",
        ];
        let mut text = match self.below(12) {
            0 => {
                let stamp = self.one_of(&["1", "-1", "1e9"]);
                let (key, value) = (self.one_of(KEYS), self.one_of(VALUES));
                let what = self.one_of(&["set", "preview"]);
                format!(r#"{{"do":"{what}","key":"{key}","value":{value},"stamp":{stamp}}}"#)
            }
            1 => {
                let mut case = case.as_bytes().to_vec();
                for _ in 0..1 + self.below(4) {
                    let at = self.below(case.len());
                    case[at] = self.below(256) as u8;
                }
                json!({ "do": "case", "text": String::from_utf8_lossy(&case) }).to_string()
            }
            2 => {
                format!(r#"{{"do":"pace","pace":"{}"}}"#, self.one_of(&["real", "tenth", "free", "", "REAL"]))
            }
            3 => {
                let all = &[
                    "pause", "go", "step", "reset", "forget", "look", "save", "case", "pin", "confirm",
                    "filament",
                ];
                let back = self.below(12);
                if back < 4 {
                    format!(r#"{{"do":"back","to":{back}}}"#)
                } else {
                    format!(r#"{{"do":"{}"}}"#, self.one_of(all))
                }
            }
            4 => {
                let name = self.one_of(&["../x", "", "a/b", "/etc/x", "\u{0}", "a:b"]);
                json!({ "do": "save", "name": name, "replace": self.below(2) == 1 }).to_string()
            }
            5 => {
                let all = &["[[[[[[[[", "{\"do\":", "\"", "0", "{}", "{\"do\":{\"do\":1}}"];
                self.one_of(all).repeat(1 + self.below(200))
            }
            6 => format!(r#"{{"do":"look","visible":{}}}"#, self.one_of(VALUES)),
            7 => {
                return Message::binary(
                    (0..self.below(300)).map(|_| self.below(256) as u8).collect::<Vec<u8>>(),
                );
            }
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

/// How many random messages are sent. `SPUNLAID_LIVE_MESSAGES` sets it; 1000000 take some minutes.
fn messages(usual: usize) -> usize {
    std::env::var("SPUNLAID_LIVE_MESSAGES").map_or(usual, |count| count.parse().unwrap())
}

#[test]
fn whatever_comes_through_the_socket_the_program_goes_on() {
    let mut live = Live::start(&["table1.toml"]);
    let case = live.page().message("state")["text"].as_str().unwrap().to_owned();
    bombard(&mut live, messages(20_000), &case);
    let mut page = live.page();
    page.ask(&json!({ "do": "case", "text": case }));
    page.ask(&json!({ "do": "go" }));
    page.ask(&json!({ "do": "set", "key": "air.velocity", "value": 15, "stamp": 99 }));
    while page.message("applied")["stamp"] != 99 {}
    // The fibres fly on.
    let first = page.frame().2;
    while page.frame().2 <= first {}
    // A message that has become right by chance may save a case, and nothing else.
    assert!(live.files().iter().all(|name| name.ends_with(".toml")), "{:?}", live.files());
}

#[test]
fn whatever_comes_through_the_socket_of_a_line_its_web_is_simulated_afterwards() {
    let mut live = Live::start_in(|folder| {
        std::fs::write(folder.join("line.toml"), include_str!("line.toml")).unwrap();
        vec!["line.toml".into()]
    });
    let text = live.page().message("state")["text"].as_str().unwrap().to_owned();
    bombard(&mut live, messages(4_000), &text);
    let mut page = live.page();
    page.ask(&json!({ "do": "reset" }));
    page.ask(&json!({ "do": "go" }));
    page.ask(&json!({ "do": "set", "key": "throughput", "value": 0.57, "stamp": 99 }));
    let generation = loop {
        let applied = page.message("applied");
        if applied["stamp"] == 99 {
            break applied["generation"].clone();
        }
    };
    // The thread that simulates is still there, and so is the filament.
    while page.message("found")["generation"] != generation {}
    loop {
        let found = page.message("found");
        if found["patches"].as_array().unwrap().iter().any(|patch| patch["change"].is_object()) {
            break;
        }
    }
    assert!(live.page_at("fibre/").frame().2 >= 0.0);
    assert!(live.files().iter().all(|name| name.ends_with(".toml")), "{:?}", live.files());
}

/// Sends messages, most of them wrong: the program lives and has not panicked.
fn bombard(live: &mut Live, messages: usize, case: &str) {
    let mut chance = Chance(7);
    let mut sent = 0;
    while sent < messages {
        // Frames and answers are read by a thread, so that the program can send them. The answer to the last
        // message comes when the program has read all others.
        let Page(socket) = live.page();
        let stream = socket.get_ref().try_clone().unwrap();
        let last = format!("last-{sent}");
        let reading = std::thread::spawn({
            let mut reader = stream.try_clone().unwrap();
            let last = last.clone().into_bytes();
            move || contains(&mut reader, &last)
        });
        let mut socket = WebSocket::from_raw_socket(stream.try_clone().unwrap(), Role::Client, None);
        for _ in 0..5000.min(messages - sent) {
            socket.send(chance.message(case)).unwrap();
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
fn silent_and_slow_clients_keep_nobody_waiting() {
    let live = Live::start(&[]);
    // More than may wait: the owner is answered, and who says nothing is sent away.
    let mut silent: Vec<TcpStream> = (0..600).map(|_| live.connect()).collect();
    let mut slow = live.connect();
    slow.write_all(format!("GET /{}/ HTTP/1.1\r\n", live.token).as_bytes()).unwrap();
    // A page that reads nothing.
    let deaf = live.page();
    assert!(live.get("").starts_with("HTTP/1.1 200 "));
    let mut page = live.page();
    let first = page.frame().2;
    while page.frame().2 <= first {}
    // The slow one is answered when it has said all.
    slow.write_all(format!("{}\r\n\r\n", live.host()).as_bytes()).unwrap();
    let mut answer = String::new();
    slow.read_to_string(&mut answer).unwrap();
    assert!(answer.starts_with("HTTP/1.1 200 "), "{answer}");
    for silent in &mut silent {
        assert_eq!(silent.read(&mut [0]).unwrap_or(0), 0);
    }
    drop(deaf);
}
