//! Lines that are longer than the terminal is wide: they go on below, under the column that they are of.

/// Least room for what goes on under the last column.
const LEAST: usize = 24;

/// The text in lines that are no wider, as far as its words allow it. A command stays in one line, so that it
/// can be pasted.
pub(super) fn wrapped(text: &str, width: usize) -> String {
    text.split_inclusive('\n')
        .map(
            |line| if is_command(line) || shown(line) <= width { line.to_owned() } else { wrap(line, width) },
        )
        .collect()
}

fn is_command(line: &str) -> bool {
    let line = line.trim_start();
    line.starts_with("spunlaid ") || line.starts_with("open ") || line.contains(": spunlaid ")
}

/// Columns of a line without its end and without colours.
fn shown(line: &str) -> usize {
    let mut is_colour = false;
    let counts = |c: &char| {
        let is_shown = !is_colour && *c != '\x1b' && !matches!(c, '\n' | '\r');
        is_colour = (is_colour || *c == '\x1b') && *c != 'm';
        is_shown
    };
    line.chars().filter(counts).count()
}

/// The last column of a line that has several: the first byte of it.
fn last_column(line: &str) -> Option<usize> {
    let line = line.trim_end();
    let begin = line.len() - line.trim_start_matches(' ').len();
    line.rfind("  ").map(|gap| gap + 2).filter(|column| *column > begin)
}

fn wrap(line: &str, width: usize) -> String {
    let (content, end) = line.strip_suffix('\n').map_or((line, ""), |content| (content, "\n"));
    // What goes on of a comment is one.
    if let Some(comment) = content.strip_prefix('#') {
        let below = wrap(comment, width.saturating_sub(1)).replace('\n', "\n#");
        return format!("#{below}{end}");
    }
    let begin = content.len() - content.trim_start_matches(' ').len();
    let last = last_column(content);
    // Under the last column if there is room, or else a little further in than the line begins.
    let place = last.map(|last| shown(&content[..last])).filter(|place| place + LEAST <= width);
    let indentation = place.unwrap_or(begin + 2);
    let mut text = String::new();
    let mut at = 0;
    let mut is_first = true;
    // Each word with the blanks before it.
    let mut rest = content;
    if let (Some(last), None) = (last, place)
        && shown(content[..last].trim_end()) <= width
    {
        text = format!("{}\n{}", content[..last].trim_end(), " ".repeat(indentation));
        (at, rest) = (indentation, &content[last..]);
    }
    while !rest.is_empty() {
        let blanks = rest.len() - rest.trim_start_matches(' ').len();
        let word = rest[blanks..].find(' ').map_or(rest.len(), |length| blanks + length);
        let (piece, after) = rest.split_at(word);
        if !is_first && at + shown(piece) > width {
            text.push('\n');
            text.push_str(&" ".repeat(indentation));
            text.push_str(piece.trim_start_matches(' '));
            at = indentation + shown(piece) - blanks;
        } else {
            text.push_str(piece);
            at += shown(piece);
        }
        (rest, is_first) = (after, false);
    }
    text + end
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_go_on_under_their_last_column() {
        let table = "  Mean      9.97  m/s  mean of u\n  Length    28.8  mm   integral time times the mean velocity\n";
        let wanted = "  Mean      9.97  m/s  mean of u\n  Length    28.8  mm   integral time times \
            the\n                       mean velocity\n";
        assert_eq!(wrapped(table, 47), wanted);
        // Where there is no room, a little further in than the line begins.
        let narrow = wrapped(table, 40);
        assert_eq!(narrow.lines().nth(1), Some("  Length    28.8  mm"), "{narrow}");
        assert_eq!(narrow.lines().nth(2), Some("    integral time times the mean"), "{narrow}");
        assert!(narrow.lines().all(|line| line.chars().count() <= 40));
    }

    #[test]
    fn colours_have_no_width_and_commands_stay_whole() {
        let note = "\x1b[36mnote:\x1b[0m one two three";
        assert_eq!(wrapped(note, 19), note);
        assert_eq!(wrapped(note, 18), "\x1b[36mnote:\x1b[0m one two\n  three");
        let command = "  spunlaid web my.toml --set 'line.basis_weight=15 g/m²'\n";
        assert_eq!(wrapped(command, 20), command);
        // Comments go on as comments.
        assert_eq!(wrapped("# one two three\n", 10), "# one two\n#   three\n");
        // What has no blank stays whole too.
        assert_eq!(wrapped("a_very_long_path/to/somewhere", 10), "a_very_long_path/to/somewhere");
    }
}
