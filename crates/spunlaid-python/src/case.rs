//! `Case`: a case file with changes, read and checked.

use crate::source::{Source, full_path, stem};
use crate::value::{overrides, quoted, to_python};
use crate::warning::{CALLED, warn_at, warn_of_at};
use crate::watched::{guarded, settled};
use numpy::PyArray1;
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyBytes, PyDict, PyIterator, PyList, PyMapping, PyTuple, PyType};
use spunlaid::air::PlaceAxes;
use spunlaid::fibre;
use spunlaid::fibre::case::keys::{self, Key, Value};
use spunlaid::ground::{Diagnostic, FileKind, Vec3};
use spunlaid::input::{
    Overrides, Resources, read_case, starter_case, starter_case_of_fed, write_case, write_changed_case,
};
use spunlaid_results::reports::air::{POINT_COLUMNS, outside, point_row};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What messages write before the key of a change, and in place of the name of a file.
const WORD: &str = "Case:";
const NAME: &str = "Case";

/// A fibre, the air around it and how its flight is computed: a case file, read and checked, that can be run.
///
/// Make one with Case.read(path), Case.from_dict({...}), Case.from_text(text) or Case.starter(). It does not change;
/// with_() returns another one. case["air.velocity"] is the value of a key in SI units, and a case is a
/// Mapping of its keys: dict(case) has them all, and Case.from_dict(dict(case)) is the same case.
#[pyclass(frozen, mapping, module = "spunlaid", name = "Case")]
#[derive(Debug)]
pub(crate) struct Case {
    pub(crate) case: Arc<fibre::Case>,
    pub(crate) notes: Vec<Diagnostic>,
    /// The text of the case file, what messages call it, and what is changed in it.
    text: Arc<str>,
    file: String,
    changes: Vec<(String, String)>,
}

impl Case {
    /// What can be given instead of a case: the path of its file, or a dict.
    pub(crate) fn meant<'py>(case: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Self>> {
        let made = case.py().import("spunlaid._case")?.getattr("case_of")?.call1((case,))?;
        Ok(made.cast_into()?)
    }

    /// Makes cases Mappings of Python.
    pub(crate) fn register(py: Python<'_>) -> PyResult<()> {
        PyMapping::register::<Self>(py)
    }

    fn parsed(
        py: Python<'_>,
        text: Arc<str>,
        file: String,
        changes: Vec<(String, String)>,
    ) -> PyResult<Self> {
        let (case, notes) = guarded(py, || read_case((&text, &file), Overrides::new(&changes, WORD)))?;
        Ok(Self { case: Arc::new(case), notes, text, file, changes })
    }

    /// The case and its notes for a flight: with the tension that flights have found, if it asks for one.
    pub(crate) fn settled(
        &self,
        py: Python<'_>,
        threads: Option<usize>,
    ) -> PyResult<(Arc<fibre::Case>, Vec<Diagnostic>)> {
        if !self.case.waits_for_flights() {
            return Ok((Arc::clone(&self.case), self.notes.clone()));
        }
        let set = Overrides::new(&self.changes, WORD);
        let read = |resources: &Resources| read_case((&self.text, &self.file), set.with(resources));
        let (case, notes) = settled(py, threads, read)?;
        Ok((Arc::new(case), notes))
    }

    /// What results of it are called.
    pub(crate) fn stem(&self) -> String {
        stem(Path::new(&self.file))
    }

    /// The keys that have a meaning for it and that no file of it gives, in the order of a case file.
    fn own_keys(&self) -> impl Iterator<Item = (&'static Key, Value)> {
        let all = keys::all().iter().filter(|key| !key.is_derived(&self.case));
        all.filter_map(|key| Some((key, key.get(&self.case)?)))
    }

    /// A view of `collections.abc`: `KeysView`, `ValuesView` or `ItemsView`.
    fn view<'py>(this: &Bound<'py, Self>, kind: &str) -> PyResult<Bound<'py, PyAny>> {
        this.py().import("collections.abc")?.getattr(kind)?.call1((this,))
    }

    /// Text and name of a case file with all changes, for a study of this case, and whether there are some.
    pub(crate) fn source(&self) -> (String, &str, bool) {
        let is_changed = !self.changes.is_empty();
        let changed = || write_changed_case(&self.text, &self.file, Overrides::new(&self.changes, WORD));
        // It has been read before.
        let text = if is_changed { changed().ok() } else { None };
        let text = text.unwrap_or_else(|| self.text.to_string());
        (text, &self.file, is_changed)
    }
}

