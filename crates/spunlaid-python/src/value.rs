//! Values of Python as those of keys, and back.

use crate::failure::raised;
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyMapping, PyString};
use spunlaid::fibre::case::keys::{self, DataFile, Kind, Value};
use spunlaid::ground::{Dimension, Error, Fault, Vec3};
use spunlaid::simulation::layers::web_key;
use spunlaid_results::reports::study::Scale;
use std::path::PathBuf;

/// Keys and values as overrides of the file of a case or of a web, in their order: `{"air.velocity": "20 m/s"}`, or
/// `{"air": {"velocity": 20.0}}`; of a layer of a web with its number, `layer.2.line.belt_speed`. Numbers are
/// in SI units; `None` takes a key out. A drag law may be a table of Reynolds numbers and coefficients.
pub(crate) fn overrides(values: &Bound<'_, PyAny>) -> PyResult<Vec<(String, String)>> {
    let values = values.cast::<PyMapping>().map_err(|_| {
        let found = type_name(values);
        PyTypeError::new_err(format!(
            "keys and values must be a dict like {{\"air.velocity\": \"20 m/s\"}}, not {found}"
        ))
    })?;
    let mut all = Vec::new();
    for item in values.items()?.iter() {
        let (name, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item.extract()?;
        let name = name_of(&name)?;
        // A table may stand within a table, as spinline.material.
        let depth = if name.contains('.') { 0 } else { 2 };
        put(&mut all, name, &value, depth)?;
    }
    Ok(all)
}

/// Adds a key with its value, or all keys of a table and of so many tables within one another.
fn put(
    all: &mut Vec<(String, String)>,
    name: String,
    value: &Bound<'_, PyAny>,
    depth: usize,
) -> PyResult<()> {
    let in_layer = name.strip_prefix("layer.").and_then(|rest| rest.split_once('.'));
    let of_case = keys::find(in_layer.map_or(&*name, |(_, key)| key));
    let kind = of_case.map(|key| key.kind).or_else(|| Some(web_key(&name)?.kind));
    let is_law = matches!(kind, Some(Kind::File(DataFile::FrictionLaw | DataFile::NormalLaw)));
    if let (Ok(table), 1.., false) = (value.cast::<PyDict>(), depth, is_law) {
        for (key, value) in table.iter() {
            put(all, format!("{name}.{}", name_of(&key)?), &value, depth - 1)?;
        }
        return Ok(());
    }
    let is_table = is_law && !value.is_none() && !value.is_instance_of::<PyString>() && !is_path(value)?;
    let text = if is_table { law_file(&name, value)? } else { text_of(&name, kind, value)? };
    all.push((name, text));
    Ok(())
}

/// The path of a file with a drag law that is given as a table.
fn law_file(name: &str, table: &Bound<'_, PyAny>) -> PyResult<String> {
    let path = table.py().import("spunlaid._law")?.getattr("law_file")?.call1((name, table))?;
    Ok(quoted(&path.extract::<String>()?))
}

fn name_of(name: &Bound<'_, PyAny>) -> PyResult<String> {
    let text = name.cast::<PyString>().map_err(|_| {
        PyTypeError::new_err(format!(
            "the name of a key must be a str like \"air.velocity\", not {}",
            type_name(name)
        ))
    })?;
    unicode(text, || "the name of a key is".to_owned())
}

/// The text of a `str`, of which a message says what is not valid: a lone surrogate has no UTF-8.
fn unicode(text: &Bound<'_, PyString>, what: impl Fn() -> String) -> PyResult<String> {
    let text = text.to_str().map(str::to_owned);
    text.map_err(|_| PyValueError::new_err(format!("{} not valid Unicode", what())))
}

/// A value as it stands after `key =` in a case file.
fn text_of(key: &str, kind: Option<Kind>, value: &Bound<'_, PyAny>) -> PyResult<String> {
    if value.is_none() {
        return Ok("auto".to_owned());
    }
    if let Some(flag) = flag(value)? {
        return Ok(flag.to_string());
    }
    if let Ok(text) = value.cast::<PyString>() {
        return unicode(text, || format!("the value of {key} is"));
    }
    let dimension = if let Some(Kind::Quantity(dimension, _)) = &kind { Some(*dimension) } else { None };
    if let Some(text) = number_or_path(dimension, value)? {
        return Ok(text);
    }
    if let Ok(parts) = value.try_iter()
        && !value.is_instance_of::<PyDict>()
    {
        let dimension = match kind {
            Some(Kind::Lengths | Kind::Point) => Dimension::Length,
            _ => Dimension::Ratio,
        };
        let mut texts = Vec::new();
        for part in parts.take(MOST_PARTS) {
            texts.push(part_text(key, dimension, &part?)?);
        }
        return Ok(format!("[{}]", texts.join(", ")));
    }
    Err(PyTypeError::new_err(format!(
        "{key} takes a text with a unit, a number in SI units or a list of these, not {}",
        type_name(value)
    )))
}

/// No key takes a longer list.
const MOST_PARTS: usize = 100_000;

fn part_text(key: &str, dimension: Dimension, part: &Bound<'_, PyAny>) -> PyResult<String> {
    if let Ok(text) = part.cast::<PyString>() {
        return Ok(quoted(&unicode(text, || format!("{key}:"))?));
    }
    number_or_path(Some(dimension), part)?.ok_or_else(|| {
        PyTypeError::new_err(format!("the list of {key} takes texts and numbers, not {}", type_name(part)))
    })
}

/// A number, of a dimension if it has one, or the path of a file.
fn number_or_path(dimension: Option<Dimension>, value: &Bound<'_, PyAny>) -> PyResult<Option<String>> {
    if let Some(number) = number(value)? {
        return Ok(Some(dimension.map_or_else(|| number.text(), |dimension| quantity(dimension, &number))));
    }
    let path = if is_path(value)? { Some(value.extract::<PathBuf>()?) } else { None };
    Ok(path.map(|path| quoted(&path.to_string_lossy())))
}

fn is_path(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    value.hasattr("__fspath__")
}

/// The value as a boolean, if it is one: of Python or NumPy.
fn flag(value: &Bound<'_, PyAny>) -> PyResult<Option<bool>> {
    let is_of_numpy = || {
        let kind = value.getattr("dtype").and_then(|dtype| dtype.getattr("kind"));
        kind.is_ok_and(|kind| kind.extract::<String>().is_ok_and(|kind| kind == "b")) && is_single(value)
    };
    let is_flag = value.is_instance_of::<PyBool>() || is_of_numpy();
    if is_flag { value.is_truthy().map(Some) } else { Ok(None) }
}

/// Whether this is a number of NumPy. Arrays with one element are meant too, but not longer ones.
fn is_single(value: &Bound<'_, PyAny>) -> bool {
    value.getattr("ndim").is_ok_and(|n| n.extract::<usize>().is_ok_and(|n| n == 0))
}

/// A number of Python.
pub(crate) enum Number {
    Whole(String),
    Float(f64),
}

impl Number {
    fn text(&self) -> String {
        match self {
            Self::Whole(digits) => digits.clone(),
            Self::Float(value) if value.fract() == 0.0 && value.abs() < 9e15 => format!("{value:.0}"),
            Self::Float(value) => toml_float(*value),
        }
    }

    pub(crate) fn float(&self) -> f64 {
        match self {
            // Too many digits make infinity, which the key rejects.
            Self::Whole(digits) => digits.parse().unwrap_or(f64::NAN),
            Self::Float(value) => *value,
        }
    }
}

/// The value as a number, if it is one: of Python or NumPy.
pub(crate) fn number(value: &Bound<'_, PyAny>) -> PyResult<Option<Number>> {
    if value.is_instance_of::<PyFloat>() {
        return Ok(Some(Number::Float(value.extract()?)));
    }
    if value.is_instance_of::<PyInt>() {
        // Python refuses to write out integers of thousands of digits; those are too large for any key.
        let digits = value.str().and_then(|text| text.to_str().map(str::to_owned));
        return Ok(Some(digits.map_or(Number::Float(f64::INFINITY), Number::Whole)));
    }
    let is_number = value.hasattr("dtype")? && is_single(value);
    Ok(if is_number { value.extract::<f64>().ok().map(Number::Float) } else { None })
}

fn quantity(dimension: Dimension, number: &Number) -> String {
    let value = number.float();
    if dimension == Dimension::Ratio { toml_float(value) } else { quoted(&dimension.exact(value)) }
}

fn toml_float(value: f64) -> String {
    if value.is_nan() {
        return "nan".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 { "inf" } else { "-inf" }.to_owned();
    }
    format!("{value:?}")
}

/// A text as a TOML string.
pub(crate) fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string().replace('\u{7f}', "\\u007F")
}

