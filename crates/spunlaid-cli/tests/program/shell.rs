//! What a shell sees: completions, manual pages, standard input, the numbers of options.

use crate::desk::{Desk, refusal, success};
use std::fs;
use std::process::Command;

#[test]
fn completions_name_the_keys_of_each_command() {
    let desk = Desk::new();
    fs::write(desk.path("spunlaid.bash"), success(&mut desk.spunlaid("completions bash"))).unwrap();
    // What Bash offers for the last word of a line, as it splits the line.
    let offers = |words: &[&str]| -> Vec<String> {
        let line: Vec<String> = words.iter().map(|word| format!("'{word}'")).collect();
        let ask = format!(
            "compopt() {{ :; }}; source ./spunlaid.bash; COMP_WORDS=(spunlaid {}); COMP_CWORD={}; \
             _spunlaid_and_keys spunlaid '{}' '{}'; printf '%s\\n' \"${{COMPREPLY[@]}}\"",
            line.join(" "),
            words.len(),
            words[words.len() - 1],
            words.get(words.len().wrapping_sub(2)).unwrap_or(&"spunlaid"),
        );
        let output = Command::new("bash").args(["-c", &ask]).current_dir(desk.path("")).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect()
    };
    assert_eq!(offers(&["run", "my.toml", "--set", "air.record_m"]), ["air.record_max_gap="]);
    assert_eq!(offers(&["web", "my.toml", "--set", "line.belt_"]), ["line.belt_speed="]);
    assert_eq!(offers(&["spin", "my.toml", "--set", "air.vel"]), [""]);
    assert_eq!(offers(&["keys", "belt.sp"]), ["belt.speed"]);
    // A key that is no completion is taken all the same.
    assert!(success(&mut desk.spunlaid("keys stiff")).contains("fibre.youngs_modulus"));
    success(&mut desk.with("check brief.toml", &["air.velocity=20 m/s"]));
}

#[test]
fn manual_pages_are_written_for_every_command() {
    let desk = Desk::new();
    let said = success(&mut desk.spunlaid("man pages/man1"));
    assert_eq!(said, "wrote the manual pages to pages/man1; man spunlaid shows the first\n");
    let pages = desk.entries("pages/man1");
    for name in ["spunlaid.1", "spunlaid-run.1", "spunlaid-sweep.1", "spunlaid-man.1"] {
        assert!(pages.contains(name), "{pages:?}");
    }
    let run = String::from_utf8(desk.read("pages/man1/spunlaid-run.1")).unwrap();
    assert!(run.contains(".TH") && run.contains("replicates") && run.contains("origin.toml"), "{run}");
    // Again they are renewed.
    success(&mut desk.spunlaid("man pages/man1"));
    fs::write(desk.path("file"), "mine").unwrap();
    assert!(refusal(&mut desk.spunlaid("man file"), 2).contains("file: cannot be written"));
}

#[test]
fn a_case_may_come_from_standard_input() {
    let desk = Desk::new();
    let piped = |arguments: &str, text: &[u8]| {
        fs::write(desk.path("input"), text).unwrap();
        let input = fs::File::open(desk.path("input")).unwrap();
        desk.spunlaid(arguments).stdin(input).output().unwrap()
    };
    let case = desk.read("brief.toml");
    assert!(piped("run - --quiet", &case).status.success());
    assert!(desk.entries("results/case").contains("summary.json"));
    success(&mut desk.spunlaid("run brief.toml --out r"));
    assert!(desk.read("r/end_node.parquet") == desk.read("results/case/end_node.parquet"));
    // What came from there before is unknown, so nothing is replaced.
    let refused = piped("run -", &case);
    assert_eq!(refused.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("results/case: holds results already"));
    let summary = piped("run - --json --quiet --set air.velocity=20m/s", &case);
    assert!(String::from_utf8_lossy(&summary.stdout).contains("\"velocity_m_s\": 20.0"));
    assert!(piped("check -", &case).status.success());
}
