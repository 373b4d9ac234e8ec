//! What the values of a Parquet column mean: the logical type beside the physical one, and durations of Arrow.

use parquet::basic::{ConvertedType, LogicalType, TimeUnit, Type as Physical};
use parquet::schema::types::ColumnDescriptor;

/// How a value becomes a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Meaning {
    /// A number as it stands.
    Number,
    /// A whole number without a sign.
    Unsigned,
    /// A whole number divided by this power of ten.
    Decimal(f64),
    /// A floating-point number of 16 bits.
    Half,
    /// A time in this unit [s].
    Time(f64),
}

impl Meaning {
    /// What a column holds; the error names what is no number.
    ///
    /// * `duration` – unit of the durations that the Arrow schema says the column has [s]
    pub(super) fn of(column: &ColumnDescriptor, duration: Option<f64>) -> Result<Self, String> {
        let physical = column.physical_type();
        if column.max_rep_level() > 0 || column.max_def_level() > 1 {
            return Err("nested values".to_owned());
        }
        if let Some(unit) = duration {
            return Ok(Self::Time(unit));
        }
        match column.logical_type_ref() {
            Some(LogicalType::Decimal(decimal)) => return decimal_of(decimal.scale),
            Some(LogicalType::Timestamp(stamp)) => return Ok(Self::Time(seconds(&stamp.unit))),
            Some(LogicalType::Time(time)) => return Ok(Self::Time(seconds(&time.unit))),
            Some(LogicalType::Integer(integer)) if !integer.is_signed => return Ok(Self::Unsigned),
            Some(LogicalType::Integer(_)) => return Ok(Self::Number),
            Some(LogicalType::Float16) => return Ok(Self::Half),
            Some(LogicalType::Unknown) => return Err("nothing but missing values".to_owned()),
            Some(LogicalType::Date) => return Err("dates without a time".to_owned()),
            Some(LogicalType::String) => return Err("text or bytes".to_owned()),
            Some(other) => return Err(format!("values of the type {}", name(other))),
            None => {}
        }
        match column.converted_type() {
            ConvertedType::DECIMAL => return decimal_of(column.type_scale()),
            ConvertedType::TIME_MILLIS | ConvertedType::TIMESTAMP_MILLIS => return Ok(Self::Time(1e-3)),
            ConvertedType::TIME_MICROS | ConvertedType::TIMESTAMP_MICROS => return Ok(Self::Time(1e-6)),
            ConvertedType::UINT_8
            | ConvertedType::UINT_16
            | ConvertedType::UINT_32
            | ConvertedType::UINT_64 => return Ok(Self::Unsigned),
            ConvertedType::DATE => return Err("dates without a time".to_owned()),
            ConvertedType::INTERVAL => return Err("intervals of months and days".to_owned()),
            _ => {}
        }
        match physical {
            Physical::BOOLEAN => Err("true and false".to_owned()),
            Physical::INT96 => Ok(Self::Time(1e-9)),
            Physical::BYTE_ARRAY | Physical::FIXED_LEN_BYTE_ARRAY => Err("text or bytes".to_owned()),
            _ => Ok(Self::Number),
        }
    }

    /// Whether the column holds times, which say their unit themselves.
    pub(super) const fn is_time(self) -> bool {
        matches!(self, Self::Time(_))
    }

    /// The unit of the last digit of a number, in the unit of the column.
    pub(super) fn last_place(self, number: f64) -> f64 {
        match self {
            Self::Decimal(power) => 1.0 / power,
            Self::Half => number.abs() * half::f16::EPSILON.to_f64(),
            _ => 1.0,
        }
    }

    /// The number of a whole value.
    pub(super) fn whole(self, value: i64, bits: u32) -> f64 {
        match self {
            Self::Unsigned if bits == 32 => f64::from(value as u32),
            Self::Unsigned => value as u64 as f64,
            Self::Decimal(power) => value as f64 / power,
            _ => value as f64,
        }
    }

    /// The number of a value of bytes; NaN if it has more than 16 of them.
    pub(super) fn bytes(self, bytes: &[u8]) -> f64 {
        match (self, bytes) {
            (Self::Half, [low, high]) => half::f16::from_le_bytes([*low, *high]).to_f64(),
            (Self::Decimal(power), _) => big_endian(bytes).map_or(f64::NAN, |whole| whole as f64 / power),
            _ => f64::NAN,
        }
    }
}

