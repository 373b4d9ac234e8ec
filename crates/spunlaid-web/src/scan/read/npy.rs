//! Arrays of NumPy.
//!
//! Source: NumPy enhancement proposal 1, "A simple file format for NumPy arrays".

use super::{RawPicture, broken, unsupported, within_limits};
use spunlaid_ground::units::excerpt;
use spunlaid_ground::{Fault, FileError};

/// Bytes before the length of the header: `\x93NUMPY` and the version.
const MAGIC: usize = 8;

pub(super) fn parse(bytes: &[u8]) -> Result<RawPicture, FileError> {
    let cut_off = || Fault::cut_off("the header of the array");
    let count = if bytes.get(6) == Some(&1) { 2 } else { 4 };
    let length = bytes.get(MAGIC..MAGIC + count).ok_or_else(cut_off)?;
    let length = length.iter().rev().fold(0usize, |sum, byte| sum << 8 | usize::from(*byte));
    let start = MAGIC + count;
    let head = bytes.get(start..).and_then(|rest| rest.get(..length)).ok_or_else(cut_off)?;
    let data = &bytes[start + length..];
    let head = String::from_utf8_lossy(head);
    let kind = value(&head, "'descr':")?.trim_matches(['\'', '"']).to_owned();
    let by_columns = value(&head, "'fortran_order':")? == "True";
    let [rows, columns] = shape(&head)?;
    let [columns, rows] = within_limits(columns, rows)?;
    let (read, size, full_scale) = number(&kind)?;
    let wanted = columns * rows * size;
    if data.len() < wanted {
        return Err(Fault::cut_off("the numbers of the array").into());
    }
    let number = |at: usize| read(&data[at * size..(at + 1) * size]);
    // Arrays in the order of Fortran have their columns one after the other.
    let place = |at: usize| if by_columns { at % columns * rows + at / columns } else { at };
    let values = (0..columns * rows).map(place).map(number).map(|x| if x.is_finite() { x } else { f64::NAN });
    Ok(RawPicture { full_scale, ..RawPicture::plain(values.collect(), columns, rows) })
}

/// What stands after a key of the header, up to the next comma outside of brackets.
fn value<'a>(head: &'a str, key: &str) -> Result<&'a str, Fault> {
    let rest = head.split_once(key).ok_or_else(|| broken(&format!("its header has no {key}")))?.1;
    let mut depth = 0;
    let end = rest.find(|c: char| {
        depth += i32::from(matches!(c, '(' | '[')) - i32::from(matches!(c, ')' | ']'));
        matches!(c, ',' | '}') && depth <= 0
    });
    Ok(rest[..end.unwrap_or(rest.len())].trim())
}

fn shape(head: &str) -> Result<[u64; 2], Fault> {
    let text = value(head, "'shape':")?;
    let sides = text.trim_matches(['(', ')']).split(',').map(str::trim).filter(|side| !side.is_empty());
    match sides.map(str::parse).collect::<Result<Vec<u64>, _>>().as_deref() {
        Ok([rows, columns]) => Ok([*rows, *columns]),
        _ => Err(unsupported(
            &format!("the shape {}", excerpt(text, 40)),
            "save a map of two dimensions, rows and columns",
        )),
    }
}

type Read = fn(&[u8]) -> f64;

/// How a number is read, its bytes, and the largest one if it is a small one without sign.
fn number(kind: &str) -> Result<(Read, usize, Option<f64>), Fault> {
    macro_rules! numbers {
        ($($little:literal $big:literal $type:ty),+) => {
            match kind {
                $($little => (|bytes| <$type>::from_le_bytes(array(bytes)) as f64, size_of::<$type>()),
                $big => (|bytes| <$type>::from_be_bytes(array(bytes)) as f64, size_of::<$type>()),)+
                _ => {
                    return Err(unsupported(&format!("numbers of the kind {}", excerpt(kind, 40)), "save \
                        map.astype(\"float32\")"));
                }
            }
        };
    }
    let (read, size): (Read, usize) = numbers! {
        "<f4" ">f4" f32, "<f8" ">f8" f64, "|u1" "u1" u8, "|i1" "i1" i8, "<u2" ">u2" u16, "<i2" ">i2" i16,
        "<u4" ">u4" u32, "<i4" ">i4" i32, "<u8" ">u8" u64, "<i8" ">i8" i64
    };
    let full_scale = match &kind[kind.len() - 2..] {
        "u1" => Some(u8::MAX.into()),
        "u2" => Some(u16::MAX.into()),
        _ => None,
    };
    Ok((read, size, full_scale))
}

/// The bytes of a number; as many as it has are passed.
fn array<const N: usize>(bytes: &[u8]) -> [u8; N] {
    let mut number = [0; N];
    number.copy_from_slice(bytes);
    number
}
