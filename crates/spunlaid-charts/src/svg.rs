//! Writing SVG: numbers, escaping, text with italics and superscripts.

use crate::glyphs;
use crate::palette::{Marker, PAPER};
use std::fmt::Write;

/// Where a text is anchored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// At its start.
    Start,
    /// In its middle.
    Middle,
    /// At its end.
    End,
}

/// An SVG picture in the making.
///
/// Coordinates that are not finite are the caller's mistake; an element that has one is left out.
#[derive(Debug)]
pub struct Svg {
    body: String,
}

/// Families as wide as the embedded font (Arimo), so that SVG and PNG look alike.
const FONTS: &str = "Arimo, Arial, Helvetica, 'Liberation Sans', sans-serif";

/// A corner of a rectangle and the opposite one.
pub type Rectangle = ((f64, f64), (f64, f64));

impl Svg {
    /// An empty picture on white.
    ///
    /// * `title` – for those who do not see it
    pub fn new(width: f64, height: f64, title: &str) -> Self {
        let (w, h) = (number(width), number(height));
        let body = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
             font-family=\"{FONTS}\" role=\"img\">\n<title>{}</title>\n\
             <rect width=\"{w}\" height=\"{h}\" fill=\"#ffffff\"/>\n",
            escape(&plain(title))
        );
        Self { body }
    }

    /// Closes the picture.
    pub fn finish(mut self) -> String {
        self.body.push_str("</svg>\n");
        self.body
    }

    /// Opens a group that is drawn inside a rectangle only; `id` must be the document's only one.
    pub fn open_clip(&mut self, id: &str, x: f64, y: f64, width: f64, height: f64) {
        let _ = writeln!(
            self.body,
            "<clipPath id=\"{id}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n\
             <g clip-path=\"url(#{id})\">",
            number(x),
            number(y),
            number(width),
            number(height)
        );
    }

    /// Opens a group whose origin is so far down.
    pub fn open_shifted(&mut self, down: f64) {
        let _ = writeln!(self.body, "<g transform=\"translate(0 {})\">", number(down));
    }

    /// Closes a group.
    pub fn close(&mut self) {
        self.body.push_str("</g>\n");
    }

    /// A straight line.
    pub fn line(&mut self, from: (f64, f64), to: (f64, f64), stroke: &Stroke<'_>) {
        self.path(&[from, to], stroke);
    }

    /// Joined straight lines.
    pub fn path(&mut self, points: &[(f64, f64)], stroke: &Stroke<'_>) {
        if points.is_empty() || !all_finite(points) {
            return;
        }
        let d = outline(points);
        let _ = writeln!(self.body, "<path d=\"{d}\" fill=\"none\" {}/>", stroke.attributes());
    }

    /// A filled polygon, with an outline where `stroke` is given.
    pub fn polygon(&mut self, points: &[(f64, f64)], fill: &str, opacity: f64, stroke: Option<&Stroke<'_>>) {
        if points.is_empty() || !all_finite(points) {
            return;
        }
        let d = outline(points);
        let stroke = stroke.map_or_else(String::new, |s| format!(" {}", s.attributes()));
        let opacity =
            if opacity < 1.0 { format!(" fill-opacity=\"{}\"", number(opacity)) } else { String::new() };
        let _ = writeln!(self.body, "<path d=\"{d}Z\" fill=\"{fill}\"{opacity}{stroke}/>");
    }

    /// Filled rectangles of one colour, each from a corner to the opposite one, with sharp edges.
    pub fn rectangles(&mut self, rectangles: &[Rectangle], fill: &str) {
        let _ = write!(self.body, "<path fill=\"{fill}\" shape-rendering=\"crispEdges\" d=\"");
        for ((left, bottom), (right, top)) in rectangles {
            let [l, b, r, t] = [left, bottom, right, top].map(|value| number(*value));
            let _ = write!(self.body, "M{l} {b}H{r}V{t}H{l}Z");
        }
        self.body.push_str("\"/>\n");
    }

    /// A circle.
    pub fn circle(&mut self, (x, y): (f64, f64), radius: f64, fill: &str, stroke: &Stroke<'_>) {
        if !all_finite(&[(x, y)]) {
            return;
        }
        let _ = writeln!(
            self.body,
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{fill}\" {}/>",
            number(x),
            number(y),
            number(radius),
            stroke.attributes()
        );
    }

    /// A marker: all are hollow but the spot.
    pub fn marker(&mut self, at: (f64, f64), marker: Marker, colour: &str) {
        let stroke = Stroke::solid(colour, 1.5);
        let (x, y) = at;
        match marker {
            Marker::Circle => self.circle(at, 3.9, PAPER, &stroke),
            Marker::Triangle => {
                // As large as the circle, its centre of mass on the point.
                let r = 5.2;
                let corners = [(x, y - r), (x + 0.866 * r, y + 0.5 * r), (x - 0.866 * r, y + 0.5 * r)];
                self.polygon(&corners, PAPER, 1.0, Some(&stroke));
            }
            Marker::Square => {
                let h = 3.5;
                let corners = [(x - h, y - h), (x + h, y - h), (x + h, y + h), (x - h, y + h)];
                self.polygon(&corners, PAPER, 1.0, Some(&stroke));
            }
            Marker::Diamond => {
                let r = 4.9;
                self.polygon(&[(x, y - r), (x + r, y), (x, y + r), (x - r, y)], PAPER, 1.0, Some(&stroke));
            }
            Marker::Spot => self.circle(at, 3.4, colour, &stroke),
        }
    }

    /// A text in the mark-up of [`plain`], turned a quarter to the left where `upright` is false.
    pub fn text(&mut self, (x, y): (f64, f64), text: &str, style: Text<'_>) {
        let (x, y) = (number(x), number(y));
        let anchor = match style.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let turn = if style.upright { String::new() } else { format!(" transform=\"rotate(-90 {x} {y})\"") };
        let _ = writeln!(
            self.body,
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"{anchor}\" textLength=\"{}\" \
             lengthAdjust=\"spacingAndGlyphs\" fill=\"{}\"{turn}>{}</text>",
            number(style.size),
            // Another font is fitted to the width that the layout counts on.
            number(width(text, style.size)),
            style.colour,
            spans(text, style.size)
        );
    }
}

