//! `Flight`: fibres in flight that Python steps.

use crate::case::Case;
use crate::failure::raised_as;
use crate::value::{seconds, value_of};
use crate::watched::{Watch, guarded, watched};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use spunlaid::flight::{self, Job, LaidPoint, Snapshot};
use spunlaid::lanes::{Isa, WIDTH};
use spunlaid::threads::lock;
use spunlaid::vec3::Vec3;
use spunlaid_results::Failure;
use std::sync::atomic::Ordering;
use std::sync::{Mutex, MutexGuard};

/// Most fibres that are stepped together.
const MOST: u64 = 4096;
/// Steps between two looks whether Python wants to stop.
const STEPS: f64 = 4096.0;
/// Most steps of a flight.
const MOST_STEPS: f64 = 9e15;

/// Fibres in flight, which you step: Flight(case, replicates=8).
///
/// step("10 ms") advances them, set(key, value) changes the case while they fly, positions is an array of fibres x
/// nodes x 3. The fibres are the first replicates of the case, to the same bits as in a run. Several threads of Python
/// may use one flight.
#[pyclass(frozen, module = "spunlaid", name = "Flight")]
#[derive(Debug)]
pub(crate) struct Flight {
    /// Up to eight fibres each.
    packs: Mutex<Vec<flight::Flight>>,
    fibres: u64,
}

/// A number of a vector, and a vector of eight lanes.
type VectorField = fn(&Snapshot) -> &[Vec3<spunlaid::lanes::Lanes>];

#[pymethods]
impl Flight {
    #[new]
    #[pyo3(signature = (case, replicates = None))]
    fn new(py: Python<'_>, case: &Bound<'_, PyAny>, replicates: Option<u64>) -> PyResult<Self> {
        let case = Case::meant(case)?;
        let description = &*case.get().case;
        let fibres = replicates.unwrap_or_else(|| description.run.replicates.min(WIDTH as u64));
        if !(1..=MOST).contains(&fibres) {
            return Err(PyValueError::new_err(format!("replicates must be 1 to {MOST}, not {fibres}")));
        }
        let packs = guarded(py, || {
            let starts = (0..fibres).step_by(WIDTH);
            let pack = |first: u64| {
                let last = fibres.min(first + WIDTH as u64);
                let jobs: Vec<Job<'_>> =
                    (first..last).map(|replicate| Job::new(description, replicate)).collect();
                flight::Flight::new(&jobs, Isa::detect())
            };
            starts.map(pack).collect::<Result<Vec<_>, Failure>>()
        })?;
        Ok(Self { packs: Mutex::new(packs), fibres })
    }

    /// Advances all fibres by a time, to the nearest whole step: step("10 ms"), or step(0.01) in seconds.
    fn step(&self, py: Python<'_>, duration: &Bound<'_, PyAny>) -> PyResult<()> {
        let duration = seconds(duration)?;
        let now = self.time(py)?;
        self.fly_to(py, now + duration)
    }

    /// Advances all fibres to a time, "10 ms" or in seconds, to the nearest whole step. Ctrl-C stops them at a step in between.
    fn step_to(&self, py: Python<'_>, time: &Bound<'_, PyAny>) -> PyResult<()> {
        self.fly_to(py, seconds(time)?)
    }

    /// Changes a key while the fibres fly: set("air.velocity", 12.0) in SI units, or "12 m/s". keys() says which keys
    /// may change. If it cannot, the flight stays as it is.
    fn set(&self, py: Python<'_>, key: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let value = value_of(value)?;
        guarded(py, || {
            let mut packs = self.lock();
            // All packs have the same case, so all take the change or the first refuses it.
            packs.iter_mut().try_for_each(|pack| pack.set(key, value.clone()))
        })
    }

    /// Time of the positions [s].
    #[getter]
    fn time(&self, py: Python<'_>) -> PyResult<f64> {
        guarded(py, || Ok(self.lock().first().map_or(0.0, flight::Flight::time)))
    }

    /// The time step [s].
    #[getter]
    fn time_step(&self, py: Python<'_>) -> PyResult<f64> {
        guarded(py, || Ok(self.lock().first().map_or(0.0, flight::Flight::time_step)))
    }

    /// Number of fibres.
    #[getter]
    const fn fibres(&self) -> u64 {
        self.fibres
    }

