//! Tecplot's text files of points, as tables.
//!
//! ```text
//! TITLE = "…"
//! VARIABLES = "X" "Y" "Z" "U" "V" "W"        the names may stand on lines of their own
//! ZONE T="…", I=20, J=10, DATAPACKING=POINT   or F=POINT; for cells N=200, E=171, which are listed after the points
//! 0.0 0.0 0.0 10.0 0.0 0.0
//! ```

use crate::error::{Fault, FileError, Position};
use crate::field::fault;
use crate::units::shortest;
use std::borrow::Cow;

/// A zone: the points that follow a line `ZONE`.
struct Zone {
    /// Its line, from 1.
    line: u64,
    /// What it says about itself, in capitals and without texts in quotation marks.
    says: Vec<String>,
    /// Number of rows found.
    rows: usize,
}

impl Zone {
    fn says(&self, key: &str) -> Option<&str> {
        let at = self.says.iter().position(|word| word == key)?;
        self.says.get(at + 1).map(String::as_str)
    }

    fn number(&self, keys: [&str; 2]) -> Option<usize> {
        keys.into_iter().find_map(|key| self.says(key)?.parse().ok())
    }

    /// Number of points, if it is said.
    fn points(&self) -> Option<usize> {
        self.number(["N", "NODES"]).or_else(|| {
            let axis = |key| self.number([key, key]).unwrap_or(1);
            self.number(["I", "I"])?.checked_mul(axis("J"))?.checked_mul(axis("K"))
        })
    }

    /// Whether the file lists cells after the points.
    fn has_cells(&self) -> bool {
        self.number(["E", "ELEMENTS"]).is_some()
    }

    /// Checks how the values are listed, before the first row.
    fn check(&self) -> Result<(), FileError> {
        let found = match self.says("DATAPACKING").or(self.says("F")) {
            Some("POINT" | "FEPOINT") => return Ok(()),
            Some(_) => "a Tecplot file in blocks",
            None => "a Tecplot file that does not say whether its values are in points or in blocks",
        };
        let advice = "write it with one row for each point, and DATAPACKING=POINT in the line ZONE";
        Err(self.blame(Fault::format(found, advice)))
    }

    /// Checks the number of points, after the last row.
    fn close(&self) -> Result<(), FileError> {
        match self.points() {
            Some(wanted) if wanted != self.rows => {
                Err(self.blame(fault::count(self.rows, wanted, "rows of points")))
            }
            _ => Ok(()),
        }
    }

    fn blame(&self, fault: Fault) -> FileError {
        FileError::from(fault).at(Position::Line(self.line))
    }
}

/// The file as a table with a line of names, if it is one of Tecplot's; other files as they are. Lines keep their
/// numbers.
pub(super) fn as_table(bytes: &[u8]) -> Result<Cow<'_, [u8]>, FileError> {
    let first = lines(bytes).find(|line| !line.is_empty() && !line.starts_with(b"#"));
    if !first.is_some_and(|line| ["TITLE", "VARIABLES", "ZONE"].iter().any(|word| assigns(line, word))) {
        return Ok(Cow::Borrowed(bytes));
    }
    let (mut table, mut names, mut named) = (Vec::new(), Vec::new(), false);
    let (mut zone, mut in_names): (Option<Zone>, _) = (None, false);
    let mut time: Option<f64> = None;
    for (line, number) in lines(bytes).zip(1..) {
        if is_row(line) {
            let Some(zone) = &mut zone else {
                let fault = fault::syntax("a number", "the line ZONE");
                return Err(FileError::from(fault).at(Position::Line(number)));
            };
            if zone.rows == 0 {
                zone.check()?;
                let own = zone.says("SOLUTIONTIME").and_then(|time| time.parse().ok());
                if let (Some(first), Some(own)) = (time, own)
                    && first != own
                {
                    return Err(zone.blame(several_times(first, own)));
                }
                time = time.or(own);
            }
            if !named {
                // The last line above is empty by now: the names go there.
                table.pop();
                table.extend(format!("{}\n", names.join("\t")).bytes());
                named = true;
            }
            if !zone.has_cells() || zone.points().is_none_or(|points| zone.rows < points) {
                table.extend(line);
                zone.rows += 1;
            }
        } else if !line.starts_with(b"#") {
            let text = String::from_utf8_lossy(line);
            if assigns(line, "VARIABLES") {
                in_names = true;
                names.extend(listed(text.split_once('=').map_or("", |(_, after)| after)));
            } else if starts(line, "ZONE") {
                zone.iter().try_for_each(Zone::close)?;
                (in_names, zone) = (false, Some(Zone { line: number, says: words(&text), rows: 0 }));
            } else if in_names && line.starts_with(b"\"") {
                names.extend(listed(&text));
            } else if let Some(zone) = zone.as_mut().filter(|zone| zone.rows == 0) {
                zone.says.extend(words(&text));
            }
        }
        table.push(b'\n');
    }
    zone.iter().try_for_each(Zone::close)?;
    Ok(Cow::Owned(table))
}

/// The zones are the same points at several times, and the air of a field is that of one.
fn several_times(first: f64, other: f64) -> Fault {
    let [first, other] = [first, other].map(shortest);
    Fault::new(
        format!(
            "has SOLUTIONTIME {other}, and a zone before it has {first}; the mean flow of a field is that of one time"
        ),
        "write the zones of one time only, or the mean over time",
    )
}

fn lines(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    bytes.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii)
}

fn starts(line: &[u8], word: &str) -> bool {
    line.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word.as_bytes()))
        && !line.get(word.len()).is_some_and(u8::is_ascii_alphanumeric)
}

/// Whether a line is `WORD = …`, or begins a zone.
fn assigns(line: &[u8], word: &str) -> bool {
    starts(line, word) && line.contains(&b'=')
}

fn is_row(line: &[u8]) -> bool {
    line.first().is_some_and(|byte| byte.is_ascii_digit() || matches!(byte, b'+' | b'-' | b'.'))
        || starts(line, "nan")
}

/// The names in a list, each in quotation marks.
fn listed(text: &str) -> Vec<String> {
    let quoted = |name: &str| format!("\"{}\"", name.replace('\t', " "));
    if text.contains('"') {
        text.split('"').skip(1).step_by(2).map(quoted).collect()
    } else {
        let parts = text.split([',', ' ', '\t']);
        parts.filter(|name| !name.is_empty()).map(quoted).collect()
    }
}

/// The words of a line of a zone, without texts in quotation marks.
fn words(text: &str) -> Vec<String> {
    let bare: Vec<&str> = text.split('"').step_by(2).collect();
    let joined = bare.join(" ").to_uppercase();
    joined.split([',', '=', ' ', '\t', '(', ')']).filter(|word| !word.is_empty()).map(str::to_owned).collect()
}
