//! From SVG to PDF: one page of the picture's size. Texts are outlines, so that it looks alike everywhere.

use crate::picture::{PER_INCH, PictureError, shapes};
use flate2::{Compression, write::ZlibEncoder};
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};
use resvg::tiny_skia::{Path, PathSegment, Transform};
use resvg::usvg::{FillRule, Group, LineCap, LineJoin, Node, Paint, ShapeRendering, Stroke};
use std::collections::BTreeSet;
use std::io::Write;

/// Points of a PDF per pixel of the SVG.
const SCALE: f32 = 72.0 / PER_INCH;
/// Width of the line around shapes with sharp edges [px]: without it, viewers leave pale gaps between neighbours.
const SEAM: f32 = 0.3;

/// The picture as PDF, a page as large as the SVG. It knows shapes of one colour each, which are all that
/// [`Svg`](crate::svg::Svg) writes.
///
/// * `title`, `software` – what the file says about itself
///
/// # Errors
/// A string that is not an SVG picture.
pub fn pdf(svg: &str, title: &str, software: &str) -> Result<Vec<u8>, PictureError> {
    let tree = shapes(svg)?;
    let (width, height) = (tree.size().width() * SCALE, tree.size().height() * SCALE);
    let mut page = Page { content: Content::new(), opacities: BTreeSet::new() };
    // PDF counts upwards from the lower left corner.
    page.content.transform([SCALE, 0.0, 0.0, -SCALE, 0.0, height]);
    page.group(tree.root());
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::default());
    let failed = |error: std::io::Error| PictureError::Encoding(error.to_string());
    packed.write_all(&page.content.finish()).map_err(failed)?;
    let content = packed.finish().map_err(failed)?;

    let mut numbers = Ref::new(1);
    let [catalog, pages, the_page, stream, information] = [(); 5].map(|()| numbers.bump());
    let mut file = Pdf::new();
    file.catalog(catalog).pages(pages);
    file.pages(pages).kids([the_page]).count(1);
    let mut written = file.page(the_page);
    written.parent(pages).media_box(Rect::new(0.0, 0.0, width, height)).contents(stream);
    let mut resources = written.resources();
    let mut states = resources.ext_g_states();
    for opacity in &page.opacities {
        let mut state = states.insert(Name(name(*opacity).as_bytes())).dict();
        let share = f32::from(*opacity) / 255.0;
        state.pair(Name(b"ca"), share).pair(Name(b"CA"), share);
    }
    states.finish();
    resources.finish();
    written.finish();
    file.stream(stream, &content).filter(Filter::FlateDecode);
    file.document_info(information).title(TextStr(title)).creator(TextStr(software));
    Ok(file.finish())
}

/// Name of the state in which shapes have this opacity, of 255.
fn name(opacity: u8) -> String {
    format!("a{opacity}")
}

/// The shapes of a page as they are written.
struct Page {
    content: Content,
    /// Those that shapes have, other than 255.
    opacities: BTreeSet<u8>,
}

impl Page {
    fn group(&mut self, group: &Group) {
        self.content.save_state();
        if let Some(clip) = group.clip_path() {
            let placed = group.abs_transform().pre_concat(clip.transform());
            for node in clip.root().children() {
                if let Node::Path(path) = node {
                    let outline = path.data().clone().transform(placed.pre_concat(path.abs_transform()));
                    outline.iter().for_each(|outline| self.outline(outline));
                }
            }
            self.content.clip_nonzero().end_path();
        }
        for node in group.children() {
            match node {
                Node::Group(inner) => self.group(inner),
                Node::Path(path) if path.is_visible() => self.path(path),
                Node::Path(_) | Node::Image(_) | Node::Text(_) => {}
            }
        }
        self.content.restore_state();
    }

    fn path(&mut self, path: &resvg::usvg::Path) {
        let fill =
            path.fill().and_then(|fill| Some((colour(fill.paint())?, fill.opacity().to_u8(), fill.rule())));
        let stroke = path
            .stroke()
            .and_then(|stroke| Some((colour(stroke.paint())?, stroke.opacity().to_u8(), stroke)));
        let Transform { sx, ky, kx, sy, tx, ty } = path.abs_transform();
        self.content.save_state().transform([sx, ky, kx, sy, tx, ty]);
        if let Some((colour, opacity, rule)) = fill {
            self.content.save_state();
            self.opacity(opacity);
            let [r, g, b] = colour;
            self.content.set_fill_rgb(r, g, b).set_stroke_rgb(r, g, b).set_line_width(SEAM);
            self.outline(path.data());
            match (path.rendering_mode(), rule) {
                (ShapeRendering::CrispEdges, _) => self.content.fill_nonzero_and_stroke(),
                (_, FillRule::NonZero) => self.content.fill_nonzero(),
                (_, FillRule::EvenOdd) => self.content.fill_even_odd(),
            };
            self.content.restore_state();
        }
        if let Some(([r, g, b], opacity, stroke)) = stroke {
            self.opacity(opacity);
            self.content.set_stroke_rgb(r, g, b);
            self.line(stroke);
            self.outline(path.data());
            self.content.stroke();
        }
        self.content.restore_state();
    }

