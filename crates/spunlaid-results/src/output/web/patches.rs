//! The table of the unevenness over patches, for the report and for the terminal.

use crate::numbers::{THIN, plus_minus, significant};
use crate::output::measured::text;
use spunlaid::observe::{ErrorRole, Measure, OF_PATCHES};
use spunlaid::web::{Findings, PatchFindings};

/// Who reads a table; its heads differ, and in the report every number has its unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reader {
    /// The reader of the report.
    Report,
    /// The reader of the terminal.
    Terminal,
}

/// The unevenness over patches, a row for each size: what the map says, then every declared column that the web has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PatchTable {
    /// Heads of the columns.
    pub heads: Vec<&'static str>,
    /// The cells of each row.
    pub rows: Vec<Vec<String>>,
}

impl PatchTable {
    /// The table of a web that has been laid.
    pub fn new(findings: &Findings, reader: Reader) -> Self {
        // That of a web of few filaments holds what these do too.
        let is_of_few = findings.patches.iter().any(|patch| patch.few.is_some());
        let of_map = match (reader, is_of_few) {
            (Reader::Report, true) => ["Patch", "CV of this web", "of its error: chance", "95 % interval"],
            (Reader::Report, false) => {
                ["Patch", "CV of this map", "of its error: chance", "95 % interval by chance"]
            }
            (Reader::Terminal, true) => ["patch", "this web", "by chance", "95 % interval"],
            (Reader::Terminal, false) => ["patch", "this map", "by chance", "95 % by chance"],
        };
        let declared = columns(findings, reader);
        let row = |patch: &PatchFindings| {
            let cells = declared.iter().map(|measure| reader.cell(text(&measure.of(patch))));
            reader.cells_of_map(patch).into_iter().chain(cells).collect()
        };
        Self {
            heads: of_map.into_iter().chain(declared.iter().map(|measure| reader.head(measure))).collect(),
            rows: findings.patches.iter().map(row).collect(),
        }
    }
}

/// The declared columns that a reader sees of a web, in their order: after that of the CV its further errors,
/// then the other measures. The standard error of a measure stands with it.
fn columns(findings: &Findings, reader: Reader) -> Vec<&'static Measure<PatchFindings>> {
    let of_measure = |measure: &'static Measure<PatchFindings>| {
        let further = measure.errors.iter().filter(|error| error.role == ErrorRole::Further);
        std::iter::once(measure).chain(further)
    };
    let is_shown = |measure: &&Measure<PatchFindings>| {
        !reader.head(measure).is_empty() && findings.patches.iter().any(measure.is_shown)
    };
    OF_PATCHES.iter().flat_map(of_measure).skip(1).filter(is_shown).collect()
}

impl Reader {
    const fn head(self, measure: &Measure<PatchFindings>) -> &'static str {
        match self {
            Self::Report => measure.label,
            Self::Terminal => measure.terse(),
        }
    }

    /// A number in per cent, or a dash.
    fn cell(self, number: Option<String>) -> String {
        match (number, self) {
            (None, _) => "–".to_owned(),
            (Some(number), Self::Report) => format!("{number}{THIN}%"),
            (Some(number), Self::Terminal) => number,
        }
    }

    /// Side of the patches, CV with its error by all causes, or by chance alone if the others are not known,
    /// error by chance, and interval.
    fn cells_of_map(self, patch: &PatchFindings) -> [String; 4] {
        let (told, error) = (patch.told(), patch.whole_error());
        let whole = error.whole().or(error.chance);
        let space = if self == Self::Report { THIN } else { ' ' };
        let ends = |ends: [f64; 2]| ends.map(|end| significant(100.0 * end, 3)).join(" to ");
        [
            format!("{}{space}mm", significant(patch.map.patch * 1e3, 3)),
            self.cell(told.map(|told| plus_minus(100.0 * told.cv, whole.map(|error| 100.0 * error)))),
            self.cell(error.chance.map(|error| significant(100.0 * error, 2))),
            self.cell(patch.interval().map(ends)),
        ]
    }
}
