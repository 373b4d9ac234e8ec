//! What is wrong with a file, in words. The texts of the decoder name its own types.

use super::super::{broken, unsupported};
use super::GREY;
use crate::error::Fault;
use std::io::ErrorKind;
use tiff::tags::PhotometricInterpretation;
use tiff::{TiffError, TiffFormatError, TiffUnsupportedError};

/// A file that is broken, or whole but of a kind that the decoder does not know.
pub(super) fn failed(error: TiffError) -> Fault {
    match error {
        TiffError::UnsupportedError(kind) => unsupported(other_kind(&kind), GREY),
        TiffError::UsageError(_) => unsupported("a predictor that does not fit its numbers", GREY),
        TiffError::FormatError(
            TiffFormatError::InvalidTagValueType(tag)
            | TiffFormatError::RequiredTagNotFound(tag)
            | TiffFormatError::InvalidCountForTag(tag, _),
        ) => broken(&format!("its tag {} is missing or of a wrong kind", tag.to_u16())),
        TiffError::FormatError(TiffFormatError::UnknownPredictor(number)) => {
            unsupported(&format!("the predictor of number {number}"), GREY)
        }
        TiffError::FormatError(TiffFormatError::CompressedDataCorrupt(_)) => {
            broken(&"its compressed data are damaged")
        }
        TiffError::FormatError(error) => broken(&error),
        TiffError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => broken(&"it ends too early"),
        TiffError::LimitsExceeded | TiffError::IntSizeError => {
            broken(&"its strips, its tiles or their places are too large")
        }
        error => broken(&error),
    }
}

fn other_kind(kind: &TiffUnsupportedError) -> &'static str {
    use TiffUnsupportedError as Kind;
    match kind {
        Kind::FloatingPointPredictor(_) | Kind::HorizontalPredictor(_) => {
            "a predictor that does not fit its numbers"
        }
        Kind::InconsistentBitsPerSample(_) => "channels of different numbers of bits",
        Kind::UnsupportedSampleFormat(_) => "channels of different kinds of numbers",
        Kind::ChromaSubsampling => "colours at fewer places than the brightness",
        Kind::MisalignedTileBoundaries => "tiles that do not end at whole bytes",
        Kind::InterpretationWithBits(PhotometricInterpretation::CIELab, _) => {
            "colours of the kind CIE L*a*b*"
        }
        Kind::UnknownInterpretation => "colours of a kind that is not known (PhotometricInterpretation)",
        _ => "pixels of another kind than those that are known",
    }
}

/// The name of a compression.
///
/// Source: the list of compression codes of libtiff, `tiff.h`.
pub(super) fn compression_name(number: u16) -> String {
    let name = match number {
        2..=4 => "CCITT fax",
        6 | 7 => "JPEG",
        34_892 => "lossy JPEG",
        33_003 | 33_004 | 33_005 | 34_712 => "JPEG 2000",
        34_661 => "JBIG",
        34_887 => "LERC",
        34_925 => "LZMA",
        50_000 => "Zstandard",
        50_001 => "WebP",
        50_002 | 52_546 => "JPEG XL",
        other => return format!("the compression of number {other}"),
    };
    format!("{name} compression")
}
