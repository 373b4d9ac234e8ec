//! The page of a file that is the scan.

use super::fault::failed;
use super::{GREY, unsupported};
use crate::error::Fault;
use std::io::{Read, Seek};
use tiff::decoder::Decoder;
use tiff::tags::Tag;

/// The bits of NewSubfileType of a page that is a smaller copy of another one, or its mask.
const COPY_OR_MASK: u32 = 1 | 4;
/// The value of the older SubfileType of a smaller copy.
const OLD_COPY: u16 = 2;

/// Goes to the first of the largest pages, and says whether the file has further pictures. A thumbnail is none.
pub(super) fn seek_full<R: Read + Seek>(decoder: &mut Decoder<R>) -> Result<bool, Fault> {
    let mut pages = vec![Page::new(decoder)];
    while decoder.more_images() {
        // A page that cannot be read is not the scan; the places of the others must stay right.
        pages.push(if decoder.next_image().is_ok() { Page::new(decoder) } else { Page::default() });
    }
    let whole = |page: &Page| page.pixels > 0 && !page.is_copy;
    let among = |page: &&Page| !pages.iter().any(whole) || whole(page);
    let largest = pages.iter().filter(among).map(|page| page.pixels).max().unwrap_or(0);
    let best = pages.iter().position(|page| among(&page) && page.pixels == largest).unwrap_or(0);
    if pages.len() > 1 {
        decoder.seek_to_image(best).map_err(failed)?;
    }
    // Raw files of cameras keep the scan behind the thumbnail.
    if pages[best].is_copy && pages[best].has_parts {
        return Err(unsupported("a thumbnail in front and the picture itself in a part behind it", GREY));
    }
    Ok(pages.iter().filter(|page| whole(page)).count() > 1)
}

/// What tells the pages of a file apart.
#[derive(Clone, Copy, Debug, Default)]
struct Page {
    /// Their number; zero if the page cannot be read.
    pixels: u64,
    /// Whether it is a smaller copy of another page, or its mask.
    is_copy: bool,
    /// Whether it has pages of its own.
    has_parts: bool,
}

impl Page {
    fn new<R: Read + Seek>(decoder: &mut Decoder<R>) -> Self {
        let (columns, rows) = decoder.dimensions().unwrap_or_default();
        let kind = decoder.find_tag_unsigned::<u32>(Tag::NewSubfileType).ok().flatten();
        let old = decoder.find_tag_unsigned::<u16>(Tag::SubfileType).ok().flatten();
        Self {
            pixels: u64::from(columns) * u64::from(rows),
            is_copy: kind.map_or(old == Some(OLD_COPY), |kind| kind & COPY_OR_MASK != 0),
            has_parts: decoder.image_ifd().directory().contains(Tag::SubIfd),
        }
    }
}