/// A finished picture with its size in millimetres, so many for each pixel.
pub(crate) fn in_millimetres(svg: &str, per_pixel: f64) -> String {
    ["width", "height"].iter().fold(svg.to_owned(), |svg, side| {
        let start = format!(" {side}=\"");
        let place = svg.find(&start).map(|place| place + start.len());
        let sized = place.and_then(|place| {
            let (before, rest) = svg.split_at(place);
            let (pixels, after) = rest.split_once('"')?;
            let length = pixels.parse::<f64>().ok()? * per_pixel;
            Some(format!("{before}{}mm\"{after}", number(length)))
        });
        sized.unwrap_or(svg)
    })
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Stroke<'a> {
    /// Colour.
    pub colour: &'a str,
    /// Width [px].
    pub width: f64,
    /// Dashes and gaps, as SVG has them.
    pub dash: Option<&'a str>,
}

impl<'a> Stroke<'a> {
    /// A solid line.
    pub const fn solid(colour: &'a str, width: f64) -> Self {
        Self { colour, width, dash: None }
    }

    fn attributes(&self) -> String {
        let dash = self.dash.map_or_else(String::new, |d| format!(" stroke-dasharray=\"{d}\""));
        format!(
            "stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"{dash}",
            self.colour,
            number(self.width)
        )
    }
}

/// How a text is set.
#[derive(Clone, Copy, Debug)]
pub struct Text<'a> {
    /// Size [px].
    pub size: f64,
    /// Colour.
    pub colour: &'a str,
    /// Where its position is.
    pub anchor: Anchor,
    /// Not turned to run upwards.
    pub upright: bool,
}

fn all_finite(points: &[(f64, f64)]) -> bool {
    points.iter().all(|(x, y)| x.is_finite() && y.is_finite())
}

