//! Values with tabs between them, which a spreadsheet takes in any country.

use super::TableFormat;
use super::csv::separated;

pub(super) const FORMAT: TableFormat =
    TableFormat { name: "tsv", create: |place, columns| separated(b'\t', place, columns) };
