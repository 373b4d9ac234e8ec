//! Every command that the program prints or writes works as it stands, where it was printed, and a second time too.

use crate::desk::{Desk, FED, success};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::Command;

/// A line of known filaments with an assumed value, on a sheet that is laid in an instant.
const LINE: &str = "
[fibre]
linear_density = \"2 dtex\"
density = \"910 kg/m³\"
[laydown]
sigma_md = \"4 mm\"
sigma_cd = \"4 mm\"
noise = \"15 m^-0.5\"
[line]
throughput = \"0.6 g/min\"
basis_weight = \"4 g/m²\"
filaments_per_metre = 2000
[web]
width = \"40 mm\"
length = \"40 mm\"
cell = \"0.5 mm\"
patches = [\"2 mm\", \"10 mm\"]
assumed = \"line.filaments_per_metre\"
";

/// The commands in a text: on lines of their own, behind `: ` or `# `, or in attributes and code of a page.
fn commands(text: &str) -> BTreeSet<String> {
    let plain = text.replace("&#39;", "'").replace("&#x27;", "'").replace("&amp;", "&");
    let plain = [": ", ", "]
        .iter()
        .fold(plain, |text, before| text.replace(&format!("{before}spunlaid "), "\nspunlaid "));
    let trimmed = plain.split(['\n', '"', '<', '>', '#']).map(str::trim);
    let is_command = |part: &&str| {
        let named = part.strip_prefix("spunlaid ").and_then(|rest| rest.split_once(' '));
        named.is_some_and(|(verb, rest)| {
            ["check", "run", "spin", "web", "sweep", "air"].contains(&verb) && rest.contains(".toml")
        })
    };
    trimmed.filter(is_command).map(str::to_owned).collect()
}

/// Runs a line of a shell, in which the program is called as people call it.
fn paste(desk: &Desk, line: &str) {
    let program = Path::new(env!("CARGO_BIN_EXE_spunlaid")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let output =
        Command::new("sh").args(["-c", line]).env("PATH", path).current_dir(desk.path("")).output().unwrap();
    assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
}

/// The verb of a command and the names of its options.
fn kind(line: &str) -> Vec<&str> {
    let words = line.split_whitespace().enumerate();
    words.filter(|(i, word)| *i == 1 || word.starts_with("--")).map(|(_, word)| word).collect()
}

/// Runs all commands of some texts, and one of each kind a second time.
fn paste_all(desk: &Desk, texts: &[String], least: usize) {
    let all: BTreeSet<String> = texts.iter().flat_map(|text| commands(text)).collect();
    assert!(all.len() >= least, "{all:#?}");
    let kinds: BTreeMap<Vec<&str>, &String> = all.iter().map(|line| (kind(line), line)).collect();
    all.iter().chain(kinds.into_values()).for_each(|line| paste(desk, line));
}

#[test]
#[ignore = "slow: a web with advice for each command"]
fn every_command_of_a_web_can_be_pasted() {
    let desk = Desk::with_case(FED);
    fs::write(desk.path("my line.toml"), LINE).unwrap();
    for (arguments, folder, set) in [
        (&["web", "my line.toml"][..], "results/my line", &[][..]),
        (&["web", "my line.toml", "--out", "here"], "here", &["line.throughput=0.5 g/min"]),
    ] {
        let set_is_empty = set.is_empty();
        let set = set.iter().flat_map(|set| ["--set", set]);
        let said = success(desk.spunlaid("").args(arguments).args(set));
        let report = String::from_utf8(desk.read(&format!("{folder}/report.html"))).unwrap();
        let summary = desk.summary(folder);
        let reported: Vec<String> = ["advice", "assumed_values"]
            .iter()
            .flat_map(|kind| ["changes", "values"].map(|list| &summary[*kind][list]))
            .flat_map(|list| list.as_array().cloned().unwrap_or_default())
            .map(|change| change["command"].as_str().unwrap().to_owned())
            .collect();
        assert!(reported.len() >= 6, "{reported:?}");
        // Each has a folder of its own beside that of the web.
        let folders: BTreeSet<&str> =
            reported.iter().filter_map(|line| Some(line.split_once("--out ")?.1)).collect();
        assert_eq!(folders.len(), reported.len(), "{reported:?}");
        assert!(folders.iter().all(|out| out.trim_matches('\'').starts_with(folder)), "{folders:?}");
        let on_page = commands(&report);
        assert!(reported.iter().all(|line| on_page.contains(line)), "{reported:#?} {on_page:#?}");
        // Of the second web only the names of the folders are other ones.
        if set_is_empty {
            paste_all(&desk, &[said, report], reported.len());
        }
    }
}

#[test]
#[ignore = "slow: a web for each command"]
fn every_command_of_a_new_line_and_of_a_check_can_be_pasted() {
    let desk = Desk::new();
    let numbers =
        ["--polymer", "pp", "--throughput", "0.5 g/min", "--dtex", "2 dtex", "--holes-per-metre", "100"];
    let more = ["--basis-weight", "0.5 g/m²", "--air-speed", "60 m/s"];
    let said = success(desk.spunlaid("new --web line.toml").args(numbers).args(more));
    // A small sheet and short flights, so that they take an instant; what is printed stays the same.
    let text = fs::read_to_string(desk.path("line.toml")).unwrap();
    let small = text
        .replace("\"1 m\"", "\"0.1 m\"")
        .replace("\"500 mm\"", "\"100 mm\"")
        .replace("duration = \"1 s\"", "duration = \"40 ms\"");
    fs::write(desk.path("line.toml"), small.replace("replicates = 8", "replicates = 2")).unwrap();
    let checked = success(&mut desk.spunlaid("check line.toml"));
    let set = success(&mut desk.with("check line.toml", &["line.throughput=0.4 g/min", "web.assumed=none"]));
    assert!(set.contains("--out results/line-throughput-0.4gmin-assumed-none"), "{set}");
    let of_file = commands(&text);
    assert!(of_file.len() >= 3, "{of_file:?}");
    paste_all(&desk, &[said, text, checked, set], 4);
}
