//! From a picture to PDF: one page of its size. It has its font in it, so that it looks alike everywhere and
//! its texts can be searched.

mod text;

use crate::outline::place_of_text;
use crate::palette::{Colour, PAPER};
use crate::picture::{Fill, Outline, Picture, PictureError, Shape, Stroke};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::LineJoinStyle;
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};
use std::collections::BTreeSet;
use std::io::Write;
use text::Glyphs;
use tiny_skia::{Path, PathSegment, Transform};

/// Points of a PDF in an inch.
const PER_INCH: f64 = 72.0;
/// Width of the line around shapes with sharp edges [px]: without it, viewers leave pale gaps between neighbours.
const SEAM: f64 = 0.3;

/// The picture as PDF, a page as large as it is.
///
/// * `title`, `software` – what the file says about itself
///
/// # Errors
/// A picture without extent.
pub fn pdf(picture: &Picture, title: &str, software: &str) -> Result<Vec<u8>, PictureError> {
    let extent = picture.extent(PER_INCH)?;
    let [width, height] = extent.map(|side| side as f32);
    let [x, y] = [0, 1].map(|i| (extent[i] / picture.size[i]) as f32);
    let mut page = Page { content: Content::new(), opacities: BTreeSet::new(), glyphs: Glyphs::default() };
    // PDF counts upwards from the lower left corner.
    page.content.transform([x, 0.0, 0.0, -y, 0.0, height]).set_line_join(LineJoinStyle::RoundJoin);
    let [red, green, blue] = shares(PAPER);
    let paper = page.content.set_fill_rgb(red, green, blue);
    paper.rect(0.0, 0.0, picture.size[0] as f32, picture.size[1] as f32).fill_nonzero();
    picture.shapes.iter().for_each(|shape| page.add(shape));
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::default());
    let failed = |error: std::io::Error| PictureError::Encoding(error.to_string());
    packed.write_all(&page.content.finish()).map_err(failed)?;
    let content = packed.finish().map_err(failed)?;

    let mut numbers = Ref::new(1);
    let [catalog, pages, the_page, stream, information] = [(); 5].map(|()| numbers.bump());
    let mut file = Pdf::new();
    file.catalog(catalog).pages(pages);
    file.pages(pages).kids([the_page]).count(1);
    file.stream(stream, &content).filter(Filter::FlateDecode);
    let fonts = page.glyphs.write_fonts(&mut file, &mut numbers).map_err(failed)?;
    let mut written = file.page(the_page);
    written.parent(pages).media_box(Rect::new(0.0, 0.0, width, height)).contents(stream);
    let mut resources = written.resources();
    let mut states = resources.ext_g_states();
    for opacity in &page.opacities {
        let mut state = states.insert(Name(name(*opacity).as_bytes())).dict();
        state.pair(Name(b"ca"), f32::from(*opacity) / 255.0);
    }
    states.finish();
    if !fonts.is_empty() {
        resources.fonts().pairs(fonts);
    }
    resources.finish();
    written.finish();
    file.document_info(information).title(TextStr(title)).creator(TextStr(software));
    Ok(file.finish())
}

/// Name of the state in which areas have this opacity, of 255.
fn name(opacity: u8) -> String {
    format!("a{opacity}")
}

/// The shapes of a page as they are written.
struct Page {
    content: Content,
    /// Those that areas have, other than 255.
    opacities: BTreeSet<u8>,
    /// Those that texts need.
    glyphs: Glyphs,
}

impl Page {
    fn add(&mut self, shape: &Shape) {
        match shape {
            Shape::Drawn { outline: Outline::Text(at, text, style), .. } => {
                self.content.save_state();
                let [red, green, blue] = shares(style.colour);
                self.content.set_fill_rgb(red, green, blue);
                self.place(place_of_text(*at, text, *style));
                self.glyphs.write(&mut self.content, text, style.size);
                self.content.restore_state();
            }
            Shape::Drawn { outline, fill, stroke } => self.draw(outline, *fill, *stroke),
            Shape::Clip { corner: (x, y), size: (width, height), .. } => {
                self.content.save_state().rect(*x, *y, *width, *height).clip_nonzero().end_path();
            }
            Shape::Shift(down) => {
                self.content.save_state().transform([1.0, 0.0, 0.0, 1.0, 0.0, *down]);
            }
            Shape::Close => {
                self.content.restore_state();
            }
        }
    }

    fn draw(&mut self, outline: &Outline, fill: Option<Fill>, stroke: Option<Stroke>) {
        let Some((path, own)) = outline.path() else { return };
        let seam = fill.filter(|_| outline.is_sharp()).map(|fill| Stroke::solid(fill.colour, SEAM));
        let stroke = stroke.or(seam);
        self.content.save_state();
        if let Some(fill) = fill {
            if fill.opacity < u8::MAX {
                self.opacities.insert(fill.opacity);
                self.content.set_parameters(Name(name(fill.opacity).as_bytes()));
            }
            let [red, green, blue] = shares(fill.colour);
            self.content.set_fill_rgb(red, green, blue);
        }
        if let Some(Stroke { colour, width, dash }) = stroke {
            let [red, green, blue] = shares(colour);
            self.content.set_stroke_rgb(red, green, blue).set_line_width(width as f32);
            if !dash.is_empty() {
                self.content.set_dash_pattern(dash.iter().copied(), 0.0);
            }
        }
        self.place(own);
        self.outline(&path);
        match (fill, stroke) {
            (Some(_), Some(_)) => self.content.fill_nonzero_and_stroke(),
            (Some(_), None) => self.content.fill_nonzero(),
            (None, _) => self.content.stroke(),
        };
        self.content.restore_state();
    }

