//! Finds the list, table or text of a TOML file that begins and has no end. The parser sees it where the file
//! ends, or in the lines between, which are right.

use super::slip::slip;
use crate::error::Fault;

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
    use crate::input::parse_case;

    /// Right lines around a broken one: the head of a case, and what follows.
    fn told(broken: &str) -> String {
        let text = format!(
            "version = 1 # a [bracket and a \" in a comment\n[fibre]\n{broken}\n\n[air]\n\
            velocity = \"10 m/s\"\n[run]\nseed = 1\n"
        );
        parse_case(&text, "a.toml", &[]).unwrap_err().to_string()
    }

    /// Every line and column was counted by hand: the place where a reader has to look.
    #[test]
    fn what_has_no_end_is_told_in_the_line_where_it_begins() {
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
            // What is wrong before it is told too, and the rest of the file is not.
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
            assert_eq!(told(broken), wanted, "{broken}");
        }
    }
}
