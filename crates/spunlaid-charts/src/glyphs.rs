//! The embedded font: the widths of texts, and texts as outlines, so that a picture needs no other font and no text layout.

use resvg::usvg::roxmltree::{Document, Node};
use std::fmt::Write;
use std::sync::LazyLock;
use ttf_parser::gpos::{PairAdjustment, PositioningSubtable};
use ttf_parser::{Face, GlyphId, OutlineBuilder};

const REGULAR: &[u8] = include_bytes!("../assets/fonts/Arimo-Regular.ttf");
const ITALIC: &[u8] = include_bytes!("../assets/fonts/Arimo-Italic.ttf");

static FONTS: LazyLock<[Option<Font<'static>>; 2]> =
    LazyLock::new(|| [REGULAR, ITALIC].map(|font| Face::parse(font, 0).ok().map(Font::new)));

fn font(italic: bool) -> Option<&'static Font<'static>> {
    FONTS[usize::from(italic)].as_ref()
}

/// Width of a piece of text [px].
pub(crate) fn width(text: &str, italic: bool, size: f64) -> f64 {
    font(italic)
        .map_or(0.0, |font| font.glyphs(text).map(|(_, advance)| advance).sum::<f64>() * font.scale(size))
}

/// The SVG with each text replaced by a path. It knows what [`Svg`](crate::svg::Svg) writes: texts with one position,
/// and pieces in them with a size, a style and a shift of the line.
///
/// # Errors
/// A string that is not XML.
pub(crate) fn outlined(svg: &str) -> Result<String, resvg::usvg::roxmltree::Error> {
    let document = Document::parse(svg)?;
    let mut outlined = String::with_capacity(2 * svg.len());
    let mut done = 0;
    for text in document.descendants().filter(|node| node.has_tag_name((SVG, "text"))) {
        outlined.push_str(&svg[done..text.range().start]);
        path(&mut outlined, text);
        done = text.range().end;
    }
    outlined.push_str(&svg[done..]);
    Ok(outlined)
}

const SVG: &str = "http://www.w3.org/2000/svg";

fn path(svg: &mut String, text: Node<'_, '_>) {
    let number = |node: Node<'_, '_>, name| -> Option<f64> { node.attribute(name)?.parse().ok() };
    let size = number(text, "font-size").unwrap_or(16.0);
    let (x, y) = (number(text, "x").unwrap_or(0.0), number(text, "y").unwrap_or(0.0));
    let mut pen = Pen { d: String::new(), x: 0.0, y: 0.0, scale: 1.0 };
    for piece in text.children() {
        let span = if piece.is_text() { None } else { Some(piece) };
        let of_span = |name| number(span?, name);
        pen.y += of_span("dy").unwrap_or(0.0);
        let italic = span.is_some_and(|span| span.attribute("font-style") == Some("italic"));
        if let Some(font) = font(italic) {
            font.write(piece.text().unwrap_or_default(), of_span("font-size").unwrap_or(size), &mut pen);
        }
    }
    let start = match text.attribute("text-anchor") {
        Some("middle") => x - 0.5 * pen.x,
        Some("end") => x - pen.x,
        _ => x,
    };
    let turn = text.attribute("transform").unwrap_or_default();
    let fill = text.attribute("fill").unwrap_or("#000000");
    let _ =
        write!(svg, "<path transform=\"{turn} translate({start} {y})\" fill=\"{fill}\" d=\"{}\"/>", pen.d);
}

/// A face with the distances of its pairs of glyphs.
struct Font<'a> {
    face: Face<'a>,
    pairs: Vec<PairAdjustment<'a>>,
}

impl<'a> Font<'a> {
    fn new(face: Face<'a>) -> Self {
        let mut pairs = Vec::new();
        if let Some(table) = face.tables().gpos {
            let lookups = table.features.into_iter().filter(|feature| feature.tag.to_bytes() == *b"kern");
            let mut lookups: Vec<u16> = lookups.flat_map(|feature| feature.lookup_indices).collect();
            lookups.sort_unstable();
            lookups.dedup();
            for lookup in lookups.into_iter().filter_map(|index| table.lookups.get(index)) {
                let subtables = lookup.subtables.into_iter::<PositioningSubtable<'_>>();
                pairs.extend(subtables.filter_map(|subtable| match subtable {
                    PositioningSubtable::Pair(pair) => Some(pair),
                    _ => None,
                }));
            }
        }
        Self { face, pairs }
    }

    /// Pixels per unit of the font.
    fn scale(&self, size: f64) -> f64 {
        size / f64::from(self.face.units_per_em())
    }

    /// The glyphs of a text, each with its distance to the next one [units of the font].
    fn glyphs(&self, text: &str) -> impl Iterator<Item = (GlyphId, f64)> {
        // The first glyph of a font shows that a character is missing.
        let glyph = |c| self.face.glyph_index(c).unwrap_or(GlyphId(0));
        let next = text.chars().skip(1).map(move |c| Some(glyph(c))).chain([None]);
        text.chars().map(glyph).zip(next).map(|(glyph, next)| {
            let closer = next.map_or(0, |next| self.closer(glyph, next));
            let advance = self.face.glyph_hor_advance(glyph).unwrap_or(0);
            (glyph, f64::from(advance) + f64::from(closer))
        })
    }