    /// Positions of the nodes now [m]: fibres x nodes x 3, from the root to the end. NaN where a fed fibre has fewer
    /// nodes.
    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.vectors(py, |snapshot| &snapshot.position)
    }

    /// Velocities of the nodes now [m/s], in the same order.
    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.vectors(py, |snapshot| &snapshot.velocity)
    }

    /// Tensions of the elements now [N], negative in compression: fibres x elements.
    #[getter]
    fn tensions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let snapshots = self.snapshots(py)?;
        let width = snapshots.iter().flat_map(Self::lanes).map(|(_, nodes)| nodes).max().unwrap_or(1) - 1;
        let mut flat = Vec::new();
        for snapshot in &snapshots {
            for (lane, nodes) in Self::lanes(snapshot) {
                let elements = nodes.saturating_sub(1);
                flat.extend(snapshot.tension.iter().take(elements).map(|tension| tension.0[lane]));
                flat.extend(std::iter::repeat_n(f64::NAN, width - elements));
            }
        }
        flat.truncate(self.fibres as usize * width);
        Ok(PyArray1::from_vec(py, flat).reshape([self.fibres as usize, width])?.into_any())
    }

    /// Energies and works now [J]: an array with a number for each fibre, by name.
    #[getter]
    fn energies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let snapshots = self.snapshots(py)?;
        let all = PyDict::new(py);
        type Number = fn(&spunlaid::energy::Energy) -> spunlaid::lanes::Lanes;
        let numbers: [(&str, Number); 6] = [
            ("kinetic_j", |energy| energy.kinetic),
            ("axial_j", |energy| energy.axial),
            ("bending_j", |energy| energy.bending),
            ("gravity_work_j", |energy| energy.gravity_work),
            ("air_work_j", |energy| energy.drag_work),
            ("imbalance_j", |energy| energy.imbalance()),
        ];
        for (name, quantity) in numbers {
            let mut values: Vec<f64> =
                snapshots.iter().flat_map(|snapshot| quantity(&snapshot.energy).0).collect();
            values.truncate(self.fibres as usize);
            all.set_item(name, PyArray1::from_vec(py, values))?;
        }
        Ok(all)
    }

    /// What each fed fibre has laid on the belt since the last call: a dict of arrays for each fibre.
    fn take_laid<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let laid = guarded(py, || {
            let mut packs = self.lock();
            let curves = |pack: &mut flight::Flight| -> Vec<Vec<LaidPoint>> {
                (0..pack.fibres()).map(|lane| pack.take_laid(lane)).collect()
            };
            Ok(packs.iter_mut().flat_map(curves).collect::<Vec<_>>())
        })?;
        let all = PyList::empty(py);
        for points in laid {
            all.append(laid_columns(py, &points)?)?;
        }
        Ok(all)
    }

    fn __reduce__(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let text = "a flight cannot be pickled; send its case, and step it again".to_owned();
        Err(raised_as(py, "FlightError", text))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let time = self.time(py)?;
        Ok(format!("<Flight: {} fibres at {time:.6} s>", self.fibres))
    }
}

impl Flight {
    fn lock(&self) -> MutexGuard<'_, Vec<flight::Flight>> {
        lock(&self.packs)
    }

    fn fly_to(&self, py: Python<'_>, time: f64) -> PyResult<()> {
        let watch = Watch::default();
        let stop = &watch.stop;
        watched(py, &watch, None, || {
            let mut packs = self.lock();
            let Some(first) = packs.first() else { return Ok(()) };
            let (mut now, slice) = (first.time(), STEPS * first.time_step());
            // Slices for a time that can be reached; any other goes to the library, which says what is wrong with it.
            let is_far = time / first.time_step() < MOST_STEPS && time > now + slice;
            loop {
                let next = if is_far && time > now + slice { now + slice } else { time };
                packs.iter_mut().try_for_each(|pack| pack.step_to(next))?;
                now = next;
                if next == time || stop.load(Ordering::Relaxed) {
                    return Ok(());
                }
            }
        })
    }

    fn snapshots(&self, py: Python<'_>) -> PyResult<Vec<Snapshot>> {
        guarded(py, || Ok(self.lock().iter().map(flight::Flight::snapshot).collect()))
    }

    /// The lanes of a snapshot with the number of nodes of their fibres.
    fn lanes(snapshot: &Snapshot) -> impl Iterator<Item = (usize, usize)> {
        snapshot.nodes.into_iter().enumerate()
    }

    fn vectors<'py>(&self, py: Python<'py>, field: VectorField) -> PyResult<Bound<'py, PyAny>> {
        let snapshots = self.snapshots(py)?;
        let width = snapshots.iter().flat_map(Self::lanes).map(|(_, nodes)| nodes).max().unwrap_or(0);
        let mut flat = Vec::new();
        for snapshot in &snapshots {
            for (lane, nodes) in Self::lanes(snapshot) {
                let vectors = field(snapshot).iter().take(nodes).map(|vector| vector.lane(lane));
                flat.extend(vectors.flat_map(|vector| [vector.x, vector.y, vector.z]));
                flat.extend(std::iter::repeat_n(f64::NAN, 3 * (width - nodes)));
            }
        }
        // The lanes that no fibre uses come last.
        flat.truncate(self.fibres as usize * width * 3);
        Ok(PyArray1::from_vec(py, flat).reshape([self.fibres as usize, width, 3])?.into_any())
    }
}

/// What a fibre laid: fed length, time, place along and across the belt.
pub(crate) fn laid_columns<'py>(py: Python<'py>, points: &[LaidPoint]) -> PyResult<Bound<'py, PyDict>> {
    type Number = fn(&LaidPoint) -> f64;
    let columns: [(&str, Number); 4] =
        [("s_m", |p| p.fed), ("time_s", |p| p.time), ("md_m", |p| p.md), ("cd_m", |p| p.cd)];
    let dict = PyDict::new(py);
    for (name, column) in columns {
        let values = PyArray1::from_vec(py, points.iter().map(column).collect());
        dict.set_item(name, crate::samples::locked(values.as_any())?)?;
    }
    Ok(dict)
}
