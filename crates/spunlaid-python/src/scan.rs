//! `analyse_scan`: how even is a web of which there is a scan?

use crate::computed::{Computed, Of};
use crate::source::stem;
use crate::value::positive;
use crate::watched::{Watch, watched};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use spunlaid::ground::{Dimension, Error};
use spunlaid::web::scan::{is_picture_file, parse};
use spunlaid::web::{LightKind, ScanRequest};
use spunlaid_results::reports::scan::ScanFolder;
use std::path::PathBuf;
use std::time::Instant;

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
) -> PyResult<Computed> {
    let request = request(options)?;
    let source = match picture.cast::<PyBytes>() {
        Ok(bytes) => Source::Array(bytes.as_bytes().to_vec()),
        Err(_) => Source::File(picture.extract()?),
    };
    let started = Instant::now();
    let scan = watched(py, &Watch::default(), None, || {
        let (name, analysed) = match &source {
            Source::File(path) => (stem(path), request.analyse_file(path)),
            Source::Array(bytes) => {
                let parsed = parse(bytes, ARRAY, request.pixel);
                (ARRAY.to_owned(), parsed.and_then(|picture| request.analyse_picture(picture)))
            }
        };
        let (picture, findings) = analysed.map_err(Error::File)?;
        Ok(ScanFolder::new(name, picture.file, findings, started))
    })?;
    Ok(Computed { name: scan.name.clone(), of: Of::Scan(Box::new(scan)) })
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
