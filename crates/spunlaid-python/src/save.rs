//! Figures as a Python user asks for them.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use spunlaid_results::files::pictures::{FigureFiles, Format, width_named};

/// Formats and width of figures: a pair in Python.
#[derive(FromPyObject)]
pub(crate) struct Figures<'py> {
    /// Names of formats, in a list or in a text with commas between them; None for the usual ones.
    #[pyo3(item(0))]
    formats: Option<Bound<'py, PyAny>>,
    /// In print: its name, a length with its unit, or a number [m]; None for that of the screen.
    #[pyo3(item(1))]
    width: Option<Bound<'py, PyAny>>,
}

/// Formats and width of figures.
pub(crate) fn figure_files(figures: Figures<'_>) -> PyResult<FigureFiles> {
    let Figures { formats, width } = figures;
    let usual = FigureFiles::default();
    let formats = match formats {
        None => usual.formats.clone(),
        Some(formats) => names(&formats)?
            .iter()
            .map(|name| Format::named(name))
            .collect::<Result<_, _>>()
            .map_err(|text| PyValueError::new_err(format!("figures: {text}")))?,
    };
    let width = width.map(|width| match width.extract::<f64>() {
        Ok(metres) => Ok(format!("{metres} m")),
        Err(_) => width.extract::<String>().map_err(|_| {
            PyTypeError::new_err(
                "figure_width: write a text, as \"one-column\" or \"90 mm\", or a number of metres",
            )
        }),
    });
    let width = width.transpose()?.map(|text| width_named(&text)).transpose();
    let width = width.map_err(|text| PyValueError::new_err(format!("figure_width: {text}")))?;
    Ok(FigureFiles { formats, width, ..usual })
}

/// Refuses figures that could not be written after a long flight.
#[pyfunction]
pub(crate) fn check_figures(figures: Figures<'_>) -> PyResult<()> {
    figure_files(figures).map(drop)
}

fn names(figures: &Bound<'_, PyAny>) -> PyResult<Vec<String>> {
    if let Ok(text) = figures.extract::<String>() {
        return Ok(text.split(',').map(str::to_owned).collect());
    }
    let wanted = "figures: write the names of formats, as [\"pdf\", \"png\"]";
    figures.extract().map_err(|_| PyTypeError::new_err(wanted))
}
