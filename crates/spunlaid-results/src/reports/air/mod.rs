//! The turbulent air of a case, looked at in two planes while it passes.

mod figures;
mod files;
mod report;

pub use files::{AirViews, POINT_COLUMNS, Slices, outside, point_row, points_csv};

use crate::Failure;
use crate::files::folder::{CASE_FILES, Staging};
use crate::files::kept_input::Input;
use crate::files::origin::ORIGIN;
use crate::folders::{Contents, Maker, Page};
use crate::numbers::{THIN, significant};
use crate::reports::run::figures::air::field_figure;
use figures::pictures;
use files::PlaneFindings;
use report::air_report;
use spunlaid_charts::Figure;
use spunlaid_fibre::Case;

/// Everything of a look at the air that goes into the files.
#[derive(Clone, Copy, Debug)]
pub struct AirFolder<'a> {
    /// What the case is called: the name of its file.
    pub name: &'a str,
    /// The case.
    pub case: &'a Case,
    /// What was found.
    pub slices: &'a Slices,
    /// Number of the replicate whose air it is, from 0.
    pub replicate: u64,
    /// Notes for the reader.
    pub notes: &'a [String],
}

impl AirFolder<'_> {
    /// How strong the eddies are, in a sentence.
    fn headline(&self) -> String {
        let PlaneFindings { rms, expected_rms, .. } = PlaneFindings::new(self.case, self.slices, 0);
        let [x, y, z] = rms.map(|rms| significant(rms, 3));
        format!(
            "Turbulence of {x}, {y} and {z}{THIN}m/s (rms along x, y and z, all frames); {}{THIN}m/s are expected.",
            significant(expected_rms, 3)
        )
    }
}

impl Contents for AirFolder<'_> {
    const ENTRIES: &'static [&'static str] = &[
        ORIGIN,
        CASE_FILES,
        "case.toml",
        "along.pvd",
        "across.pvd",
        "slices",
        "figures",
        "report.html",
        "summary.json",
    ];

    fn summary(&self) -> String {
        files::summary(self.case, self.slices, self.replicate, self.notes)
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let input = maker.keep(Input::Case(self.case))?;
        let field: Vec<Figure> = field_figure(self.case, None).into_iter().collect();
        let pictures = pictures(self.case, self.slices);
        let figures: Vec<&Figure> = field.iter().chain(&pictures).collect();
        let files = |staging: &Staging<'_>| files::write_vtk(staging, self.slices);
        let report = || Ok(air_report(self.case, &input, self.slices, [&field, &pictures], self.headline()));
        maker.finish(self.name, self.notes, &figures, files, report)
    }
}
