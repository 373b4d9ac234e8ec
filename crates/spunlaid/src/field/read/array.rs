//! Arrays of numbers, as they stand in a file until they are asked for.

use super::encoding::{self, Budget, Packing};
use crate::error::{FieldError, FieldFault, FieldPlace};
use crate::units::excerpt;
use std::borrow::Cow;

/// A type of number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Number {
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

impl Number {
    /// By its name in VTK’s XML files.
    pub(super) fn of_xml(name: &str) -> Option<Self> {
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

    /// By its name in VTK’s legacy files.
    pub(super) fn of_legacy(name: &str) -> Option<Self> {
        Some(match name.to_ascii_lowercase().as_str() {
            "char" | "signed_char" | "vtktypeint8" => Self::I8,
            "unsigned_char" | "vtktypeuint8" => Self::U8,
            "short" | "vtktypeint16" => Self::I16,
            "unsigned_short" | "vtktypeuint16" => Self::U16,
            // Identifiers are written as 32-bit numbers, whatever they are in memory.
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
    /// As text, parted by white space.
    Text(&'a [u8]),
    /// As bytes and nothing else; whether the largest byte of a number comes first.
    Bytes { bytes: &'a [u8], big_endian: bool },
    /// As they are.
    Numbers(&'a [f64]),
    /// As blocks of bytes with a header.
    Packed { bytes: &'a [u8], packing: Packing, big_endian: bool },
}

/// An array of numbers.
#[derive(Clone, Debug)]
pub(super) struct Array<'a> {
    pub(super) name: String,
    pub(super) number: Number,
    /// Of each point or cell.
    pub(super) components: usize,
    pub(super) source: Source<'a>,
    /// Where it is in the file.
    pub(super) place: FieldPlace,
}

impl Array<'_> {
    /// The numbers, so many of them for each of `count` points or cells.
    pub(super) fn floats(&self, count: usize, budget: &mut Budget) -> Result<Vec<f64>, FieldError> {
        let wanted = count.saturating_mul(self.components);
        self.counted(wanted, self.all_floats(budget).map_err(|fault| self.fault(fault))?)
    }

    /// All whole numbers there are.
    pub(super) fn integers(&self, budget: &mut Budget) -> Result<Vec<i64>, FieldError> {
        let read = |budget: &mut Budget| match self.source {
            Source::Text(text) => words(text, |word| word.parse().ok()),
            _ => {
                let (bytes, big_endian) = self.bytes(budget)?;
                self.converted(&bytes, big_endian, |x| x as i64, |x| x, |x| x as i64)
            }
        };
        read(budget).map_err(|fault| self.fault(fault))
    }

    /// As many whole numbers as these.
    pub(super) fn so_many_integers(
        &self,
        wanted: usize,
        budget: &mut Budget,
    ) -> Result<Vec<i64>, FieldError> {
        self.counted(wanted, self.integers(budget)?)
    }

    /// The same with the array’s name.
    pub(super) fn fault(&self, fault: FieldFault) -> FieldError {
        FieldError::from(fault).array(&self.name).at(self.place)
    }

    fn counted<T>(&self, wanted: usize, numbers: Vec<T>) -> Result<Vec<T>, FieldError> {
        if numbers.len() == wanted {
            return Ok(numbers);
        }
        Err(self.fault(FieldFault::Count { found: numbers.len(), wanted, of: "numbers" }))
    }

    fn all_floats(&self, budget: &mut Budget) -> Result<Vec<f64>, FieldFault> {
        match self.source {
            Source::Text(text) => words(text, |word| word.parse().ok()),
            Source::Numbers(numbers) => Ok(numbers.to_vec()),
            _ => {
                let (bytes, big_endian) = self.bytes(budget)?;
                self.converted(&bytes, big_endian, |x| x, |x| x as f64, |x| x as f64)
            }
        }
    }

    fn bytes(&self, budget: &mut Budget) -> Result<(Cow<'_, [u8]>, bool), FieldFault> {
        match &self.source {
            Source::Text(_) | Source::Numbers(_) => Ok((Cow::Borrowed(&[]), false)),
            Source::Bytes { bytes, big_endian } => Ok((Cow::Borrowed(bytes), *big_endian)),
            Source::Packed { bytes, packing, big_endian } => {
                Ok((encoding::unpack(bytes, *packing, *big_endian, budget)?, *big_endian))
            }
        }
    }

    fn converted<T>(
        &self,
        bytes: &[u8],
        big_endian: bool,
        of_float: impl Fn(f64) -> T,
        of_signed: impl Fn(i64) -> T,
        of_unsigned: impl Fn(u64) -> T,
    ) -> Result<Vec<T>, FieldFault> {
        let size = self.number.size();
        if !bytes.len().is_multiple_of(size) {
            return Err(FieldFault::Count {
                found: bytes.len() % size,
                wanted: size,
                of: "bytes of its last number",
            });
        }
        let number = |written: &[u8]| {
            let mut bits = [0; 8];
            // The lowest byte first, whatever the file has.
            for (i, byte) in written.iter().enumerate() {
                bits[if big_endian { size - 1 - i } else { i }] = *byte;
            }
            let bits = u64::from_le_bytes(bits);
            match self.number {
                Number::F32 => of_float(f32::from_bits(bits as u32).into()),
                Number::F64 => of_float(f64::from_bits(bits)),
                Number::I8 => of_signed((bits as i8).into()),
                Number::I16 => of_signed((bits as i16).into()),
                Number::I32 => of_signed((bits as i32).into()),
                Number::I64 => of_signed(bits as i64),
                Number::U8 | Number::U16 | Number::U32 | Number::U64 => of_unsigned(bits),
            }
        };
        Ok(bytes.chunks_exact(size).map(number).collect())
    }
}

/// The numbers in a text.
fn words<T>(text: &[u8], number: impl Fn(&str) -> Option<T>) -> Result<Vec<T>, FieldFault> {
    let words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    let parsed = words.map(|word| {
        let number = str::from_utf8(word).ok().and_then(&number);
        number.ok_or_else(|| FieldFault::NotANumber { text: excerpt(&String::from_utf8_lossy(word), 40) })
    });
    parsed.collect()
}
