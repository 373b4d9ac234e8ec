//! Reads the text of a file, which may turn out to be no text at all.

use super::LARGEST_FILE;
use spunlaid_ground::{Error, Fault, FileError, FileKind, Position, file};
use std::path::Path;

/// Reads a UTF-8 file no larger than [`LARGEST_FILE`].
pub(super) fn read(path: &Path, kind: FileKind) -> Result<String, Error> {
    let bytes = file::read(path, kind, LARGEST_FILE).map_err(Error::File)?;
    text(bytes).map_err(|error| Error::File(error.path(path)))
}

/// The text that the bytes are.
pub(super) fn text(bytes: Vec<u8>) -> Result<String, FileError> {
    // Without a mark at its start, every other byte of simple signs is zero.
    let is_utf_16 = bytes.starts_with(&[0xff, 0xfe])
        || bytes.starts_with(&[0xfe, 0xff])
        || matches!(bytes.as_slice(), [a, 0, b, 0, ..] | [0, a, 0, b, ..] if *a > 0 && *b > 0);
    if is_utf_16 {
        let fault = Fault::new(
            "is UTF-16 text, as some editors and Windows PowerShell save it",
            "save the file as UTF-8",
        );
        return Err(fault.into());
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let bytes = error.as_bytes();
        let line = 1 + bytes.iter().take(valid).filter(|byte| **byte == b'\n').count();
        let byte = bytes.get(valid).copied().unwrap_or_default();
        let fault = match latin(bytes, byte) {
            Some(sign) => Fault::new(
                format!(
                    "is not UTF-8 text: byte {byte:#04x} in this line would be {sign} in Latin-1 \
                    (Windows-1252), as older editors save it"
                ),
                "save the file as UTF-8, or write um for µm",
            ),
            None => Fault::new(
                format!("byte {byte:#04x} (number {} of the file) is not UTF-8 text", valid + 1),
                "save the file as UTF-8, or write um for µm",
            ),
        };
        FileError::from(fault).at(Position::Line(line as u64))
    })
}

/// The sign of a byte in Windows-1252, if all bytes could be text in it.
fn latin(bytes: &[u8], byte: u8) -> Option<char> {
    let is_text =
        |byte: &u8| !matches!(byte, 0..=8 | 11 | 12 | 14..=31 | 0x7f | 0x81 | 0x8d | 0x8f | 0x90 | 0x9d);
    if !bytes.iter().all(is_text) {
        return None;
    }
    // The signs from 0x80 to 0x9f; Latin-1 has none there.
    let own = "€\u{81}‚ƒ„…†‡ˆ‰Š‹Œ\u{8d}Ž\u{8f}\u{90}‘’“”•–—˜™š›œ\u{9d}žŸ";
    match byte {
        0x80..=0x9f => own.chars().nth(usize::from(byte - 0x80)),
        _ => Some(char::from(byte)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bytes by the tables of Unicode for these encodings (CP1252.TXT, CP437.TXT).
    #[test]
    fn text_in_another_encoding_is_named() {
        let message = |bytes: &[u8]| text(bytes.to_vec()).unwrap_err().to_string();
        for (bytes, sign) in [
            (&b"# air\nd = \"50 \xb5m\""[..], "byte 0xb5 in this line would be µ in Latin-1"),
            (b"# D\xfcse\nd = \"50 \xb5m\"", "byte 0xfc in this line would be ü in Latin-1"),
            (b"d = \x9350 um\x94", "byte 0x93 in this line would be “ in Latin-1"),
            (b"cost = \"1 \x80\"", "byte 0x80 in this line would be € in Latin-1"),
            (b"a = \x9f", "byte 0x9f in this line would be Ÿ in Latin-1"),
        ] {
            assert!(message(bytes).contains(sign), "{}", message(bytes));
            assert!(message(bytes).contains("; save the file as UTF-8"), "{}", message(bytes));
        }
        // No sign of Windows-1252 has the byte 0x81, and no text the byte 0x01.
        for bytes in [&b"a = \x81"[..], b"\x89PNG\x01"] {
            assert!(message(bytes).contains("is not UTF-8 text; save"), "{}", message(bytes));
        }
        let utf_16 =
            |bytes: fn(u16) -> [u8; 2]| "seed = 1".encode_utf16().flat_map(bytes).collect::<Vec<u8>>();
        for bytes in [utf_16(u16::to_le_bytes), utf_16(u16::to_be_bytes)] {
            assert!(message(&bytes).contains("is UTF-16 text"), "{}", message(&bytes));
        }
        assert_eq!(text("µ\u{feff}".into()).unwrap(), "µ\u{feff}");
    }
}
