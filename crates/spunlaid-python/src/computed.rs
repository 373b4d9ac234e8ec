//! `Computed`: the results of a run, a web, a scan, a spinline or a comparison, which are what goes into their folder.
//! Python reads them from there, but for what no file holds as it is computed.

use crate::keys::described;
use crate::save::{Figures, figure_files};
use crate::source::Source;
use crate::table::{column, locked};
use crate::value::{overrides, positive};
use crate::warning::warn_of;
use crate::watched::{Watch, guarded, settled, watched};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyBytes, PyDict};
use spunlaid::ground::{Dimension, FileKind};
use spunlaid::input::{Overrides, read_spinline, write_spinline};
use spunlaid::simulation::{CurveValue, Trajectory};
use spunlaid::web::Map;
use spunlaid_results::Failure;
use spunlaid_results::files::folder::{Staging, copy};
use spunlaid_results::folders::Contents;
use spunlaid_results::reports::comparison::{ComparedFolders, Folders};
use spunlaid_results::reports::run::RunFolder;
use spunlaid_results::reports::scan::ScanFolder;
use spunlaid_results::reports::spinline::SpinFolder;
use spunlaid_results::reports::spinline::files::COLUMNS;
use spunlaid_results::reports::web::WebFolder;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Results, which `spunlaid.Run` and others show.
#[pyclass(frozen, module = "spunlaid._spunlaid")]
#[derive(Debug)]
pub(crate) struct Computed {
    /// What they are called.
    #[pyo3(get)]
    pub(crate) name: String,
    pub(crate) of: Of,
}

/// What they are of.
#[derive(Debug)]
pub(crate) enum Of {
    Run(Box<RunFolder>),
    Web(Box<WebFolder>),
    Scan(Box<ScanFolder>),
    Spinline(Box<SpinFolder>),
    Comparison(Box<ComparedFolders>),
}

/// What holds for the contents of any folder.
macro_rules! contents {
    ($computed:expr, $contents:ident => $work:expr) => {
        match &$computed.of {
            Of::Run($contents) => $work,
            Of::Web($contents) => $work,
            Of::Scan($contents) => $work,
            Of::Spinline($contents) => $work,
            Of::Comparison($contents) => $work,
        }
    };
}

impl Computed {
    fn run(&self) -> Option<&RunFolder> {
        if let Of::Run(run) = &self.of { Some(run) } else { None }
    }
}

#[pymethods]
impl Computed {
    /// Text of the summary.
    #[getter]
    fn summary(&self) -> String {
        contents!(self, contents => contents.summary())
    }

    /// The report, one page of HTML that works offline.
    fn report(&self, py: Python<'_>) -> PyResult<String> {
        let watch = Watch::default();
        watched(py, &watch, None, || contents!(self, contents => contents.html(watch.making())))
    }

    /// Writes the folder `path` that the program writes, which replaces an old one with `force`.
    ///
    /// * `written` – a folder with files that were written before
    #[pyo3(signature = (path, force, figures, written = None))]
    fn save(
        &self,
        py: Python<'_>,
        path: PathBuf,
        force: bool,
        figures: Figures<'_>,
        written: Option<PathBuf>,
    ) -> PyResult<()> {
        let figures = figure_files(figures)?;
        let watch = Watch::default();
        watched(
            py,
            &watch,
            None,
            || contents!(self, contents => write(&**contents, &path, force, figures, written.as_deref(), &watch)),
        )
    }

    /// Basis weight of every cell of a web or a scan [kg/m2]: rows in machine direction x columns in cross direction.
    #[getter]
    fn map<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let map = match &self.of {
            Of::Web(web) => &web.findings.laid.map,
            Of::Scan(scan) => &scan.findings.map,
            _ => return Ok(None),
        };
        weights(py, map).map(Some)
    }

    /// The measures of a run that are curves: a dict for each.
    #[getter]
    fn curves<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let curves = self.run().map_or(&[][..], |run| &run.results.curves);
        let dict = |curve: &spunlaid::simulation::Curve| {
            let dict = described(py, curve.measure)?;
            let put = |name, of: &dyn Fn(&CurveValue) -> f64| {
                dict.set_item(name, column(py, curve.places.iter().map(of))?)
            };
            put("at", &|place| place.at)?;
            put("mean", &|place| place.mean)?;
            put("standard_error", &|place| place.standard_error.unwrap_or(f64::NAN))?;
            put("largest", &|place| place.largest)?;
            Ok(dict)
        };
        curves.iter().map(dict).collect()
    }

    /// Times, and positions of all nodes of a run: replicates x times x nodes x 3, NaN where a fibre has fewer nodes.
    #[getter]
    fn shapes<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let all = self.run().map_or(&[][..], |run| &run.results.trajectories).iter();
        let kept: Vec<&Trajectory> = all.filter(|trajectory| !trajectory.shapes.is_empty()).collect();
        let count = kept.first().map_or(0, |trajectory| trajectory.shapes.len());
        let nodes = kept.iter().map(|trajectory| trajectory.shapes.most_nodes()).max().unwrap_or(0);
        let (times, flat) = guarded(py, || {
            let mut times = Vec::new();
            let mut flat = Vec::with_capacity(kept.len() * count * nodes * 3);
            for shape in kept.iter().flat_map(|trajectory| trajectory.shapes.iter()) {
                let shape = shape?;
                times.push(shape.time);
                flat.extend(shape.position.iter().flat_map(|p| [p.x, p.y, p.z]));
                flat.extend(std::iter::repeat_n(f64::NAN, 3 * (nodes - shape.position.len())));
            }
            Ok((times, flat))
        })?;
        let positions = PyArray1::from_vec(py, flat).reshape([kept.len(), count, nodes, 3])?;
        Ok((column(py, times.into_iter().take(count))?, locked(positions.as_any())?))
    }

    /// The specification sheet of a web, as PDF.
    fn specification<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let Of::Web(web) = &self.of else { return Ok(None) };
        let page = watched(py, &Watch::default(), None, || web.specification())?;
        Ok(Some(PyBytes::new(py, &page)))
    }

    /// The thread of a spinline from the die to the end, for each row of the curtain: the columns of spinline.parquet.
    #[getter]
    fn stations<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let Of::Spinline(spinline) = &self.of else { return Ok(Vec::new()) };
        let columns = |row: &spunlaid::fibre::Solution| {
            let column = |of| PyArray1::from_iter(py, row.stations.iter().map(of));
            COLUMNS.iter().map(|(name, of)| (*name, column(of))).into_py_dict(py)
        };
        spinline.results.rows.iter().map(columns).collect()
    }

    /// A spinline with every default written out, as a file.
    #[getter]
    fn text(&self) -> Option<String> {
        if let Of::Spinline(spinline) = &self.of { Some(write_spinline(&spinline.file.spec)) } else { None }
    }
}

