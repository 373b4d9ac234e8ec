//! Commands that a reader can paste into a shell.

use spunlaid::advice::Change;

/// A word of a command line, in quotes if the shell would not take it as one word. It stays in its line.
pub fn quoted(word: &str) -> String {
    if word.chars().all(|c| c.is_alphanumeric() || "-_./=:,+%".contains(c)) {
        return word.to_owned();
    }
    format!("'{}'", word.replace(char::is_control, "?").replace('\'', "'\\''"))
}

/// The command that lays a changed web.
pub fn web_command(change: &Change) -> String {
    let set = change
        .experiment
        .set
        .iter()
        .map(|(key, value)| format!(" --set {}", quoted(&format!("{key}={value}"))));
    format!("spunlaid web {}{}", quoted(&change.experiment.file), set.collect::<String>())
}
