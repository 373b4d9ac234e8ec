//! Labels: their mark-up with italics and superscripts, their widths and lines.

use crate::glyphs;

/// How a piece of a label is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Setting {
    Upright,
    Italic,
    Raised,
    Lowered,
}

/// Size of raised and lowered text, as a share of the text beside it.
const SMALL: f64 = 0.72;

impl Setting {
    /// Size of a piece in a label of this size.
    pub(crate) fn size(self, size: f64) -> f64 {
        match self {
            Self::Upright | Self::Italic => size,
            Self::Raised | Self::Lowered => SMALL * size,
        }
    }

    /// How far below the line of the label its own line is.
    pub(crate) fn shift(self, size: f64) -> f64 {
        match self {
            Self::Upright | Self::Italic => 0.0,
            Self::Raised => -0.38 * size,
            Self::Lowered => 0.2 * size,
        }
    }
}

/// Splits the mark-up of the labels: `*t*` is italic, `^{2}` raised, `_{n}` lowered.
pub(crate) fn pieces(text: &str) -> Vec<(Setting, String)> {
    let mut pieces = vec![(Setting::Upright, String::new())];
    let mut chars = text.chars().peekable();
    let mut setting = Setting::Upright;
    while let Some(c) = chars.next() {
        let next = match (c, setting) {
            ('*', Setting::Italic) => Setting::Upright,
            ('*', Setting::Upright) => Setting::Italic,
            ('}', Setting::Raised | Setting::Lowered) => Setting::Upright,
            ('^' | '_', Setting::Upright) if chars.peek() == Some(&'{') => {
                chars.next();
                if c == '^' { Setting::Raised } else { Setting::Lowered }
            }
            _ => {
                if let Some((_, piece)) = pieces.last_mut() {
                    piece.push(c);
                }
                continue;
            }
        };
        setting = next;
        pieces.push((setting, String::new()));
    }
    pieces.retain(|(_, piece)| !piece.is_empty());
    pieces
}

/// A label without its mark-up.
pub fn plain(text: &str) -> String {
    pieces(text).into_iter().map(|(_, piece)| piece).collect()
}

/// The part of a label that is set upright: without symbols and what stands lowered beside them.
pub(crate) fn upright(text: &str) -> String {
    let upright = |(setting, _): &(Setting, String)| matches!(setting, Setting::Upright | Setting::Raised);
    pieces(text).into_iter().filter(upright).map(|(_, piece)| piece).collect()
}

/// Width of a label [px].
pub fn width(text: &str, size: f64) -> f64 {
    let width_of_piece = |(setting, piece): &(Setting, String)| {
        glyphs::width(piece, *setting == Setting::Italic, setting.size(size))
    };
    pieces(text).iter().map(width_of_piece).sum()
}

/// A label in lines that are no wider than the room, if its words allow it.
///
/// * `room` – [px]
pub fn lines(text: &str, size: f64, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if width(&format!("{line} {word}"), size) <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plain_label_has_no_mark_up() {
        assert_eq!(plain("*t* (10^{−3} s)"), "t (10−3 s)");
    }

    #[test]
    fn a_long_label_has_several_lines() {
        assert_eq!(lines("Change of *u* (m/s)", 10.0, 1000.0), ["Change of *u* (m/s)"]);
        let room = width("Change of", 10.0) + 0.1;
        assert_eq!(lines("Change of *u* (m/s)", 10.0, room), ["Change of", "*u* (m/s)"]);
    }
}
