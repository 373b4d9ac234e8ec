//! What is wrong with a line that is not TOML, and the line as it should be.

use spunlaid_ground::Fault;
use spunlaid_ground::error::shortest;
use spunlaid_ground::units::readings;
use toml::de::DeTable;

/// Signs that stand before comments in other languages.
const COMMENTS: [&str; 5] = ["//", "/*", ";", "%", "!"];
/// Quotes of keyboards and of word processors.
const QUOTES: [char; 12] = ['"', '\'', '“', '”', '„', '‟', '‘', '’', '‚', '«', '»', '`'];

/// The slip in a line; `None` if it is none of the usual ones. A line that is offered is TOML.
pub(super) fn slip(line: &str) -> Option<Fault> {
    let line = line.trim();
    if is_toml(line) {
        return None;
    }
    if let Some(rest) = COMMENTS.iter().find_map(|sign| line.strip_prefix(sign)) {
        return offer("is a comment of another language", &format!("# {}", rest.trim()));
    }
    if line.starts_with('[') {
        let name = before_comment(line).trim_matches(|c: char| c == '[' || c == ']' || c.is_whitespace());
        let header = if line.starts_with("[[") { format!("[[{name}]]") } else { format!("[{name}]") };
        return offer("is not a whole table header", &header);
    }
    if let Some(name) = before_comment(line).trim().strip_suffix(']').filter(|name| is_key(name)) {
        return offer("is not a whole table header", &format!("[{name}]"));
    }
    if let Some((first, second)) = two_keys(line) {
        let what = "the line has two keys, and each needs a line of its own";
        return Some(Fault::new(what, format!("write {first} and, below it, {second}")));
    }
    let end = line.find(|c: char| c == '=' || c == ':' || c.is_whitespace())?;
    let (key, rest) = line.split_at_checked(end)?;
    if !is_key(key) {
        // A part of a list or of a text.
        return None;
    }
    let rest = rest.trim_start();
    let has_sign = rest.starts_with(['=', ':']);
    let (sign, value) = match rest {
        value if value.starts_with('=') => (true, value.trim_start_matches('=')),
        value => (false, value.strip_prefix(':').unwrap_or(value)),
    };
    let written = before_comment(value).trim();
    if written.is_empty() {
        return Some(Fault::new(format!("{key} has no value"), format!("write one, as in {key} = …")));
    }
    if is_toml(&format!("{key} = {written}")) {
        let what = match (sign, rest.starts_with("==")) {
            (_, true) => "has more than one =",
            (true, _) => "has text behind its value",
            (false, _) => "has no = between key and value",
        };
        return offer(what, &format!("{key} = {written}"));
    }
    if !has_sign {
        // Words, which are no value of a key.
        return None;
    }
    let bare = written.trim_matches(|c: char| QUOTES.contains(&c) || c.is_whitespace());
    if bare.is_empty() || bare.starts_with(['[', '{']) || bare.contains(QUOTES) {
        return None;
    }
    if written == format!("\"{bare}\"") && bare.contains('\\') {
        let what = "has a backslash between double quotes, where it begins a sign such as \\n; between \
            single quotes it is itself";
        return offer(what, &format!("{key} = '{bare}'"));
    }
    let is_number = |text: &str| text.parse::<f64>().is_ok_and(f64::is_finite);
    let number = bare.split_whitespace().next().unwrap_or(bare);
    let point = number.replacen(',', ".", 1);
    let has_comma = point != number && is_number(&point);
    let thousands =
        readings(number)[0].as_ref().filter(|_| has_comma).map(|whole| bare.replacen(number, whole, 1));
    let bare = if has_comma { bare.replacen(',', ".", 1) } else { bare.to_owned() };
    let short = is_number(&bare) && !has_comma && !is_toml(&format!("{key} = {bare}"));
    let bare = if short { shortest(bare.parse().ok()?) } else { bare };
    let what = if short {
        "has a number without a digit before or behind its point, or with a zero before it"
    } else if thousands.is_some() {
        "has a comma, which is a decimal sign or separates thousands"
    } else if has_comma {
        "has a decimal comma"
    } else if written.starts_with(['"', '\'']) || written.ends_with(['"', '\'']) {
        "has a quote at one end only"
    } else if written.contains(QUOTES) {
        "has quotes that are not straight"
    } else {
        "has a value without quotes"
    };
    let is_bare = is_number(&bare) && !written.starts_with(QUOTES);
    let value = |bare: String| if is_bare { bare } else { format!("\"{bare}\"") };
    let fault = offer(what, &format!("{key} = {}", value(bare)))?;
    match thousands {
        Some(whole) => {
            Some(Fault { remedy: format!("{}, or {key} = {}", fault.remedy, value(whole)).into(), ..fault })
        }
        None => Some(fault),
    }
}