#[pymethods]
impl Case {
    /// Reads and checks a case file.
    ///
    /// Raises FileError if the file cannot be read, and CaseError with every problem if the case cannot be run.
    #[classmethod]
    fn read(_class: &Bound<'_, PyType>, py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let Source { text, file, .. } = Source::read(py, Some(path), FileKind::Case, NAME)?;
        Self::parsed(py, text.into(), file, Vec::new())
    }

    /// A case from the text of a case file (TOML). Files that it names are looked for next to `name`.
    #[classmethod]
    #[pyo3(signature = (text, name = "Case"))]
    fn from_text(_class: &Bound<'_, PyType>, py: Python<'_>, text: &str, name: &str) -> PyResult<Self> {
        Self::parsed(py, text.into(), name.to_owned(), Vec::new())
    }

    /// A case from a dict of its tables, {"fibre": {"diameter": 50e-6, ...}, ...}, or of full keys,
    /// {"fibre.diameter": "50 um", ...}. Texts have a unit, numbers are in SI units.
    #[classmethod]
    fn from_dict(_class: &Bound<'_, PyType>, py: Python<'_>, values: &Bound<'_, PyAny>) -> PyResult<Self> {
        Self::parsed(py, "".into(), NAME.to_owned(), overrides(values)?)
    }

    /// The case to start from: Table 1 of the paper, ten fibres of 1 m and 50 um in air of 10 m/s. With fed=True a
    /// fibre that is fed and laid on a moving belt.
    #[classmethod]
    #[pyo3(signature = (fed = false))]
    fn starter(_class: &Bound<'_, PyType>, py: Python<'_>, fed: bool) -> PyResult<Self> {
        let text = if fed { starter_case_of_fed() } else { starter_case() };
        Self::parsed(py, text.into(), "starter.toml".to_owned(), Vec::new())
    }

    /// The same case with other values: with_({"air.velocity": "20 m/s", "fibre.diameter": 18e-6}).
    ///
    /// A text has a unit, a number is in SI units, and None takes a key out, so that its default applies. "+20 %" and
    /// "-0.2 dtex" are changes of the value of this case. What follows from the changed keys follows again.
    fn with_(&self, py: Python<'_>, values: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (mut changes, new) = (self.changes.clone(), overrides(values)?);
        let is_set = |value: &str| value.trim().trim_matches('"') != "auto";
        let set = new.iter().filter(|(_, value)| is_set(value)).map(|(key, _)| key.trim());
        let replaced = keys::CASE.replaced_by(&set.collect::<Vec<_>>());
        // "+20 %" is a change of the value before, which therefore stays.
        let is_change = |value: &str| value.trim().starts_with(['+', '-', '−']);
        let is_replaced = |other: &str| new.iter().any(|(key, value)| key == other && !is_change(value));
        changes.retain(|(other, _)| !is_replaced(other) && !replaced.contains(&&**other));
        changes.extend(new);
        Self::parsed(py, Arc::clone(&self.text), self.file.clone(), changes)
    }

    /// The value of a key in SI units; None if it has no meaning for this case.
    fn __getitem__(&self, py: Python<'_>, key: &str) -> PyResult<Py<PyAny>> {
        let found = keys::named(key).map_err(|problem| PyKeyError::new_err(problem.to_string()))?;
        to_python(py, found.get(&self.case))
    }

