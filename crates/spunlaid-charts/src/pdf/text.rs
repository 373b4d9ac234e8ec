//! Texts of a page, which can be searched and copied: the file has the glyphs that they need.

use crate::glyphs::{FontFile, font_file, glyphs, width};
use crate::label::{Setting, pieces};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str};
use std::collections::BTreeMap;
use std::io::{self, Write};

/// Where the numbers of glyphs are those of the font.
const IDENTITY: SystemInfo<'static> =
    SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };
/// Usual width of an upright stem of a sans serif [thousandths of the size].
const STEM: f32 = 80.0;

/// The glyphs that the texts of a page need, each with what it stands for: of the upright font, and of the italic one.
#[derive(Debug, Default)]
pub(super) struct Glyphs([BTreeMap<u16, char>; 2]);

/// Name of a font on the page.
const fn name(italic: bool) -> Name<'static> {
    if italic { Name(b"italic") } else { Name(b"upright") }
}

impl Glyphs {
    /// Writes a text along the line that begins at zero and runs to the right; the page counts downwards.
    pub(super) fn write(&mut self, content: &mut Content, text: &str, size: f64) {
        content.begin_text();
        let mut along = 0.0;
        for (setting, piece) in pieces(text) {
            let (italic, own_size) = (setting == Setting::Italic, setting.size(size));
            content.set_font(name(italic), own_size as f32);
            content.set_text_matrix([1.0, 0.0, 0.0, -1.0, along as f32, setting.shift(size) as f32]);
            let mut shown = content.show_positioned();
            let mut items = shown.items();
            for glyph in glyphs(&piece, italic) {
                self.0[usize::from(italic)].entry(glyph.number).or_insert(glyph.character);
                items.show(Str(&glyph.number.to_be_bytes()));
                if glyph.closer != 0.0 {
                    items.adjust(glyph.closer);
                }
            }
            items.finish();
            shown.finish();
            along += width(&piece, italic, own_size);
        }
        content.end_text();
    }

    /// Writes the fonts that are needed. Returns each with its name on the page.
    ///
    /// # Errors
    /// If a font cannot be packed.
    pub(super) fn write_fonts(
        &self,
        file: &mut Pdf,
        numbers: &mut Ref,
    ) -> io::Result<Vec<(Name<'static>, Ref)>> {
        let mut written = Vec::new();
        for (italic, used) in [false, true].into_iter().zip(&self.0) {
            if let Some(font) = font_file(italic).filter(|_| !used.is_empty()) {
                written.push((name(italic), write_font(file, numbers, &font, italic, used)?));
            }
        }
        Ok(written)
    }
}

fn write_font(
    file: &mut Pdf,
    numbers: &mut Ref,
    font: &FontFile,
    italic: bool,
    used: &BTreeMap<u16, char>,
) -> io::Result<Ref> {
    let [whole, glyphs, about, bytes, meaning] = [(); 5].map(|()| numbers.bump());
    let own_name = Name(font.name.as_bytes());
    let mut written = file.type0_font(whole);
    written.base_font(own_name).encoding_predefined(Name(b"Identity-H"));
    written.descendant_font(glyphs).to_unicode(meaning);
    written.finish();

    let mut written = file.cid_font(glyphs);
    written.subtype(CidFontType::Type2).base_font(own_name).system_info(IDENTITY).font_descriptor(about);
    written.default_width(0.0).cid_to_gid_map_predefined(Name(b"Identity"));
    let mut widths = written.widths();
    for number in used.keys() {
        widths.consecutive(*number, font.widths.get(usize::from(*number)).copied());
    }
    widths.finish();
    written.finish();

    let [left, bottom, right, top] = font.bounds;
    let flags = FontFlags::NON_SYMBOLIC | if italic { FontFlags::ITALIC } else { FontFlags::empty() };
    let mut written = file.font_descriptor(about);
    written.name(own_name).flags(flags).bbox(Rect::new(left, bottom, right, top)).italic_angle(font.slant);
    written.ascent(font.ascent).descent(font.descent).cap_height(font.capital_height).stem_v(STEM);
    written.font_file2(bytes);
    written.finish();

    let mut packed = ZlibEncoder::new(Vec::new(), Compression::default());
    packed.write_all(font.bytes)?;
    let packed = packed.finish()?;
    let mut stream = file.stream(bytes, &packed);
    stream.filter(Filter::FlateDecode).pair(Name(b"Length1"), font.bytes.len() as i32);
    stream.finish();

    let mut cmap = UnicodeCmap::new(Name(b"Custom"), IDENTITY);
    used.iter().for_each(|(number, character)| cmap.pair(*number, *character));
    file.cmap(meaning, &cmap.finish());
    Ok(whole)
}