/// Whether a text could be a key, or several with points between.
fn is_key(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || ['_', '-', '.'].contains(&c))
}

/// The two lines that stand in one.
fn two_keys(line: &str) -> Option<(&str, &str)> {
    let line = before_comment(line);
    let gaps = line.match_indices([' ', '\t', ';', ',']);
    let mut halves =
        gaps.filter_map(|(at, sign)| Some((line.get(..at)?.trim(), line.get(at + sign.len()..)?.trim())));
    halves.find(|(first, second)| {
        first.contains('=') && second.contains('=') && is_toml(first) && is_toml(second)
    })
}

/// The fault, if the line that is offered instead is TOML.
fn offer(what: &str, line: &str) -> Option<Fault> {
    is_toml(line).then(|| Fault::new(format!("the line {what}"), format!("write {line}")))
}

fn is_toml(line: &str) -> bool {
    DeTable::parse(line).is_ok()
}

/// What stands before the comment of a line; a comment starts behind a space.
fn before_comment(text: &str) -> &str {
    let starts = [" #", "\t#", " //"].iter().filter_map(|sign| text.find(sign));
    text.get(..starts.min().unwrap_or(text.len())).unwrap_or(text)
}

/// What begins and has no end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unclosed {
    /// Index of the byte at which it begins.
    pub(super) at: usize,
    /// What it begins with, what it is, and what would end it.
    signs: (&'static str, &'static str, &'static str),
}

/// Texts of several lines: begin, noun, end.
const TEXTS: [(&str, &str, &str); 2] = [("\"\"\"", "text", "\"\"\""), ("'''", "text", "'''")];
/// Lists, and tables in one line.
const BRACKETS: [(&str, &str, &str); 2] = [("[", "list", "]"), ("{", "table", "}")];

impl Unclosed {
    /// The outermost of those that are open at the end of a text.
    pub(super) fn find(text: &str) -> Option<Self> {
        let mut open: Vec<Self> = Vec::new();
        let mut at = 0;
        while let Some(rest) = text.get(at..).filter(|rest| !rest.is_empty()) {
            let begun = |(sign, ..): &&(&str, &str, &str)| rest.starts_with(sign);
            at += if let Some(signs) = TEXTS.iter().find(begun) {
                let within = rest.get(3..).unwrap_or_default();
                match end_of_text(within, signs.2) {
                    Some(length) => 3 + length,
                    None => {
                        // A text that is open inside of a list is the reason why the list is open.
                        open.clear();
                        open.push(Self { at, signs: *signs });
                        rest.len()
                    }
                }
            } else if rest.starts_with(['"', '\'']) {
                1 + end_of_line_text(rest)
            } else if rest.starts_with('#') {
                rest.find('\n').unwrap_or(rest.len())
            } else {
                if let Some(signs) = BRACKETS.iter().find(begun) {
                    open.push(Self { at, signs: *signs });
                } else if open.last().is_some_and(|last| rest.starts_with(last.signs.2)) {
                    open.pop();
                }
                rest.chars().next().map_or(1, char::len_utf8)
            };
        }
        open.first().copied()
    }