    fn opacity(&mut self, opacity: u8) {
        if opacity < u8::MAX {
            self.opacities.insert(opacity);
            self.content.set_parameters(Name(name(opacity).as_bytes()));
        }
    }

    fn line(&mut self, stroke: &Stroke) {
        self.content.set_line_width(stroke.width().get());
        self.content.set_line_cap(match stroke.linecap() {
            LineCap::Butt => LineCapStyle::ButtCap,
            LineCap::Round => LineCapStyle::RoundCap,
            LineCap::Square => LineCapStyle::ProjectingSquareCap,
        });
        self.content.set_line_join(match stroke.linejoin() {
            LineJoin::Miter | LineJoin::MiterClip => LineJoinStyle::MiterJoin,
            LineJoin::Round => LineJoinStyle::RoundJoin,
            LineJoin::Bevel => LineJoinStyle::BevelJoin,
        });
        if let Some(dashes) = stroke.dasharray() {
            self.content.set_dash_pattern(dashes.iter().copied(), stroke.dashoffset());
        }
    }

    fn outline(&mut self, path: &Path) {
        let mut at = (0.0, 0.0);
        for segment in path.segments() {
            match segment {
                PathSegment::MoveTo(to) => {
                    self.content.move_to(to.x, to.y);
                    at = (to.x, to.y);
                }
                PathSegment::LineTo(to) => {
                    self.content.line_to(to.x, to.y);
                    at = (to.x, to.y);
                }
                // The same curve as one of third order.
                PathSegment::QuadTo(by, to) => {
                    let towards = |end: f32, by: f32| end + (by - end) * 2.0 / 3.0;
                    let first = (towards(at.0, by.x), towards(at.1, by.y));
                    let second = (towards(to.x, by.x), towards(to.y, by.y));
                    self.content.cubic_to(first.0, first.1, second.0, second.1, to.x, to.y);
                    at = (to.x, to.y);
                }
                PathSegment::CubicTo(first, second, to) => {
                    self.content.cubic_to(first.x, first.y, second.x, second.y, to.x, to.y);
                    at = (to.x, to.y);
                }
                PathSegment::Close => {
                    self.content.close_path();
                }
            }
        }
    }
}

/// Red, green and blue, 0 to 1.
fn colour(paint: &Paint) -> Option<[f32; 3]> {
    match paint {
        Paint::Color(colour) => {
            Some([colour.red, colour.green, colour.blue].map(|part| f32::from(part) / 255.0))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::ZlibDecoder;
    use std::io::Read;

    /// The text of the page's operators.
    fn content(file: &[u8]) -> String {
        let find = |word: &[u8]| file.windows(word.len()).position(|part| part == word).unwrap();
        let start = find(b"stream\n") + "stream\n".len();
        let mut text = String::new();
        ZlibDecoder::new(&file[start..]).read_to_string(&mut text).unwrap();
        text
    }

    #[test]
    fn the_page_is_as_large_as_the_picture_in_print_and_shapes_keep_colour_dash_and_opacity() {
        let svg = r##"<svg xmlns="http://www.w3.org/2000/svg" width="25.4mm" height="50.8mm" viewBox="0 0 10 20"><path d="M1 2L3 4Z" fill="#ff0000" fill-opacity="0.2"/><path d="M0 0L5 5" fill="none" stroke="#00ff00" stroke-width="2" stroke-dasharray="6 4"/></svg>"##;
        let file = pdf(svg, "A title", "spunlaid").unwrap();
        let text = String::from_utf8_lossy(&file);
        assert!(text.starts_with("%PDF-"), "{text}");
        assert!(text.contains("/MediaBox [0 0 72 144]"), "{text}");
        assert!(
            text.contains("/Title (A title)") && text.contains("/ca 0.2\n") && text.contains("/CA 0.2\n"),
            "{text}"
        );
        let content = content(&file);
        for operators in
            ["1 0 0 rg", "/a51 gs", "1 2 m\n3 4 l\nh\nf", "0 1 0 RG", "2 w", "[6 4] 0 d", "0 0 m\n5 5 l\nS"]
        {
            assert!(content.contains(operators), "{operators}: {content}");
        }
    }

    #[test]
    fn clips_hide_what_lies_outside_and_texts_are_outlines() {
        let mut svg = crate::svg::Svg::new(100.0, 50.0, "");
        svg.open_clip("c", 10.0, 10.0, 30.0, 20.0);
        svg.line((0.0, 0.0), (100.0, 50.0), &crate::svg::Stroke::solid("#000000", 1.0));
        svg.close();
        let style = crate::svg::Text {
            size: 10.0,
            colour: "#0000ff",
            anchor: crate::svg::Anchor::Start,
            upright: true,
        };
        svg.text((10.0, 40.0), "*µ*m", style);
        let content = content(&pdf(&svg.finish(), "", "").unwrap());
        let clip = content.split("W\nn").next().unwrap();
        assert!(clip.ends_with("10 10 m\n40 10 l\n40 30 l\n10 30 l\nh\n"), "{content}");
        let text = content.split("0 0 1 rg").nth(1).unwrap();
        assert!(text.contains(" c\n"), "{content}");
    }

    #[test]
    fn rejects_what_is_no_picture() {
        assert!(pdf("<html></html>", "", "").is_err());
    }
}