fn write<C: Contents>(
    contents: &C,
    path: &Path,
    force: bool,
    figures: spunlaid_results::files::pictures::FigureFiles,
    written: Option<&Path>,
    watch: &Watch,
) -> Result<(), Failure> {
    let mut staging = Staging::new(path, C::ENTRIES, force, &watch.stop)?;
    staging.set_figures(&figures);
    for file in written.and_then(|folder| fs::read_dir(folder).ok()).into_iter().flatten().flatten() {
        let (now, later) = staging.place(&file.file_name().to_string_lossy());
        fs::copy(file.path(), now).map_err(Failure::unwritable(&later))?;
    }
    contents.write(&staging, watch.making())?;
    staging.publish()
}

/// Solves a spinline. See spunlaid.spin, which calls it.
#[pyfunction]
pub(crate) fn solve_spinline(
    py: Python<'_>,
    path: Option<PathBuf>,
    changes: &Bound<'_, PyAny>,
) -> PyResult<Computed> {
    let changes = overrides(changes)?;
    let set = Overrides::new(&changes, "spin:");
    let Source { name, text, file } = Source::read(py, path, FileKind::Case, "spinline")?;
    let file = settled(py, None, |resources| read_spinline((&text, &file), set.with(resources)))?;
    warn_of(py, &file.notes)?;
    let spinline = guarded(py, || SpinFolder::solve(name.clone(), file))?;
    Ok(Computed { name, of: Of::Spinline(Box::new(spinline)) })
}

/// The factor on the drag of a spinline with which its filament has a titre. See spunlaid.find_drag_factor.
#[pyfunction]
pub(crate) fn find_drag_factor(
    py: Python<'_>,
    path: Option<PathBuf>,
    titre: &Bound<'_, PyAny>,
    changes: &Bound<'_, PyAny>,
) -> PyResult<f64> {
    let titre = positive("titre", titre, Dimension::LinearDensity)?;
    let changes = overrides(changes)?;
    let set = Overrides::new(&changes, "find_drag_factor:");
    let Source { text, file, .. } = Source::read(py, path, FileKind::Case, "spinline")?;
    let file = settled(py, None, |resources| read_spinline((&text, &file), set.with(resources)))?;
    warn_of(py, &file.notes)?;
    guarded(py, || file.drag_factor_of_titre(titre))
}

/// Copies a results folder, as the program replaces one.
#[pyfunction]
pub(crate) fn copy_results(py: Python<'_>, source: PathBuf, target: PathBuf, force: bool) -> PyResult<()> {
    guarded(py, || copy(&source, &target, force, &AtomicBool::new(false)))
}

/// Basis weight of every cell [kg/m2]: rows in machine direction x columns in cross direction.
fn weights<'py>(py: Python<'py>, map: &Map) -> PyResult<Bound<'py, PyAny>> {
    let weight = map.weight_of_quantum();
    let values = py.detach(|| map.cells.iter().map(|cell| f64::from(*cell) * weight).collect());
    locked(PyArray1::from_vec(py, values).reshape([map.rows, map.columns])?.as_any())
}

/// Compares folders. See spunlaid.compare, which calls it.
#[pyfunction]
pub(crate) fn compare_folders(py: Python<'_>, folders: Vec<PathBuf>) -> PyResult<Computed> {
    guarded(py, || {
        let folders = Folders::new(&folders)?;
        Ok(Computed { name: folders.joined(), of: Of::Comparison(Box::new(folders.compare()?)) })
    })
}