    /// What is wrong, and the line as it should be.
    pub(super) fn fault(&self, text: &str) -> Fault {
        let start = text.get(..self.at).and_then(|before| before.rfind('\n')).map_or(0, |end| end + 1);
        let line = text.get(start..).and_then(|rest| rest.lines().next()).unwrap_or_default();
        let (begin, noun, end) = self.signs;
        if let Some(fault) = slip(line) {
            return fault;
        }
        let next = text.get(start..).and_then(|rest| rest.lines().nth(1)).unwrap_or_default().trim();
        let message = format!("the {noun} that begins with {begin} in this line has no end");
        let is_all = next.is_empty() || next.starts_with('[') || next.contains('=');
        let space = if end == "}" { " " } else { "" };
        let whole =
            format!("{}{space}{end}", line.split(" #").next().unwrap_or(line).trim().trim_end_matches(','));
        match is_all && toml::de::DeTable::parse(&whole).is_ok() {
            true => Fault::new(message, format!("write {whole}")),
            false => Fault::new(message, format!("close it with {end}")),
        }
    }
}

/// Bytes of a text of several lines with its end; `None` if it has none.
fn end_of_text(within: &str, end: &str) -> Option<usize> {
    let mut from = 0;
    loop {
        let found = from + within.get(from..)?.find(end)?;
        let slashes = within.get(..found)?.bytes().rev().take_while(|byte| *byte == b'\\').count();
        if end == "'''" || slashes.is_multiple_of(2) {
            // Up to two more quotes belong to the text.
            let sign = end.get(..1)?;
            let more =
                (0..2).take_while(|i| within.get(found + 3 + i..).is_some_and(|x| x.starts_with(sign)));
            return Some(found + 3 + more.count());
        }
        from = found + 1;
    }
}

/// Bytes from the quote at the start of `rest` to the quote that ends the text, or to the end of the line.
fn end_of_line_text(rest: &str) -> usize {
    let mut bytes = rest.bytes().enumerate();
    let quote = bytes.next().map(|(_, byte)| byte);
    while let Some((at, byte)) = bytes.next() {
        match byte {
            b'\\' if quote == Some(b'"') => drop(bytes.next()),
            b'\n' => return at - 1,
            _ if Some(byte) == quote => return at,
            _ => {}
        }
    }
    rest.len() - 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_is_named_and_the_line_is_written_as_it_should_be() {
        for (line, what, right) in [
            ("diameter = 50 µm    # um or \"18 dtex\"", "without quotes", "diameter = \"50 µm\""),
            ("turbulence_intensity = 0,1 # rms; \"10 %\"", "decimal comma", "turbulence_intensity = 0.1"),
            ("diameter = 0,05 mm", "decimal comma", "diameter = \"0.05 mm\""),
            (
                "modulus = 1,500 MPa",
                "separates thousands",
                "modulus = \"1.500 MPa\", or modulus = \"1500 MPa\"",
            ),
            ("diameter = \"50 µm    # or \"18.7 dtex\"", "one end only", "diameter = \"50 µm\""),
            ("diameter = 50 µm\"", "one end only", "diameter = \"50 µm\""),
            ("diameter = “50 µm”", "not straight", "diameter = \"50 µm\""),
            ("diameter: \"50 µm\"\r", "no =", "diameter = \"50 µm\""),
            ("diameter\t\"50 µm\"", "no =", "diameter = \"50 µm\""),
            ("seed = 1 // of the noise", "behind its value", "seed = 1"),
            ("[fibre", "table header", "[fibre]"),
            ("[[layer]", "table header", "[[layer]]"),
            ("// a note", "comment", "# a note"),
            ("air] # of the diffuser", "table header", "[air]"),
            ("length == \"1 m\"", "more than one =", "length = \"1 m\""),
            ("turbulence_intensity = .1", "number", "turbulence_intensity = 0.1"),
            ("turbulence_intensity = 1.", "number", "turbulence_intensity = 1"),
            ("seed = 007", "number", "seed = 7"),
            ("field = \"C:\\users\\x.vtu\" # of Monday", "backslash", "field = 'C:\\users\\x.vtu'"),
            (
                "length = \"1 m\" diameter = \"50 µm\"",
                "two keys",
                "length = \"1 m\" and, below it, diameter = \"50 µm\"",
            ),
            ("seed = 1, replicates = 3", "two keys", "seed = 1 and, below it, replicates = 3"),
        ] {
            let fault = slip(line).unwrap();
            assert!(fault.message.contains(what), "{line}: {}", fault.message);
            assert_eq!(fault.remedy, format!("write {right}"), "{line}");
        }
        assert_eq!(slip("diameter =  # none").unwrap().message, "diameter has no value");
        for line in ["seed = 1", "this is a note", "density ratio = 3", "\"a\" \"b\""] {
            assert!(slip(line).is_none(), "{line}");
        }
    }
}

