//! The folder of the air of a case.

use super::contents::{Contents, Maker, Page};
use crate::Failure;
use crate::figures::field_figure;
use crate::numbers::{THIN, significant};
use crate::output::air::{PlaneFindings, Slices, pictures, summary, write_vtk};
use crate::output::folder::{CASE_FILES, Staging};
use crate::output::kept_input::Input;
use crate::output::origin::ORIGIN;
use crate::report::air_report;
use spunlaid::case::Case;
use spunlaid_charts::Figure;

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
    /// How strong the gusts are, in a sentence.
    fn headline(&self) -> String {
        let PlaneFindings { rms, expected_rms, .. } = PlaneFindings::new(self.case, self.slices, 0);
        let [x, y, z] = rms.map(|rms| significant(rms, 3));
        format!(
            "Gusts of {x}, {y} and {z}{THIN}m/s (rms along x, y and z, over the pictures); {}{THIN}m/s are expected.",
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
        summary(self.case, self.slices, self.replicate, self.notes)
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let input = maker.keep(Input::Case(self.case))?;
        let field: Vec<Figure> = field_figure(self.case, None).into_iter().collect();
        let pictures = pictures(self.case, self.slices);
        let figures: Vec<&Figure> = field.iter().chain(&pictures).collect();
        let files = |staging: &Staging<'_>| write_vtk(staging, self.slices);
        let report =
            || Ok(air_report((self.case, &input), self.slices, [&field, &pictures], self.headline()));
        maker.finish((self.name, self.notes), &figures, files, report)
    }
}
