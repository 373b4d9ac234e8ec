//! The orientation of a picture: where the first row and the first column of the file belong.

use super::RawPicture;

/// The tag of an orientation, of TIFF and of Exif.
const TAG: u16 = 274;
/// The type of a number of 16 bits.
const SHORT: u16 = 3;
/// Bytes of an entry of a directory.
const ENTRY: usize = 12;

/// The picture as it is to be seen.
///
/// Source: TIFF 6.0, section 8, Orientation.
pub(super) fn upright(raw: RawPicture) -> RawPicture {
    let (across, down) = (raw.columns, raw.rows);
    // The column and the row in the file of a pixel of the upright picture.
    let from: fn([usize; 2], [usize; 2]) -> [usize; 2] = match raw.orientation {
        2 => |[x, y], [right, _]| [right - x, y],
        3 => |[x, y], [right, bottom]| [right - x, bottom - y],
        4 => |[x, y], [_, bottom]| [x, bottom - y],
        5 => |[x, y], _| [y, x],
        6 => |[x, y], [_, bottom]| [y, bottom - x],
        7 => |[x, y], [right, bottom]| [right - y, bottom - x],
        8 => |[x, y], [right, _]| [right - y, x],
        _ => return raw,
    };
    let lies = raw.orientation > 4;
    let [columns, rows] = if lies { [down, across] } else { [across, down] };
    let ends = [across - 1, down - 1];
    let value = |at: usize| {
        let [column, row] = from([at % columns, at / columns], ends);
        raw.values[row * across + column]
    };
    let values = (0..raw.values.len()).map(value).collect();
    let pixel = raw.pixel.map(|[width, height]| if lies { [height, width] } else { [width, height] });
    RawPicture { values, columns, rows, pixel, orientation: 1, ..raw }
}

/// The orientation in the Exif data of a picture; 1 if they give none.
pub(super) fn of_exif(exif: &[u8]) -> u16 {
    tag_of_exif(exif.strip_prefix(b"Exif\0\0").unwrap_or(exif)).unwrap_or(1)
}

fn tag_of_exif(exif: &[u8]) -> Option<u16> {
    let big = match exif.get(..4)? {
        b"MM\0*" => true,
        b"II*\0" => false,
        _ => return None,
    };
    let bytes = |at: usize, count: usize| exif.get(at..at.checked_add(count)?);
    let number = |at: usize, count: usize| {
        let fold = |sum: usize, byte: &u8| sum << 8 | usize::from(*byte);
        let bytes = bytes(at, count)?.iter();
        Some(if big { bytes.fold(0, fold) } else { bytes.rev().fold(0, fold) })
    };
    let first = number(4, 4)?;
    let entries = number(first, 2)?;
    let entry = (0..entries).map(|i| first + 2 + ENTRY * i).find(|at| number(*at, 2) == Some(TAG.into()))?;
    let value = number(entry + 8, 2).filter(|_| number(entry + 2, 2) == Some(SHORT.into()))?;
    u16::try_from(value).ok()
}