fn outline(points: &[(f64, f64)]) -> String {
    let mut d = String::with_capacity(points.len() * 12);
    for (i, &(x, y)) in points.iter().enumerate() {
        let _ = write!(d, "{}{} {}", if i == 0 { 'M' } else { 'L' }, number(x), number(y));
    }
    d
}

/// A coordinate to a hundredth of a pixel, short.
fn number(x: f64) -> String {
    let rounded = (x.clamp(-1e5, 1e5) * 100.0).round() / 100.0;
    // Plus zero: no `-0`.
    format!("{}", rounded + 0.0)
}

/// The five characters that mean something to XML.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            _ => escaped.push(c),
        }
    }
    escaped
}

/// How a piece of text is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Setting {
    Upright,
    Italic,
    Raised,
    Lowered,
}

/// Splits the mark-up of the labels: `*t*` is italic, `^{2}` raised, `_{n}` lowered.
fn pieces(text: &str) -> Vec<(Setting, String)> {
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

/// Size of raised and lowered text, as a share of the text beside it.
const SMALL: f64 = 0.72;

fn spans(text: &str, size: f64) -> String {
    let mut svg = String::new();
    // How far the baseline has been moved, to be undone by the next piece.
    let mut moved = 0.0;
    for (setting, piece) in pieces(text) {
        let shift = match setting {
            Setting::Raised => -0.38 * size,
            Setting::Lowered => 0.2 * size,
            _ => 0.0,
        };
        let mut attributes = String::new();
        if shift != moved {
            let _ = write!(attributes, " dy=\"{}\"", number(shift - moved));
            moved = shift;
        }
        match setting {
            Setting::Italic => attributes.push_str(" font-style=\"italic\""),
            Setting::Raised | Setting::Lowered => {
                let _ = write!(attributes, " font-size=\"{}\"", number(SMALL * size));
            }
            Setting::Upright => {}
        }
        let piece = escape(&piece);
        if attributes.is_empty() {
            svg.push_str(&piece);
        } else {
            let _ = write!(svg, "<tspan{attributes}>{piece}</tspan>");
        }
    }
    svg
}

/// Width of a label [px].
pub fn width(text: &str, size: f64) -> f64 {
    let width_of_piece = |(setting, piece): &(Setting, String)| match setting {
        Setting::Upright => glyphs::width(piece, false, size),
        Setting::Italic => glyphs::width(piece, true, size),
        Setting::Raised | Setting::Lowered => glyphs::width(piece, false, SMALL * size),
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
    fn labels_are_marked_up_and_escaped() {
        assert_eq!(plain("*t* (10^{−3} s)"), "t (10−3 s)");
        assert_eq!(spans("a<b", 10.0), "a&lt;b");
        assert_eq!(
            spans("10^{2} x", 10.0),
            "10<tspan dy=\"-3.8\" font-size=\"7.2\">2</tspan><tspan dy=\"3.8\"> x</tspan>"
        );
    }

    #[test]
    fn a_long_label_has_several_lines() {
        assert_eq!(lines("Change of *u* (m/s)", 10.0, 1000.0), ["Change of *u* (m/s)"]);
        let room = width("Change of", 10.0) + 0.1;
        assert_eq!(lines("Change of *u* (m/s)", 10.0, room), ["Change of", "*u* (m/s)"]);
    }

    #[test]
    fn a_picture_for_print_has_its_size_in_millimetres() {
        let svg = in_millimetres(&Svg::new(400.0, 250.5, "").finish(), 0.2);
        assert!(svg.contains(" width=\"80mm\" height=\"50.1mm\" viewBox=\"0 0 400 250.5\""), "{svg}");
        assert!(svg.contains("<rect width=\"400\" height=\"250.5\""), "{svg}");
    }

    #[test]
    fn numbers_are_short_and_finite() {
        assert_eq!(number(-0.001), "0");
        assert_eq!(number(12.345_678), "12.35");
        assert_eq!(number(f64::INFINITY), "100000");
    }
}