    fn place(&mut self, own: Transform) {
        if !own.is_identity() {
            self.content.transform([own.sx, own.ky, own.kx, own.sy, own.tx, own.ty]);
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
fn shares(colour: Colour) -> [f32; 3] {
    colour.0.map(|part| f32::from(part) / 255.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::INK;
    use crate::picture::{Anchor, Text};
    use flate2::read::ZlibDecoder;
    use std::io::Read;

    /// The text of the page's operators.
    fn content(file: &[u8]) -> String {
        let find = |word: &[u8]| file.windows(word.len()).position(|part| part == word).unwrap();
        let start = find(b"stream\n") + "stream\n".len();
        let mut bytes = Vec::new();
        ZlibDecoder::new(&file[start..]).read_to_end(&mut bytes).unwrap();
        // The numbers of glyphs are no text.
        String::from_utf8_lossy(&bytes).into_owned()
    }

    #[test]
    fn the_page_is_as_large_as_the_picture_in_print_and_shapes_keep_colour_dash_and_opacity() {
        let mut picture = Picture::new(10.0, 20.0, "").printed(2.54);
        picture.polygon(&[(1.0, 2.0), (3.0, 4.0)], Colour([255, 0, 0]), 0.2, None);
        let stroke = Stroke { colour: Colour([0, 255, 0]), width: 2.0, dash: &[6.0, 4.0] };
        picture.line((0.0, 0.0), (5.0, 5.0), &stroke);
        picture.circle((5.0, 5.0), 1.0, Colour([255, 0, 0]), &stroke);
        let file = pdf(&picture, "A title", "spunlaid").unwrap();
        let text = String::from_utf8_lossy(&file);
        assert!(text.starts_with("%PDF-"), "{text}");
        assert!(text.contains("/MediaBox [0 0 72 144]"), "{text}");
        assert!(text.contains("/Title (A title)") && text.contains("/ca 0.2\n"), "{text}");
        let content = content(&file);
        for operators in [
            "1 0 0 rg",
            "/a51 gs",
            "1 2 m\n3 4 l\nh\nf\n",
            "0 1 0 RG",
            "2 w",
            "[6 4] 0 d",
            "0 0 m\n5 5 l\nS",
            // The area first, the line on it.
            "6 5 m\n",
            "h\nB\n",
        ] {
            assert!(content.contains(operators), "{operators}: {content}");
        }
    }

    #[test]
    fn clips_hide_what_lies_outside_and_texts_stand_in_their_place() {
        let mut picture = Picture::new(100.0, 50.0, "");
        picture.open_clip("c", 10.0, 10.0, 30.0, 20.0);
        picture.line((0.0, 0.0), (100.0, 50.0), &Stroke::solid(INK, 1.0));
        picture.close();
        let style = Text { size: 10.0, colour: Colour([0, 0, 255]), anchor: Anchor::Start, upright: true };
        picture.text((10.0, 40.0), "*µ*m", style);
        let content = content(&pdf(&picture, "", "").unwrap());
        let (clip, line) = content.split_once("W\nn\n").unwrap();
        assert!(clip.ends_with("q\n10 10 30 20 re\n"), "{content}");
        let (line, text) = line.split_once("0 0 1 rg").unwrap();
        assert!(line.contains("0 0 m\n100 50 l\nS\nQ\nQ\n"), "{content}");
        // The µ is italic, and behind it the m begins.
        let begins = 10.0 * crate::label::width("*µ*", 1.0);
        assert!(text.starts_with("\n1 0 0 1 10 40 cm\nBT\n/italic 10 Tf\n1 0 0 -1 0 0 Tm\n["), "{content}");
        let upright = text.split_once("/upright 10 Tf\n").unwrap_or_else(|| panic!("{text}")).1;
        let m = upright.split(' ').nth(4).unwrap().parse::<f64>().unwrap();
        assert!((m - begins).abs() < 1e-3 && begins > 5.0, "{content}");
    }

    /// What every program that searches does: from the numbers of the glyphs to characters by the table of the font.
    #[test]
    fn texts_can_be_searched() {
        let mut picture = Picture::new(300.0, 50.0, "");
        let style = Text { size: 10.0, colour: INK, anchor: Anchor::End, upright: false };
        picture.text((10.0, 40.0), "15 g/m², 18 µm, σ_{MD}", style);
        let file = pdf(&picture, "", "").unwrap();
        let file = String::from_utf8_lossy(&file);
        assert!(!file.contains("/italic") && file.contains("/BaseFont /Arimo\n"), "{file}");
        for character in "15 g/m², 18 µm, σMD".chars() {
            let glyph = crate::glyphs::glyphs(&character.to_string(), false)[0].number;
            let pair = format!("<{glyph:04X}> <{:04X}>\n", u32::from(character));
            assert!(glyph != 0 && file.contains(&pair), "{character}: {pair}");
        }
    }

    #[test]
    fn sharp_edges_have_a_seam() {
        let mut picture = Picture::new(10.0, 10.0, "");
        picture.rectangles(&[((1.0, 4.0), (3.0, 2.0))], Colour([255, 0, 0]));
        let content = content(&pdf(&picture, "", "").unwrap());
        let seam = "1 0 0 rg\n1 0 0 RG\n0.3 w\n1 4 m\n3 4 l\n3 2 l\n1 2 l\nh\nB\n";
        assert!(content.contains(seam), "{content}");
    }

    #[test]
    fn rejects_a_picture_without_extent() {
        assert!(pdf(&Picture::new(10.0, 0.0, ""), "", "").is_err());
    }
}
