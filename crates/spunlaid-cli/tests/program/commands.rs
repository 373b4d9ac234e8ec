//! Completions, help and colours.

use crate::desk::{Desk, refusal, success};

#[test]
fn completions_name_every_command_and_option() {
    let desk = Desk::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = success(&mut desk.spunlaid(&format!("completions {shell}")));
        for word in ["spunlaid", "run", "sweep", "check", "new", "replicates", "force"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
}

#[test]
fn help_teaches_with_examples() {
    let desk = Desk::new();
    for command in ["", "run", "sweep", "check", "new", "completions", "man"] {
        let help = success(&mut desk.spunlaid(&format!("{command} --help")));
        assert!(help.contains("Example") && help.contains(&format!("spunlaid {command}")), "{help}");
        assert!(!help.contains('\u{1b}'), "colour without a terminal");
    }
    assert!(success(&mut desk.spunlaid("--help")).contains("Exit codes: 0 done; 1 the input is wrong"));
    let version = success(&mut desk.spunlaid("--version"));
    assert_eq!(version, format!("spunlaid {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn errors_are_coloured_on_request_only() {
    let desk = Desk::new();
    let said = |key: &str| refusal(desk.spunlaid("check nowhere.toml").env(key, "1"), 1);
    assert!(said("CLICOLOR_FORCE").starts_with("\u{1b}["));
    assert!(said("NO_COLOR").starts_with("error:"));
}