    /// The values of all keys by table, in SI units, without those that have no meaning for this case or that a file of
    /// the case gives. Case.from_dict() takes it.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for (key, value) in self.own_keys() {
            let mut dict = all.clone();
            // A table may stand within a table, as spinline.material.
            for name in key.table().split('.') {
                let inner = dict.call_method1("setdefault", (name, PyDict::new(py)))?;
                dict = inner.cast_into()?;
            }
            dict.set_item(key.short(), to_python(py, Some(value))?)?;
        }
        Ok(all)
    }

    fn __len__(&self) -> usize {
        self.own_keys().count()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        PyList::new(py, self.own_keys().map(|(key, _)| key.name))?.try_iter()
    }

    fn __contains__(&self, key: &Bound<'_, PyAny>) -> bool {
        key.extract::<String>().is_ok_and(|name| self.own_keys().any(|(key, _)| key.name == name))
    }

    /// The value of a key in SI units, or `default` if there is no such key or it has no meaning for this case.
    #[pyo3(signature = (key, default = None))]
    fn get(&self, py: Python<'_>, key: &Bound<'_, PyAny>, default: Option<Py<PyAny>>) -> PyResult<Py<PyAny>> {
        let name: Option<String> = key.extract().ok();
        let value = name.and_then(|name| keys::find(&name)?.get(&self.case));
        match (value, default) {
            (None, Some(default)) => Ok(default),
            (value, _) => to_python(py, value),
        }
    }

    /// The keys of this case: those that have a meaning for it and that no file of it gives, as `to_dict` has them.
    fn keys<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        Self::view(this, "KeysView")
    }

    /// The values of these keys, in SI units.
    fn values<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        Self::view(this, "ValuesView")
    }

    /// These keys with their values, in SI units.
    fn items<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        Self::view(this, "ItemsView")
    }

    /// The case as a case file with every key, in SI units: reading it gives the same case to the last bit.
    fn to_toml(&self) -> String {
        write_case(&self.case)
    }

    /// The air at places, in SI units: an array of a number for each place by the names of the columns of
    /// `spunlaid air --at`. NaN where the air is not known.
    ///
    /// * `points` – n x 3 coordinates [m]
    /// * `axes` – "line" or "field": of points and velocities; "field" if the air is a CFD field and nothing is said
    #[pyo3(signature = (points, axes = None))]
    fn air_at<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        axes: Option<&str>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let wrong = |_| {
            PyValueError::new_err("points must have three coordinates in metres each, as an array of n x 3")
        };
        // Also what NumPy makes an array of, as tables of pandas.
        let array = py.import("numpy")?.call_method1("asarray", (points, "float64")).map_err(wrong)?;
        let places: Vec<[f64; 3]> = array.extract().map_err(wrong)?;
        let places: Vec<Vec3<f64>> = places.into_iter().map(|[x, y, z]| Vec3::new(x, y, z)).collect();
        let axes = match axes {
            None => self.case.air.usual_axes(),
            Some(name) => PlaceAxes::ALL.into_iter().find(|axes| axes.name() == name).ok_or_else(|| {
                PyValueError::new_err(format!("axes must be \"line\" or \"field\", not \"{name}\""))
            })?,
        };
        let found = guarded(py, || self.case.air.at_points(&places, axes))?;
        warn_of_at(py, CALLED, &self.notes)?;
        outside(&places, &found).into_iter().try_for_each(|text| warn_at(py, CALLED, "", &text))?;
        let rows: Vec<_> = places.iter().zip(&found).map(|(at, air)| point_row(*at, *air)).collect();
        let column = |i: usize| PyArray1::from_iter(py, rows.iter().map(|row| row[i]));
        POINT_COLUMNS.into_iter().zip((0..).map(column)).into_py_dict(py)
    }

    /// Notes and warnings about the case.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.iter().map(Diagnostic::to_string).collect()
    }

    /// The name of the case file.
    #[getter]
    fn name(&self) -> &str {
        &self.file
    }

    /// The times of a run that its results are recorded at: their number.
    #[getter]
    fn instants(&self) -> u64 {
        let run = &self.case.run;
        run.steps.div_ceil(run.output_steps.max(1)) + 1
    }

    /// The limits on the time step [s] and what sets them.
    #[getter]
    fn step_limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.case.step_limits().into_iter().map(|limit| (limit.cause, limit.limit)).into_py_dict(py)
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().case == self.case)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        // Files that the case names are found from another folder too.
        let file = full_path(self.file.as_ref());
        let make = py.get_type::<Self>().getattr("_unpickled")?;
        let file = if self.file == NAME { self.file.clone() } else { file.display().to_string() };
        let values: Vec<&str> = self.changes.iter().map(|(_, value)| &**value).collect();
        let laws = py.import("spunlaid._law")?.getattr("texts_of")?.call1((values,))?;
        (make, (&*self.text, file, self.changes.clone(), laws)).into_pyobject(py)
    }

    #[classmethod]
    fn _unpickled(
        _class: &Bound<'_, PyType>,
        py: Python<'_>,
        text: &str,
        file: String,
        mut changes: Vec<(String, String)>,
        laws: HashMap<String, String>,
    ) -> PyResult<Self> {
        // A drag law that was given as a table lay in a file of the process that pickled it.
        for (_, value) in &mut changes {
            if let Some(law) = laws.get(value) {
                let path = py.import("spunlaid._law")?.getattr("kept")?.call1((law,))?;
                *value = quoted(&path.extract::<String>()?);
            }
        }
        Self::parsed(py, text.into(), file, changes)
    }

    /// Bytes that are the same for cases whose results are bit-identical.
    fn _identity<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, format!("{:?}", self.case).as_bytes())
    }

    fn __repr__(&self) -> String {
        let case = &self.case;
        let shown = |key: &str| -> String {
            let value = keys::find(key).and_then(|key| Some((key.dimension()?, key.get(case)?.number()?)));
            value.map_or_else(String::new, |(dimension, value)| dimension.pretty(value))
        };
        format!(
            "<Case {}: fibre of {} and {}, air of {}, {} replicates of {}>",
            self.file,
            shown("fibre.length"),
            shown("fibre.diameter"),
            shown("air.velocity"),
            case.run.replicates,
            shown("run.duration")
        )
    }
}