pub(crate) fn type_name(value: &Bound<'_, PyAny>) -> String {
    value.get_type().name().map_or_else(|_| "that".to_owned(), |name| name.to_string())
}

/// A value for [`spunlaid::fibre::case::keys::Key::set`] and for changes in flight.
pub(crate) fn value_of(value: &Bound<'_, PyAny>) -> PyResult<Value> {
    if flag(value)?.is_some() {
        return Err(PyTypeError::new_err(
            "a key takes a text with a unit or a number in SI units, not a bool",
        ));
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(unicode(text, || "the value is".to_owned())?.as_str().into());
    }
    if let Some(number) = number(value)? {
        return Ok(Value::Number(number.float()));
    }
    let parts: Vec<f64> = value.extract().map_err(|_| {
        PyTypeError::new_err(format!(
            "a key takes a text with a unit, a number in SI units or a vector of numbers, not {}",
            type_name(value)
        ))
    })?;
    Ok(match parts[..] {
        [x, y, z] => Value::Vector(Vec3::new(x, y, z)),
        _ => Value::Numbers(parts),
    })
}

/// A time [s]: a text with its unit, or a number in seconds.
pub(crate) fn seconds(value: &Bound<'_, PyAny>) -> PyResult<f64> {
    if let Ok(text) = value.extract::<String>() {
        let read = Dimension::Time.parse(&text);
        return read.map_err(|fault| {
            let message = format!("{} {}", quoted(&text), fault.message);
            raised(value.py(), Error::Flight(Fault::new(message, fault.remedy)))
        });
    }
    number_of(value, || "a time is a text with its unit, \"10 ms\", or a number in seconds".to_owned())
}

