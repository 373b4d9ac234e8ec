//! The folder of the air of a case.

use crate::Failure;
use crate::numbers::{THIN, significant};
use crate::output::air::{PLANES, Picture, Slices, Summary, pictures, write_vtk};
use crate::output::copied_files;
use crate::output::folder::Staging;
use crate::report::air_report;
use spunlaid::case::Case;
use spunlaid::input::write_case;
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
    /// The numbers.
    pub fn summary(&self) -> Summary {
        Summary::new(self.case, self.slices, self.replicate, self.notes)
    }

    /// How strong the gusts are, in a sentence.
    pub fn headline(&self) -> String {
        let summary = self.summary();
        let rms = summary.planes.0.first().map_or([0.0; 3], |(_, plane)| plane.rms_m_s);
        let expected = summary.planes.0.first().map_or(0.0, |(_, plane)| plane.expected_rms_m_s);
        let [x, y, z] = rms.map(|rms| significant(rms, 3));
        format!(
            "Gusts of {x}, {y} and {z}{THIN}m/s (rms along x, y and z, over the pictures); {}{THIN}m/s are expected.",
            significant(expected, 3)
        )
    }

    /// Writes the slices, the pictures, the report and the summary.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write(&self, staging: &Staging<'_>) -> Result<(), Failure> {
        let copied = copied_files::copy(self.case.files(), &staging.place(copied_files::CASE_FILES).0)?;
        staging.write("case.toml", write_case(&self.case.with_files_at(copied_files::place(&copied))))?;
        write_vtk(staging, self.slices)?;
        let pictures = pictures(self.case, self.slices)?;
        for (name, picture) in PLANES.iter().zip(&pictures) {
            staging.write(&format!("{name}.gif"), &picture.moving)?;
        }
        let figures: Vec<&Figure> = pictures.iter().map(|Picture { figure, .. }| figure).collect();
        staging.write_figures(&figures)?;
        let report = air_report(self.case, self.slices, &pictures, self.headline());
        staging.write("report.html", report.named(self.name).noting(self.notes).html())?;
        staging.write("summary.json", self.summary().to_json())
    }
}
