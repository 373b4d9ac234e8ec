//! `spunlaid live`: what it serves, to whom, and how it starts.

use crate::served::Live;
use std::net::{TcpStream, UdpSocket};
use std::process::Command;

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

/// Every user of a machine sees the arguments of all commands. The token stands in none, only in a file of the owner's.
#[cfg(target_os = "linux")]
#[test]
fn the_command_that_opens_a_browser_has_no_token() {
    use std::io::{BufRead, BufReader};
    use std::os::unix::fs::PermissionsExt;
    let place = tempfile::tempdir().unwrap();
    let browser = place.path().join("xdg-open");
    let script =
        "#!/bin/sh\n{ echo \"$1\"; stat -c %a \"$1\"; cat \"$1\"; } > \"$0.arguments\"; touch \"$0.done\"\n";
    std::fs::write(&browser, script).unwrap();
    std::fs::set_permissions(&browser, std::fs::Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:{}", place.path().display(), std::env::var("PATH").unwrap());
    let mut program = Command::new(env!("CARGO_BIN_EXE_spunlaid"))
        .arg("live")
        .current_dir(place.path())
        .env("PATH", path)
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let mut address = String::new();
    BufReader::new(program.stdout.take().unwrap()).read_line(&mut address).unwrap();
    while !place.path().join("xdg-open.done").exists() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    program.kill().unwrap();
    program.wait().unwrap();
    let opened = std::fs::read_to_string(place.path().join("xdg-open.arguments")).unwrap();
    let [file, mode, content] = opened.splitn(3, '\n').collect::<Vec<_>>()[..] else { panic!("{opened}") };
    assert!(!file.contains(address.trim()) && file.ends_with(".html") && mode == "600", "{opened}");
    assert!(content.contains(&format!("url={}", address.trim())), "{opened}");
    std::fs::remove_file(file).unwrap();
}
