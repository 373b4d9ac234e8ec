//! What is recorded of every fibre over time, as columns that go to NumPy as they are.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use spunlaid::simulation::ensemble::Sample;
use spunlaid_results::output::tables::{Column, FIELDS, tables};

/// Collects samples, replicate after replicate.
#[derive(Debug, Default)]
pub(crate) struct SampleCollector {
    times: Vec<f64>,
    columns: [Vec<f64>; FIELDS.len()],
    /// Number of fibres so far, and those of them that were lost.
    fibres: usize,
    lost: Vec<usize>,
}

impl SampleCollector {
    pub(crate) fn take(&mut self, samples: &[Sample]) {
        self.fibres += 1;
        if self.times.is_empty() {
            self.times = samples.iter().map(|sample| sample.time).collect();
        }
        for sample in samples {
            let mut sample = *sample;
            for (column, (_, field)) in self.columns.iter_mut().zip(FIELDS) {
                column.push(*field(&mut sample));
            }
        }
    }

    /// Takes the place of a fibre that was lost: its numbers are NaN.
    pub(crate) fn lose(&mut self) {
        self.lost.push(self.fibres);
        self.fibres += 1;
    }

    /// Hands the columns over to NumPy.
    pub(crate) fn into_numpy(self, py: Python<'_>) -> PyResult<Samples> {
        let instants = self.times.len();
        let mut columns = Vec::with_capacity(FIELDS.len());
        for mut column in self.columns {
            for fibre in &self.lost {
                // How many instants there are is known from those that were not lost.
                let at = fibre * instants;
                column.splice(at..at, std::iter::repeat_n(f64::NAN, instants));
            }
            let replicates = column.len().checked_div(instants).unwrap_or(0);
            let array = PyArray1::from_vec(py, column).reshape([replicates, instants])?;
            columns.push(locked(array.as_any())?.cast_into::<PyArray2<f64>>()?.unbind());
        }
        let times = locked(PyArray1::from_vec(py, self.times).as_any())?.cast_into::<PyArray1<f64>>()?;
        Ok(Samples { times: times.unbind(), columns })
    }
}

/// The array, of which nothing can be changed any more: it is seen by all who hold the results.
pub(crate) fn locked<'py>(array: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    array.call_method1("setflags", (false,))?;
    Ok(array.clone())
}

/// The samples of all replicates: an array of replicates × times for each field.
#[derive(Debug)]
pub(crate) struct Samples {
    pub(crate) times: Py<PyArray1<f64>>,
    pub(crate) columns: Vec<Py<PyArray2<f64>>>,
}

impl Samples {
    /// The columns of the two tables of a run: of the free end, and of the energies.
    pub(crate) fn table(
        &self,
        py: Python<'_>,
        table: &str,
        fed: bool,
    ) -> PyResult<Vec<(&'static str, Py<PyAny>)>> {
        let columns = tables(fed).into_iter().find(|(name, _)| *name == table).map(|(_, columns)| columns);
        columns
            .unwrap_or_default()
            .into_iter()
            .map(|column| Ok((column.0, self.column(py, column)?)))
            .collect()
    }

    fn column(&self, py: Python<'_>, (name, value): Column) -> PyResult<Py<PyAny>> {
        if name == "time_s" {
            return Ok(self.times.clone_ref(py).into_any());
        }
        if let Some(index) = FIELDS.iter().position(|(field, _)| *field == name) {
            return Ok(self.columns[index].clone_ref(py).into_any());
        }
        // A number that follows from others.
        let all = self.borrowed(py);
        let [replicates, instants] = all.shape();
        let values =
            (0..replicates).flat_map(|replicate| all.samples(replicate)).map(|sample| value(&sample));
        let array = PyArray1::from_vec(py, values.collect()).reshape([replicates, instants])?;
        Ok(locked(array.as_any())?.unbind())
    }

    /// The columns for reading.
    pub(crate) fn borrowed<'py>(&self, py: Python<'py>) -> SampleReader<'py> {
        let columns = self.columns.iter().map(|column| column.bind(py).readonly()).collect();
        SampleReader { times: self.times.bind(py).readonly().as_array().to_vec(), columns }
    }
}

/// Samples that are being read.
pub(crate) struct SampleReader<'py> {
    times: Vec<f64>,
    columns: Vec<PyReadonlyArray2<'py, f64>>,
}

impl SampleReader<'_> {
    fn shape(&self) -> [usize; 2] {
        let replicates = self.columns.first().map_or(0, |column| column.as_array().nrows());
        [replicates, self.times.len()]
    }

    /// The samples of a replicate.
    pub(crate) fn samples(&self, replicate: usize) -> Vec<Sample> {
        let mut samples: Vec<Sample> =
            self.times.iter().map(|time| Sample { time: *time, ..Sample::default() }).collect();
        for (column, (_, field)) in self.columns.iter().zip(FIELDS) {
            for (sample, value) in samples.iter_mut().zip(column.as_array().row(replicate)) {
                *field(sample) = *value;
            }
        }
        samples
    }

    /// The samples of all replicates, in order.
    pub(crate) fn all(&self) -> Vec<Vec<Sample>> {
        (0..self.shape()[0]).map(|replicate| self.samples(replicate)).collect()
    }
}