    /// Draws a piece of text and moves the pen behind it.
    fn write(&self, text: &str, size: f64, pen: &mut Pen) {
        pen.scale = self.scale(size);
        for (glyph, advance) in self.glyphs(text) {
            self.face.outline_glyph(glyph, pen);
            pen.x += advance * pen.scale;
        }
    }

    /// How much closer a pair of glyphs stands, in units of the font.
    fn closer(&self, first: GlyphId, second: GlyphId) -> i16 {
        let adjustment = |pair: &PairAdjustment<'_>| match pair {
            PairAdjustment::Format1 { coverage, sets } => {
                Some(sets.get(coverage.get(first)?)?.get(second)?.0.x_advance)
            }
            PairAdjustment::Format2 { coverage, classes, matrix } => {
                coverage.get(first)?;
                Some(matrix.get((classes.0.get(first), classes.1.get(second)))?.0.x_advance)
            }
        };
        self.pairs.iter().find_map(adjustment).unwrap_or(0)
    }
}

/// Writes the outlines of glyphs.
struct Pen {
    /// What a path is drawn by.
    d: String,
    /// Where the next glyph begins, from the start of the text [px].
    x: f64,
    y: f64,
    /// Pixels per unit of the font.
    scale: f64,
}

impl Pen {
    fn go(&mut self, command: char, points: &[(f32, f32)]) {
        self.d.push(command);
        for (x, y) in points {
            let (x, y) = (self.x + f64::from(*x) * self.scale, self.y - f64::from(*y) * self.scale);
            let _ = write!(self.d, "{x:.3} {y:.3} ");
        }
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.go('M', &[(x, y)]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.go('L', &[(x, y)]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.go('Q', &[(x1, y1), (x, y)]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.go('C', &[(x1, y1), (x2, y2), (x, y)]);
    }

    fn close(&mut self) {
        self.d.push('Z');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The corners of a text's outlines [px].
    fn corners(text: &str) -> Vec<(f64, f64)> {
        let svg = outlined(&format!("<svg xmlns=\"{SVG}\">{text}</svg>")).unwrap();
        assert!(!svg.contains("<text"), "{svg}");
        let (transform, d) = (between(&svg, "translate(", ")"), between(&svg, " d=\"", "\""));
        let numbers = |text: &str| -> Vec<f64> {
            text.split(|c: char| c.is_ascii_alphabetic() || c == ' ').filter_map(|n| n.parse().ok()).collect()
        };
        let at = numbers(transform);
        numbers(d).chunks(2).map(|point| (point[0] + at[0], point[1] + at[1])).collect()
    }

    fn between<'a>(text: &'a str, before: &str, after: &str) -> &'a str {
        text.split_once(before).unwrap().1.split_once(after).unwrap().0
    }

    fn extent(points: &[(f64, f64)]) -> [f64; 2] {
        points
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (x, _)| [low.min(*x), high.max(*x)])
    }

    #[test]
    fn texts_stand_where_they_are_anchored() {
        let text = |anchor: &str| {
            extent(&corners(&format!(
                "<text x=\"50\" y=\"20\" font-size=\"10\" text-anchor=\"{anchor}\">HHHH</text>"
            )))
        };
        let [start, middle, end] = ["start", "middle", "end"].map(text);
        // An H of Arimo is 1479 of 2048 units wide.
        let width = 40.0 * 1479.0 / 2048.0;
        assert!((start[0] - middle[0] - 0.5 * width).abs() < 2e-3, "{start:?} {middle:?}");
        assert!((start[1] - end[1] - width).abs() < 2e-3, "{start:?} {end:?}");
        assert!(start[0] > 50.0 && end[1] < 50.0);
    }

    #[test]
    fn pairs_of_letters_stand_closer() {
        let width = |text: &str| {
            let [low, high] = extent(&corners(&format!("<text font-size=\"10\">{text}</text>")));
            high - low
        };
        // Against the same letters without a close pair.
        assert!(
            width("HAV") < width("HVH") - width("H") + width("A") - 0.5,
            "{} {}",
            width("HAV"),
            width("HVH")
        );
    }

    #[test]
    fn pieces_are_italic_small_and_raised() {
        let plain = corners("<text y=\"20\" font-size=\"10\">x</text>");
        let italic = corners("<text y=\"20\" font-size=\"10\"><tspan font-style=\"italic\">x</tspan></text>");
        let raised =
            corners("<text y=\"20\" font-size=\"10\"><tspan dy=\"-4\" font-size=\"5\">x</tspan></text>");
        assert_ne!(plain, italic);
        for ((x, y), (small_x, small_y)) in plain.iter().zip(&raised) {
            assert!((0.5 * x - small_x).abs() < 2e-3 && (16.0 + 0.5 * (y - 20.0) - small_y).abs() < 2e-3);
        }
    }
}