fn decimal_of(scale: i32) -> Result<Meaning, String> {
    match u32::try_from(scale) {
        Ok(scale @ 0..=38) => Ok(Meaning::Decimal(10f64.powi(scale as i32))),
        _ => Err(format!("decimal numbers with the scale {scale}")),
    }
}

fn seconds(unit: &TimeUnit) -> f64 {
    match unit {
        TimeUnit::MILLIS => 1e-3,
        TimeUnit::MICROS => 1e-6,
        TimeUnit::NANOS => 1e-9,
    }
}

fn name(logical: &LogicalType) -> String {
    let shown = format!("{logical:?}");
    shown.split(['(', ' ', '{']).next().unwrap_or_default().to_uppercase()
}

/// A number in two's complement with the highest byte first.
fn big_endian(bytes: &[u8]) -> Option<i128> {
    let first = *bytes.first()?;
    if bytes.len() > 16 {
        return None;
    }
    let fill = if first & 0x80 == 0 { 0 } else { 0xff };
    let mut all = [fill; 16];
    all[16 - bytes.len()..].copy_from_slice(bytes);
    Some(i128::from_be_bytes(all))
}

/// Units of the durations in an Arrow schema [s], by the name of the column; the schema is the text that
/// Parquet files of Arrow carry in their metadata.
pub(super) fn durations(schema: &str) -> Vec<(String, f64)> {
    use base64::Engine;
    let engine = base64::engine::general_purpose::STANDARD_NO_PAD;
    let bytes = engine.decode(schema.trim().trim_end_matches('=')).unwrap_or_default();
    fields(&bytes).unwrap_or_default()
}

/// Number of `Duration` among the types of Arrow.
const DURATION: u8 = 18;
/// Most columns that are looked at.
const MOST_COLUMNS: usize = 1 << 14;

fn fields(bytes: &[u8]) -> Option<Vec<(String, f64)>> {
    // A mark and the length stand before the message; old files have the length only.
    let start = if bytes.starts_with(&[0xff; 4]) { 8 } else { 4 };
    let buffer = FlatBuffer(bytes.get(start..)?);
    let schema = buffer.table(buffer.follow(0)?, 2)?;
    let list = buffer.table(schema, 1)?;
    let count = (buffer.u32(list)? as usize).min(MOST_COLUMNS);
    let mut found = Vec::new();
    for i in 0..count {
        let field = buffer.follow(list + 4 + 4 * i)?;
        let kind = buffer.slot(field, 2).and_then(|at| buffer.0.get(at).copied());
        if kind != Some(DURATION) {
            continue;
        }
        let text = buffer.table(field, 0)?;
        let name = buffer.0.get(text + 4..)?.get(..buffer.u32(text)? as usize)?;
        let unit = buffer.table(field, 3).and_then(|kind| buffer.slot(kind, 0));
        // Milliseconds are the default.
        let unit = unit.map_or(Some(1), |at| buffer.0.get(at).copied())?;
        let seconds = *[1.0, 1e-3, 1e-6, 1e-9].get(usize::from(unit))?;
        found.push((String::from_utf8_lossy(name).into_owned(), seconds));
    }
    Some(found)
}

/// Bytes in the form of FlatBuffers: tables of fields, which stand where offsets point.
struct FlatBuffer<'a>(&'a [u8]);

impl FlatBuffer<'_> {
    fn u32(&self, at: usize) -> Option<u32> {
        Some(u32::from_le_bytes(self.0.get(at..)?.get(..4)?.try_into().ok()?))
    }

    fn u16(&self, at: usize) -> Option<u16> {
        Some(u16::from_le_bytes(self.0.get(at..)?.get(..2)?.try_into().ok()?))
    }

    /// Where the offset at a place points.
    fn follow(&self, at: usize) -> Option<usize> {
        at.checked_add(self.u32(at)? as usize)
    }

    /// Place of a field of a table; none if the table does not have it.
    fn slot(&self, table: usize, field: usize) -> Option<usize> {
        let back = self.u32(table)? as i32;
        let index = usize::try_from(table as i64 - i64::from(back)).ok()?;
        let size = usize::from(self.u16(index)?);
        let entry = 4 + 2 * field;
        let offset = if entry + 2 <= size { self.u16(index + entry)? } else { 0 };
        (offset != 0).then(|| table + usize::from(offset))
    }

    /// Where the offset in a field of a table points.
    fn table(&self, table: usize, field: usize) -> Option<usize> {
        self.follow(self.slot(table, field)?)
    }
}
