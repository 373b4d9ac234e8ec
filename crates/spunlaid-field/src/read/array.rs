//! Arrays of numbers in a file, decoded when they are needed.

use super::encoding::{self, Budget, Packing};
use crate::fault;
use spunlaid_ground::{Fault, FileError, Position};
use std::str::FromStr;

/// A type of number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NumberType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl NumberType {
    /// The type with this name in VTK's XML files.
    pub(super) fn from_xml(name: &str) -> Option<Self> {
        Some(match name {
            "Int8" => Self::I8,
            "UInt8" => Self::U8,
            "Int16" => Self::I16,
            "UInt16" => Self::U16,
            "Int32" => Self::I32,
            "UInt32" => Self::U32,
            "Int64" => Self::I64,
            "UInt64" => Self::U64,
            "Float32" => Self::F32,
            "Float64" => Self::F64,
            _ => return None,
        })
    }

    /// The type with this name in VTK's legacy files.
    pub(super) fn from_legacy(name: &str) -> Option<Self> {
        Some(match name.to_ascii_lowercase().as_str() {
            "char" | "signed_char" | "vtktypeint8" => Self::I8,
            "unsigned_char" | "vtktypeuint8" => Self::U8,
            "short" | "vtktypeint16" => Self::I16,
            "unsigned_short" | "vtktypeuint16" => Self::U16,
            // VTK writes identifiers as 32-bit numbers, also where it uses 64 bits in memory.
            "int" | "vtkidtype" | "vtktypeint32" => Self::I32,
            "unsigned_int" | "vtktypeuint32" => Self::U32,
            "long" | "vtktypeint64" => Self::I64,
            "unsigned_long" | "vtktypeuint64" => Self::U64,
            "float" => Self::F32,
            "double" => Self::F64,
            _ => return None,
        })
    }

    /// [bytes]
    pub(super) const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }
}

/// How the numbers are written.
#[derive(Clone, Debug)]
pub(super) enum Source<'a> {
    /// Text, separated by white space.
    Text(&'a [u8]),
    /// Plain bytes.
    Bytes { bytes: &'a [u8], big_endian: bool },
    /// Numbers that are already decoded.
    Numbers(&'a [f64]),
    /// Blocks of bytes with a header.
    Packed { bytes: &'a [u8], packing: Packing, big_endian: bool },
}

/// An array of numbers.
#[derive(Clone, Debug)]
pub(super) struct Array<'a> {
    pub(super) name: String,
    pub(super) number: NumberType,
    /// Numbers for each point or cell.
    pub(super) components: usize,
    pub(super) source: Source<'a>,
    /// Place in the file.
    pub(super) place: Position,
}

/// The type that numbers are converted to: `f64`, or `i64` for whole numbers.
pub(super) trait ParseNumber: FromStr {
    fn from_float(x: f64) -> Self;
    fn from_signed(x: i64) -> Self;
    fn from_unsigned(x: u64) -> Self;
}

impl ParseNumber for f64 {
    fn from_float(x: f64) -> Self {
        x
    }

    fn from_signed(x: i64) -> Self {
        x as Self
    }

    fn from_unsigned(x: u64) -> Self {
        x as Self
    }
}

impl ParseNumber for i64 {
    fn from_float(x: f64) -> Self {
        x as Self
    }

    fn from_signed(x: i64) -> Self {
        x
    }

    fn from_unsigned(x: u64) -> Self {
        x as Self
    }
}

impl Array<'_> {
    /// All numbers of the array.
    pub(super) fn all<T: ParseNumber>(&self, budget: &mut Budget) -> Result<Vec<T>, FileError> {
        let numbers = match &self.source {
            Source::Text(text) => words(text),
            Source::Numbers(numbers) => Ok(numbers.iter().map(|x| T::from_float(*x)).collect()),
            Source::Bytes { bytes, big_endian } => self.converted(bytes, *big_endian),
            Source::Packed { bytes, packing, big_endian } => {
                let bytes = encoding::unpack(bytes, *packing, *big_endian, self.number.size(), budget);
                bytes.and_then(|bytes| self.converted(&bytes, *big_endian))
            }
        };
        let accepted = numbers.and_then(|numbers: Vec<T>| budget.spend(numbers.len()).map(|()| numbers));
        accepted.map_err(|fault| self.fault(fault))
    }

    /// The numbers for `count` points or cells.
    pub(super) fn numbers<T: ParseNumber>(
        &self,
        count: usize,
        budget: &mut Budget,
    ) -> Result<Vec<T>, FileError> {
        let numbers = self.all(budget)?;
        let wanted = count.saturating_mul(self.components);
        if numbers.len() == wanted {
            return Ok(numbers);
        }
        Err(self.fault(fault::count(numbers.len(), wanted, "numbers")))
    }

    /// An error with the array's name and place.
    pub(super) fn fault(&self, fault: Fault) -> FileError {
        FileError::from(fault).array(&self.name).at(self.place)
    }

    fn converted<T: ParseNumber>(&self, bytes: &[u8], big_endian: bool) -> Result<Vec<T>, Fault> {
        let size = self.number.size();
        let rest = bytes.len() % size;
        if rest != 0 {
            return Err(fault::count(rest, size, "bytes of its last number"));
        }
        let number = |written: &[u8]| {
            let mut bits = [0; 8];
            // Bring the bytes into little-endian order.
            for (i, byte) in written.iter().enumerate() {
                bits[if big_endian { size - 1 - i } else { i }] = *byte;
            }
            let bits = u64::from_le_bytes(bits);
            match self.number {
                NumberType::F32 => T::from_float(f32::from_bits(bits as u32).into()),
                NumberType::F64 => T::from_float(f64::from_bits(bits)),
                NumberType::I8 => T::from_signed((bits as i8).into()),
                NumberType::I16 => T::from_signed((bits as i16).into()),
                NumberType::I32 => T::from_signed((bits as i32).into()),
                NumberType::I64 => T::from_signed(bits as i64),
                NumberType::U8 | NumberType::U16 | NumberType::U32 | NumberType::U64 => {
                    T::from_unsigned(bits)
                }
            }
        };
        Ok(bytes.chunks_exact(size).map(number).collect())
    }
}

/// The numbers in a text.
fn words<T: FromStr>(text: &[u8]) -> Result<Vec<T>, Fault> {
    let words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    let parsed = words.map(|word| {
        let number = str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        number.ok_or_else(|| fault::syntax(&String::from_utf8_lossy(word), "a number"))
    });
    parsed.collect()
}
