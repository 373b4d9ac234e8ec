//! Text tables: a line for each row of the map.

use super::{RawPicture, within_limits};
use crate::error::{FileError, FileKind};
use crate::table::Table;

pub(super) fn parse(bytes: &[u8]) -> Result<RawPicture, FileError> {
    let mut table = Table::open(bytes, FileKind::Scan, 0)?;
    let columns = table.heads().len();
    let (mut values, mut rows) = (Vec::new(), 0);
    while table.next_row()? {
        rows += 1;
        within_limits(columns as u64, rows as u64)?;
        for column in 0..columns {
            values.push(table.number(column)?);
        }
    }
    Ok(RawPicture::plain(values, columns, rows))
}
