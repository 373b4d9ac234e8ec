//! The embedded font: the widths of texts, and texts as outlines, so that a picture needs no other font and
//! no text layout.

use std::sync::LazyLock;
use tiny_skia::{Path, PathBuilder};
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

/// A glyph of a piece of text, for a file that has the font itself.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Glyph {
    /// Its number in the font.
    pub(crate) number: u16,
    /// What it stands for.
    pub(crate) character: char,
    /// How much closer than its width the next one stands, in thousandths of the size of the text.
    pub(crate) closer: f32,
}

/// The glyphs of a piece of text.
pub(crate) fn glyphs(text: &str, italic: bool) -> Vec<Glyph> {
    let Some(font) = font(italic) else { return Vec::new() };
    let glyph = |(character, (id, advance)): (char, (GlyphId, f64))| {
        let width = f64::from(font.face.glyph_hor_advance(id).unwrap_or(0));
        Glyph { number: id.0, character, closer: ((width - advance) * font.scale(1e3)) as f32 }
    };
    text.chars().zip(font.glyphs(text)).map(glyph).collect()
}

/// What a file says of a font that it has itself: lengths in thousandths of the size of the text.
#[derive(Debug)]
pub(crate) struct FontFile {
    pub(crate) name: &'static str,
    pub(crate) bytes: &'static [u8],
    /// The corner at the lower left, and the one at the upper right.
    pub(crate) bounds: [f32; 4],
    pub(crate) ascent: f32,
    pub(crate) descent: f32,
    pub(crate) capital_height: f32,
    /// Degrees from upright, to the left.
    pub(crate) slant: f32,
    /// Width of each glyph, by its number.
    pub(crate) widths: Vec<f32>,
}

/// The font for upright or for italic text.
pub(crate) fn font_file(italic: bool) -> Option<FontFile> {
    let font = font(italic)?;
    let (face, scale) = (&font.face, font.scale(1e3));
    let length = |units: i16| (f64::from(units) * scale) as f32;
    let bounds = face.global_bounding_box();
    let width = |number| (f64::from(face.glyph_hor_advance(GlyphId(number)).unwrap_or(0)) * scale) as f32;
    Some(FontFile {
        name: if italic { "Arimo-Italic" } else { "Arimo" },
        bytes: if italic { ITALIC } else { REGULAR },
        bounds: [bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max].map(length),
        ascent: length(face.ascender()),
        descent: length(face.descender()),
        capital_height: length(face.capital_height().unwrap_or(face.ascender())),
        slant: face.italic_angle(),
        widths: (0..face.number_of_glyphs()).map(width).collect(),
    })
}

/// Draws the outlines of glyphs along a line that begins at zero.
#[derive(Default)]
pub(crate) struct Pen {
    path: PathBuilder,
    /// Where the next glyph begins, along the line and below it [px].
    along: f64,
    below: f64,
    /// Pixels per unit of the font.
    scale: f64,
}

impl Pen {
    /// Draws a piece of text and moves behind it.
    ///
    /// * `below` – how far below the line [px]
    pub(crate) fn write(&mut self, text: &str, italic: bool, size: f64, below: f64) {
        let Some(font) = font(italic) else { return };
        self.below = below;
        self.scale = font.scale(size);
        for (glyph, advance) in font.glyphs(text) {
            font.face.outline_glyph(glyph, self);
            self.along += advance * self.scale;
        }
    }

    /// What was drawn; nothing of mere blanks.
    pub(crate) fn finish(self) -> Option<Path> {
        self.path.finish()
    }

    /// The place of a point of a glyph, to a thousandth of a pixel: more would only make files longer.
    fn place(&self, x: f32, y: f32) -> (f32, f32) {
        let thousandth = |x: f64| ((x * 1e3).round() / 1e3) as f32;
        let (along, up) = (f64::from(x) * self.scale, f64::from(y) * self.scale);
        (thousandth(self.along + along), thousandth(self.below - up))
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.place(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.place(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.place(x1, y1), self.place(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let (x1, y1) = self.place(x1, y1);
        let (x2, y2) = self.place(x2, y2);
        let (x, y) = self.place(x, y);
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}
