//! Pictures that are whole but not read, and broken ones: what the messages say.

use crate::scan_files::{SIDE, levels};
use crate::scans::{Page, png8, tiff_of_pages, tiff8};
use spunlaid_web::scan::parse;
use tiff::tags::Tag;

#[test]
fn pictures_of_other_formats_are_refused_by_name() {
    for (start, name) in [
        (&b"RIFF\x10\0\0\0WEBPVP8 "[..], "WebP"),
        (b"\0\0\0\x18ftypheic\0\0\0\0", "HEIC"),
        (b"\0\0\0\x0cjP  \r\n\x87\n", "JPEG 2000"),
        (b"\xff\x0a\0\0", "JPEG XL"),
        (b"GIF89a", "GIF"),
        (b"BM\x36\0\0\0\0\0\0\0", "BMP"),
        (b"P5\n180 240\n255\n", "PGM"),
        (b"\xff\xd8\xff\xe0", "JPEG"),
    ] {
        let said = parse(start, "a", 1e-3).unwrap_err().to_string();
        assert!(said.contains(name) && said.contains("PNG or TIFF"), "{said}");
    }
}

/// A TIFF whose tag of one 16-bit number is changed.
fn with_tag(tag: u16, value: u16) -> Vec<u8> {
    let mut file = tiff8(SIDE, &levels(|x| x));
    // Tag, the type of 16-bit numbers, one of them.
    let entry = [tag.to_le_bytes(), [3, 0], [1, 0], [0, 0]].concat();
    let at = file.windows(entry.len()).position(|bytes| bytes == entry).unwrap() + entry.len();
    file[at..at + 2].copy_from_slice(&value.to_le_bytes());
    file
}

#[test]
fn whole_tiffs_that_are_not_read_tell_why() {
    for (tag, value, name) in [
        (259, 50_000, "Zstandard compression"),
        (259, 34_925, "LZMA compression"),
        (259, 12_345, "the compression of number 12345"),
        (262, 3, "colours from a palette"),
    ] {
        let said = parse(&with_tag(tag, value), "a", 1e-3).unwrap_err().to_string();
        assert!(said.contains(name) && said.contains("save the scan"), "{said}");
    }
}

/// Written by tifffile; the decoder fails in one of its tiles, which reaches beyond the picture.
#[test]
fn tiles_with_lzw_compression_are_refused_by_name() {
    let said = parse(include_bytes!("lzw_tiles.tif"), "a", 1e-3).unwrap_err().to_string();
    assert!(said.contains("tiles with LZW compression") && said.contains("Deflate"), "{said}");
}

#[test]
fn messages_name_no_types_of_the_decoders() {
    let mut png = png8(SIDE, &levels(|x| x));
    let at = png.windows(4).position(|kind| kind == b"IDAT").unwrap() + 6;
    png[at] ^= 0xff;
    let wide = levels(u16::from);
    let tagged =
        |tag, value| tiff_of_pages(&[Page { columns: SIDE, levels: &wide, bits: 8, tags: &[(tag, value)] }]);
    let mut no_strips = tiff8(SIDE, &levels(|x| x));
    let at = no_strips.windows(2).position(|tag| tag == 273u16.to_le_bytes()).unwrap();
    no_strips[at..at + 2].copy_from_slice(&272u16.to_le_bytes());
    for (file, said) in [
        (png, "its content is damaged"),
        (no_strips, "cannot be decoded: "),
        (tagged(Tag::ImageWidth, 0), "cannot be decoded: "),
        (with_tag(258, 12), "has 12 bits for each level, which cannot be read; save the scan"),
        (tagged(Tag::Predictor, 9), "has the predictor of number 9, which cannot be read; save the scan"),
        (with_tag(262, 32_803), "has colours of a kind that is not known (PhotometricInterpretation)"),
        (with_tag(339, 2), "has signed numbers, which cannot be read; save it"),
    ] {
        let error = parse(&file, "a", 1e-3).unwrap_err().to_string();
        assert!(error.contains(said), "{error}\nwhere wanted: {said}");
        assert!(!error.contains(['{', '`', '<']) && !error.contains("::"), "{error}");
    }
}
