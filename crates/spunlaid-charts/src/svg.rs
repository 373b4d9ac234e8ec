//! From a picture to SVG.

use crate::label::{Setting, pieces, plain, width};
use crate::picture::{Anchor, Fill, Outline, Picture, Point, Shape, Stroke, Text, hundredth};
use std::fmt::Write;

/// Families as wide as the embedded font (Arimo), so that SVG and PNG look alike.
const FONTS: &str = "Arimo, Arial, Helvetica, 'Liberation Sans', sans-serif";

/// The picture as SVG.
pub fn svg(picture: &Picture) -> String {
    let [w, h] = picture.size;
    let [width, height] = match picture.millimetres() {
        Some(sides) => sides.map(|side| format!("{side}mm")),
        None => picture.size.map(|side| side.to_string()),
    };
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {w} {h}\" \
         font-family=\"{FONTS}\" role=\"img\">\n<title>{}</title>\n\
         <rect width=\"{w}\" height=\"{h}\" fill=\"#ffffff\"/>\n",
        escape(&plain(&picture.title))
    );
    for shape in &picture.shapes {
        // Writing to a string cannot fail.
        let _ = match shape {
            Shape::Drawn { outline, fill, stroke } => draw(&mut svg, outline, *fill, stroke.as_ref()),
            Shape::Clip { id, corner: (x, y), size: (width, height) } => writeln!(
                svg,
                "<clipPath id=\"{id}\"><rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"/></clipPath>\n\
                 <g clip-path=\"url(#{id})\">"
            ),
            Shape::Shift(down) => writeln!(svg, "<g transform=\"translate(0 {down})\">"),
            Shape::Close => writeln!(svg, "</g>"),
        };
    }
    svg.push_str("</svg>\n");
    svg
}

fn draw(
    svg: &mut String,
    outline: &Outline,
    fill: Option<Fill>,
    stroke: Option<&Stroke>,
) -> std::fmt::Result {
    let colour = fill.map_or_else(|| "none".to_owned(), |fill| fill.colour.to_string());
    match outline {
        Outline::Line(points) => write!(svg, "<path d=\"{}\"", lines(points))?,
        Outline::Polygon(points) => write!(svg, "<path d=\"{}Z\"", lines(points))?,
        Outline::Rectangles(rectangles) => {
            write!(svg, "<path fill=\"{colour}\" shape-rendering=\"crispEdges\" d=\"")?;
            for ((left, bottom), (right, top)) in rectangles {
                write!(svg, "M{left} {bottom}H{right}V{top}H{left}Z")?;
            }
            return writeln!(svg, "\"/>");
        }
        Outline::Circle((x, y), radius) => write!(svg, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"")?,
        Outline::Text(at, text, style) => return write_text(svg, *at, text, style, &colour),
    }
    write!(svg, " fill=\"{colour}\"")?;
    if let Some(opacity) = fill.map(|fill| fill.opacity).filter(|opacity| *opacity < u8::MAX) {
        write!(svg, " fill-opacity=\"{}\"", hundredth(f64::from(opacity) / f64::from(u8::MAX)))?;
    }
    if let Some(Stroke { colour, width, dash }) = stroke {
        let width = hundredth(*width);
        write!(svg, " stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"")?;
        if !dash.is_empty() {
            let lengths: Vec<String> = dash.iter().map(f32::to_string).collect();
            write!(svg, " stroke-dasharray=\"{}\"", lengths.join(" "))?;
        }
    }
    writeln!(svg, "/>")
}

fn lines(points: &[Point]) -> String {
    let mut d = String::with_capacity(points.len() * 12);
    for (i, (x, y)) in points.iter().enumerate() {
        let _ = write!(d, "{}{x} {y}", if i == 0 { 'M' } else { 'L' });
    }
    d
}

fn write_text(svg: &mut String, (x, y): Point, text: &str, style: &Text, colour: &str) -> std::fmt::Result {
    let anchor = match style.anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    let turn = if style.upright { String::new() } else { format!(" transform=\"rotate(-90 {x} {y})\"") };
    writeln!(
        svg,
        "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"{anchor}\" textLength=\"{}\" \
         lengthAdjust=\"spacingAndGlyphs\" fill=\"{colour}\"{turn}>{}</text>",
        hundredth(style.size),
        // Another font is fitted to the width that the layout counts on.
        hundredth(width(text, style.size)),
        spans(text, style.size)
    )
}

/// The five characters that mean something to XML.
fn escape(text: &str) -> String {
    [('&', "&amp;"), ('<', "&lt;"), ('>', "&gt;"), ('"', "&quot;"), ('\'', "&#39;")]
        .iter()
        .fold(text.to_owned(), |text, (character, name)| text.replace(*character, name))
}

fn spans(text: &str, size: f64) -> String {
    let mut svg = String::new();
    // How far the baseline has been moved, to be undone by the next piece.
    let mut moved = 0.0;
    for (setting, piece) in pieces(text) {
        let mut attributes = String::new();
        let shift = setting.shift(size);
        if shift != moved {
            let _ = write!(attributes, " dy=\"{}\"", hundredth(shift - moved));
            moved = shift;
        }
        match setting {
            Setting::Italic => attributes.push_str(" font-style=\"italic\""),
            Setting::Raised | Setting::Lowered => {
                let _ = write!(attributes, " font-size=\"{}\"", hundredth(setting.size(size)));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_marked_up_and_escaped() {
        assert_eq!(spans("a<b & \"c\"", 10.0), "a&lt;b &amp; &quot;c&quot;");
        assert_eq!(
            spans("10^{2} x", 10.0),
            "10<tspan dy=\"-3.8\" font-size=\"7.2\">2</tspan><tspan dy=\"3.8\"> x</tspan>"
        );
    }

    #[test]
    fn a_picture_for_print_has_its_size_in_millimetres() {
        let svg = svg(&Picture::new(400.0, 250.5, "").printed(0.2));
        assert!(svg.contains(" width=\"80mm\" height=\"50.1mm\" viewBox=\"0 0 400 250.5\""), "{svg}");
        assert!(svg.contains("<rect width=\"400\" height=\"250.5\""), "{svg}");
    }
}