/// The value of an option above zero: a text with its unit, or a number in SI units.
pub(crate) fn positive(name: &str, value: &Bound<'_, PyAny>, dimension: Dimension) -> PyResult<f64> {
    let found = match value.extract::<String>() {
        Ok(text) => dimension.parse(&text).map_err(|fault| {
            PyValueError::new_err(format!("{name} = {} {}; {}", quoted(&text), fault.message, fault.remedy))
        })?,
        Err(_) => number_of(value, || {
            format!("{name} is a text with its unit, or a number in {}", unit(dimension))
        })?,
    };
    if found.is_finite() && found > 0.0 {
        return Ok(found);
    }
    Err(PyValueError::new_err(format!("{name} must be a finite number above zero")))
}

fn unit(dimension: Dimension) -> &'static str {
    if dimension == Dimension::Ratio { "levels" } else { dimension.si_unit() }
}

fn number_of(value: &Bound<'_, PyAny>, wanted: impl Fn() -> String) -> PyResult<f64> {
    match number(value)?.filter(|_| !flag(value).is_ok_and(|flag| flag.is_some())) {
        Some(number) => Ok(number.float()),
        None => Err(PyTypeError::new_err(format!("{}, not {}", wanted(), type_name(value)))),
    }
}

/// The value of a key for Python, in SI units.
pub(crate) fn to_python(py: Python<'_>, value: Option<Value>) -> PyResult<Py<PyAny>> {
    Ok(match value {
        Some(Value::Number(value)) => value.into_py_any(py)?,
        Some(Value::Whole(value)) => value.into_py_any(py)?,
        Some(Value::Text(text)) => text.into_py_any(py)?,
        Some(Value::Numbers(values)) => values.into_py_any(py)?,
        Some(Value::Vector(v)) => (v.x, v.y, v.z).into_py_any(py)?,
        Some(Value::Content(content)) => {
            let paths: Vec<String> = content.paths().iter().map(|path| path.display().to_string()).collect();
            match &paths[..] {
                [one] => one.into_py_any(py)?,
                _ => paths.into_py_any(py)?,
            }
        }
        _ => py.None(),
    })
}

/// Label with unit, zero and factor from SI units, whether logarithmic. `_plot.Axis` of Python has the same.
pub(crate) type AxisScale = (String, f64, f64, bool);

/// A scale for Python.
pub(crate) fn scale(scale: Scale) -> AxisScale {
    (scale.label, scale.zero, scale.per_si, scale.logarithmic)
}
