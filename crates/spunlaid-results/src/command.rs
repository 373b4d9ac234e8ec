//! Commands that a reader can paste into a shell.

use spunlaid_experiment::Change;

/// A word of a command line, in quotes if the shell would not take it as one word. It stays in its line.
pub fn quoted(word: &str) -> String {
    if word.chars().all(|c| c.is_alphanumeric() || "-_./=:,+%".contains(c)) {
        return word.to_owned();
    }
    format!("'{}'", word.replace(char::is_control, "?").replace('\'', "'\\''"))
}

/// The command that lays a changed web, into a folder of its own.
///
/// * `beside` – the folder of the web itself, of which that of the changed one is named
pub fn web_command(change: &Change, beside: &str) -> String {
    let set = change
        .experiment
        .set
        .iter()
        .map(|(key, value)| format!(" --set {}", quoted(&format!("{key}={value}"))));
    let file = quoted(&change.experiment.file);
    format!("spunlaid web {file}{} --out {}", set.collect::<String>(), quoted(&folder(change, beside)))
}

/// The folder of a changed web: `results/line-depth-24mm`.
fn folder(change: &Change, beside: &str) -> String {
    let Some(key) = change.keys.first() else { return beside.to_owned() };
    let layers: String = change.layers.iter().map(|layer| format!("-layer{layer}")).collect();
    beside_of(&format!("{}{layers}", beside.trim_end_matches('/')), [(&*key.key, &*key.pretty(key.to))])
}

/// Most bytes of a name for settings; longer ones are distinguished by a number.
const LONGEST: usize = 48;

/// A folder of its own for results with some settings, beside that of the results without them:
/// `results/line-depth-24mm`.
pub fn beside_of<'a>(folder: &str, set: impl IntoIterator<Item = (&'a str, &'a str)>) -> String {
    let name = |(key, value): (&str, &str)| {
        let short = key.rsplit_once('.').map_or(key, |(_, short)| short);
        let words = format!("-{short}-{value}").replace('µ', "u").replace('_', "-");
        words.chars().filter(|c| c.is_ascii_alphanumeric() || "-.".contains(*c)).collect::<String>()
    };
    let (mut names, mut number) = (String::new(), 0_u32);
    for (key, value) in set {
        names += &name((key, value));
        let bytes = key.bytes().chain(value.bytes());
        number = bytes.fold(number, |number, byte| number.wrapping_mul(31).wrapping_add(u32::from(byte)));
    }
    if names.len() > LONGEST {
        names.truncate(LONGEST);
        names += &format!("-{number:08x}");
    }
    format!("{folder}{names}")
}