#[cfg(test)]
mod tests_of_unclosed {
    use crate::read_case;

    /// Right lines around a broken one: the head of a case, and what follows.
    fn message_of(broken: &str) -> String {
        let text = format!(
            "version = 1 # a [bracket and a \" in a comment\n[fibre]\n{broken}\n\n[air]\n\
            velocity = \"10 m/s\"\n[run]\nseed = 1\n"
        );
        read_case((&text, "a.toml"), &[]).unwrap_err().to_string()
    }

    /// Every line and column was counted by hand: the place where a reader has to look.
    #[test]
    fn what_has_no_end_is_reported_in_the_line_where_it_begins() {
        let list = "the list that begins with [ in this line has no end";
        let text = "the text that begins with \"\"\" in this line has no end";
        for (broken, wanted) in [
            ("direction = [1.0, 0.0, 0.0", format!("a.toml:3:13: {list}; write direction = [1.0, 0.0, 0.0]")),
            (
                "direction = [1.0, 0.0, 0.0, # along x",
                format!(
                    "a.toml:3:13: {list}; write direction = [1.0, \
                0.0, 0.0]"
                ),
            ),
            ("direction = [\n  1.0, # ]\n  0.0,\n", format!("a.toml:3:13: {list}; close it with ]")),
            ("a = [[1, 2], [3, 4]", format!("a.toml:3:5: {list}; write a = [[1, 2], [3, 4]]")),
            (
                "a = { b = 1, c = \"}\"",
                "a.toml:3:5: the table that begins with \
                { in this line has no end; write a = { b = 1, c = \"}\" }"
                    .to_owned(),
            ),
            ("note = \"\"\"\nof Monday", format!("a.toml:3:8: {text}; close it with \"\"\"")),
            (
                "density = \"\"\"950 kg/m³",
                "a.toml:3:11: the line has a quote at one end only; write density \
                = \"950 kg/m³\""
                    .to_owned(),
            ),
            (
                "density = '''950 kg/m³",
                "a.toml:3:11: the line has a quote at one end only; write density = \
                \"950 kg/m³\""
                    .to_owned(),
            ),
            ("a = [\"\"\"x\n\"]", format!("a.toml:3:6: {text}; close it with \"\"\"")),
            // What is wrong before it is reported too, and the rest of the file is not.
            (
                "length = 1,5 m\na = [1",
                format!(
                    "a.toml:3:11: the line has a decimal comma; write length = \
                \"1.5 m\"\na.toml:4:5: {list}; write a = [1]"
                ),
            ),
            // Closed ones are no matter, whatever they hold.
            (
                "a = [\"[\", '[', \"\"\"[ \\\"\"\" [\"\"\"\"]\n\
                b = 1,5 m",
                "a.toml:4:6: the line has a decimal comma; write b = \"1.5 m\"".to_owned(),
            ),
            ("b = \"x[", "a.toml:3:8: the line has a quote at one end only; write b = \"x[\"".to_owned()),
        ] {
            assert_eq!(message_of(broken), wanted, "{broken}");
        }
    }
}
