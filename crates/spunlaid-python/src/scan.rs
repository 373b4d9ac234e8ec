//! `analyse_scan`: how even is a web of which there is a scan, and `AnalysedScan`, its results.

use crate::save::{Figures, save};
use crate::source::stem;
use crate::value::positive;
use crate::watched::{Watch, watched};
use crate::web::{patch_columns, weights};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use spunlaid::ground::{Dimension, Error, Isa};
use spunlaid::simulation::OF_SCANNED_PATCHES;
use spunlaid::web::scan::{Findings, PatchFindings, is_picture_file, parse};
use spunlaid::web::{Fabric, LightKind, ScanRequest, fabric};
use spunlaid_results::folders::Contents;
use spunlaid_results::folders::products::{ScanFolder, notes};
use spunlaid_results::output::web::Performance;
use std::path::PathBuf;
use std::time::Instant;

/// What is found of a scan. spunlaid.Scan shows it.
#[pyclass(frozen, module = "spunlaid._spunlaid")]
#[derive(Debug)]
pub(crate) struct AnalysedScan {
    #[pyo3(get)]
    name: String,
    file: String,
    findings: Findings,
    fabric: Fabric,
    #[pyo3(get)]
    notes: Vec<String>,
    performance: Performance,
}

/// What a scan is read from.
enum Source {
    File(PathBuf),
    /// The bytes of an array, as NumPy writes it to a file.
    Array(Vec<u8>),
}

/// Analyses a scan. See spunlaid.scan, which calls it.
///
/// * `picture` – path of a file, or the bytes of a .npy file
#[pyfunction]
pub(crate) fn analyse_scan(
    py: Python<'_>,
    picture: &Bound<'_, PyAny>,
    options: &Bound<'_, PyDict>,
) -> PyResult<AnalysedScan> {
    let request = request(options)?;
    let source = match picture.cast::<PyBytes>() {
        Ok(bytes) => Source::Array(bytes.as_bytes().to_vec()),
        Err(_) => Source::File(picture.extract()?),
    };
    let started = Instant::now();
    let (name, picture, findings) = watched(py, &Watch::default(), None, || {
        let analysed = match &source {
            Source::File(path) => request.analyse_file(path).map(|found| (stem(path), found)),
            Source::Array(bytes) => parse(bytes, ARRAY, request.pixel)
                .and_then(|picture| request.analyse_picture(picture))
                .map(|found| (ARRAY.to_owned(), found)),
        };
        analysed.map(|(name, (picture, findings))| (name, picture, findings)).map_err(Error::File)
    })?;
    let performance = Performance::measure(started, 1, Isa::detect());
    let (fabric, notes) = (fabric::of_scan(&findings), notes(&findings));
    Ok(AnalysedScan { name, file: picture.file, findings, fabric, notes, performance })
}

/// What messages call an array.
const ARRAY: &str = "array";

fn request(options: &Bound<'_, PyDict>) -> PyResult<ScanRequest> {
    let given = |name: &str| Ok::<_, PyErr>(options.get_item(name)?.filter(|value| !value.is_none()));
    let number =
        |name: &str, dimension| given(name)?.map(|value| positive(name, &value, dimension)).transpose();
    let flag = |name: &str| given(name)?.map_or(Ok(false), |value| value.is_truthy());
    let named = |value: &Bound<'_, PyAny>| {
        let text: Option<String> = value.extract().ok();
        LightKind::ALL.into_iter().find(|kind| text.as_deref() == Some(kind.name())).ok_or_else(|| {
            let known = LightKind::ALL.map(|kind| format!("\"{}\"", kind.name())).join(", ");
            PyValueError::new_err(format!("light is one of {known}, not {value}"))
        })
    };
    let sides = |value: Bound<'_, PyAny>| -> PyResult<Vec<f64>> {
        let wanted = |_| PyTypeError::new_err("patches is a list of lengths, [\"1 mm\", 0.005]");
        let parts = value.try_iter().map_err(wanted)?;
        parts.map(|part| positive("patches", &part?, Dimension::Length)).collect()
    };
    let request = ScanRequest {
        pixel: number("pixel", Dimension::Length)?,
        light: given("light")?.as_ref().map(named).transpose()?,
        weight: number("weight", Dimension::BasisWeight)?,
        white: number("white", Dimension::Ratio)?,
        lamp: given("lamp")?.map(|lamp| lamp.extract()).transpose()?,
        md_along_rows: flag("md_along_rows")?,
        keep_shading: flag("keep_shading")?,
        keep_spots: flag("keep_spots")?,
        noise: number("noise", Dimension::Ratio)?,
        titre: number("titre", Dimension::LinearDensity)?,
        patches: given("patches")?.map(sides).transpose()?.unwrap_or_default(),
    };
    if request.lamp.is_some() && request.white.is_some() {
        return Err(PyValueError::new_err("lamp and white say the same; leave one of them out"));
    }
    Ok(request)
}

/// Whether a file is the scan of a web, by its name or by how it begins.
#[pyfunction]
pub(crate) fn is_scan(path: PathBuf) -> bool {
    is_picture_file(&path)
}

impl AnalysedScan {
    fn folder(&self) -> ScanFolder<'_> {
        ScanFolder {
            name: &self.name,
            file: &self.file,
            findings: &self.findings,
            fabric: &self.fabric,
            notes: &self.notes,
            performance: self.performance,
        }
    }
}

#[pymethods]
impl AnalysedScan {
    /// Text of summary.json.
    #[getter]
    fn summary(&self) -> String {
        self.folder().summary()
    }

    /// Side of a pixel [m].
    #[getter]
    const fn cell(&self) -> f64 {
        self.findings.map.cell
    }

    /// Basis weight of every pixel [kg/m2]: rows in machine direction x columns in cross direction.
    #[getter]
    fn map<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        weights(py, &self.findings.map)
    }

    /// The unevenness over patches: side of the patch [m], the CV with its error by chance and the ends of
    /// its 95 % interval, and every declared number of them. What is not known is NaN.
    #[getter]
    fn patches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let about = |patch: &PatchFindings| (patch.unevenness.patch, patch.interval.ok());
        patch_columns(py, &self.findings.patches, OF_SCANNED_PATCHES, about)
    }

    /// Writes the folder that `spunlaid analyse` writes.
    fn save(&self, py: Python<'_>, path: PathBuf, force: bool, figures: Figures<'_>) -> PyResult<()> {
        save(py, (&path, force, figures), &self.folder(), |_| Ok(()))
    }
}
