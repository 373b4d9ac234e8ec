//! Decodes the blocks of bytes in VTK's XML files. They have a header and may be compressed and in base 64.

use crate::fault;
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use spunlaid_ground::Fault;
use std::borrow::Cow;
use std::io::Read;

/// Most that is taken from a file, as numbers of eight bytes [bytes].
const MOST: u64 = 1 << 32;
/// Largest number of bytes that LZ4 can make from one byte.
const LZ4_EXPANSION: usize = 255;
/// Largest number of bytes that zlib can make from one byte.
const ZLIB_EXPANSION: usize = 1032;

/// How blocks of bytes are packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Packing {
    pub(super) base64: bool,
    pub(super) compressor: Compressor,
    /// Whether the numbers of the header have 64 bits.
    pub(super) wide_header: bool,
}

/// How blocks of bytes are compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compressor {
    None,
    Zlib,
    Lz4,
}

/// How many bytes may still be decoded from a file.
#[derive(Debug)]
pub(super) struct Budget(u64);

impl Budget {
    pub(super) const fn new() -> Self {
        Self(MOST)
    }

    /// Counts numbers that are decoded, and refuses those beyond the limit.
    pub(super) fn spend(&mut self, numbers: usize) -> Result<(), Fault> {
        let left = self.0.checked_sub((numbers as u64).saturating_mul(8));
        self.0 = left.ok_or_else(|| fault::too_large(MOST))?;
        Ok(())
    }

    /// Whether so many bytes may be decoded: they and the numbers they become are in memory together.
    ///
    /// * `size` – of a number as written [bytes]
    fn allow(&self, bytes: usize, size: usize) -> Result<(), Fault> {
        let numbers = (bytes / size.max(1)).saturating_mul(8);
        let together = bytes.saturating_add(numbers) as u64;
        if together > self.0 { Err(fault::too_large(MOST)) } else { Ok(()) }
    }
}

/// Unpacks the bytes of an array. What follows them is ignored.
///
/// * `size` – of a number as written [bytes]
pub(super) fn unpack<'a>(
    packed: &'a [u8],
    packing: Packing,
    big_endian: bool,
    size: usize,
    budget: &Budget,
) -> Result<Cow<'a, [u8]>, Fault> {
    let packed = if packing.base64 { Cow::Owned(of_base64(packed)?) } else { Cow::Borrowed(packed) };
    let mut header = Header { bytes: &packed, at: 0, wide: packing.wide_header, big_endian };
    if packing.compressor == Compressor::None {
        let length = header.number("the number of bytes")?;
        let (start, end) = (header.at, header.at.saturating_add(length));
        if end > packed.len() {
            return Err(Fault::cut_off("the rest of the numbers"));
        }
        return Ok(match packed {
            Cow::Borrowed(bytes) => Cow::Borrowed(&bytes[start..end]),
            Cow::Owned(bytes) => Cow::Owned(bytes[start..end].to_vec()),
        });
    }
    let blocks = header.number("the number of blocks")?;
    if blocks == 0 {
        return Ok(Cow::Borrowed(&[]));
    }
    let number_size = size;
    let [size, last] = [header.number("the size of blocks")?, header.number("the size of the last block")?];
    let width = if packing.wide_header { 8 } else { 4 };
    if blocks > (packed.len() - header.at) / width {
        return Err(Fault::cut_off("the sizes of the blocks"));
    }
    let mut rest = &packed[header.at + blocks * width..];
    let whole = (blocks - 1).saturating_mul(size).saturating_add(if last > 0 { last } else { size });
    budget.allow(whole, number_size)?;
    // The whole is taken at once, because a growing list would take up to three times as much, but no more than the
    // blocks can expand to.
    let expansion = if packing.compressor == Compressor::Lz4 { LZ4_EXPANSION } else { ZLIB_EXPANSION };
    let mut bytes = Vec::with_capacity(whole.min(rest.len().saturating_mul(expansion)));
    for block in 0..blocks {
        let length = header.number("the size of a block")?;
        let Some((compressed, after)) = rest.split_at_checked(length) else {
            return Err(Fault::cut_off("the rest of a compressed block"));
        };
        rest = after;
        let wanted = if block + 1 == blocks && last > 0 { last } else { size };
        expand(compressed, wanted, packing.compressor, &mut bytes)?;
    }
    Ok(Cow::Owned(bytes))
}

/// Expands a block and adds its `wanted` bytes to the output.
fn expand(
    compressed: &[u8],
    wanted: usize,
    compressor: Compressor,
    bytes: &mut Vec<u8>,
) -> Result<(), Fault> {
    let before = bytes.len();
    let expanded = match compressor {
        Compressor::None | Compressor::Zlib => {
            let decoder = flate2::bufread::ZlibDecoder::new(compressed);
            decoder.take(wanted as u64).read_to_end(bytes).map_err(|error| error.to_string())
        }
        // The header may promise more than the block can hold, so memory is taken only for what the block can
        // expand to.
        Compressor::Lz4 if wanted / LZ4_EXPANSION > compressed.len() => Ok(0),
        Compressor::Lz4 => {
            bytes.resize(before + wanted, 0);
            lz4_flex::block::decompress_into(compressed, &mut bytes[before..])
                .map_err(|error| error.to_string())
        }
    };
    let found = expanded.map_err(|message| fault::encoding(&message))?;
    if found == wanted {
        return Ok(());
    }
    Err(fault::encoding(&format!("a block holds {found} bytes, but its header announces {wanted}")))
}

/// Reads the numbers of a header one after the other.
struct Header<'a> {
    bytes: &'a [u8],
    at: usize,
    wide: bool,
    big_endian: bool,
}

impl Header<'_> {
    fn number(&mut self, wanted: &'static str) -> Result<usize, Fault> {
        let size = if self.wide { 8 } else { 4 };
        let written = self.bytes.get(self.at..self.at + size).ok_or_else(|| Fault::cut_off(wanted))?;
        self.at += size;
        let number = written.iter().enumerate().fold(0, |sum, (i, byte)| {
            let place = if self.big_endian { size - 1 - i } else { i };
            sum | u64::from(*byte) << (8 * place)
        });
        Ok(usize::try_from(number).unwrap_or(usize::MAX))
    }
}

/// Decodes base 64. A header may be encoded separately; it then ends with padding.
fn of_base64(text: &[u8]) -> Result<Vec<u8>, Fault> {
    let config = GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true);
    let engine = GeneralPurpose::new(&STANDARD, config);
    let text: Cow<'_, [u8]> = if text.iter().any(u8::is_ascii_whitespace) {
        Cow::Owned(text.iter().copied().filter(|byte| !byte.is_ascii_whitespace()).collect())
    } else {
        Cow::Borrowed(text)
    };
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 3);
    for part in text.split(|byte| *byte == b'=').filter(|part| !part.is_empty()) {
        let decoded = engine.decode_vec(part, &mut bytes);
        decoded.map_err(|error| fault::encoding(&error.to_string()))?;
    }
    Ok(bytes)
}
