//! `Flight`: fibres in flight that Python steps.

use crate::case::Case;
use crate::failure::raised_as;
use crate::table::column;
use crate::value::{seconds, value_of};
use crate::watched::{Watch, guarded, watched};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};
use spunlaid::fibre::{self, Job, LaidPoint, Snapshot};
use spunlaid::ground::threads::lock;
use spunlaid::ground::{Isa, Vec3, WIDTH};
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
/// step("10 ms") advances them, set(key, value) changes the case meanwhile, positions is an array of fibres x
/// nodes x 3. The fibres are the first replicates of the case, bit-identical to a run. Several threads of Python
/// may use one flight.
#[pyclass(frozen, module = "spunlaid", name = "Flight")]
#[derive(Debug)]
pub(crate) struct Flight {
    /// Up to eight fibres each.
    packs: Mutex<Vec<fibre::Flight>>,
    fibres: u64,
}

#[pymethods]
impl Flight {
    #[new]
    #[pyo3(signature = (case, replicates = None))]
    fn new(py: Python<'_>, case: &Bound<'_, PyAny>, replicates: Option<u64>) -> PyResult<Self> {
        let case = Case::meant(case)?;
        let (description, _) = case.get().settled(py, None)?;
        let fibres = replicates.unwrap_or_else(|| description.run.replicates.min(WIDTH as u64));
        if !(1..=MOST).contains(&fibres) {
            return Err(PyValueError::new_err(format!("replicates must be 1 to {MOST}, not {fibres}")));
        }
        let packs = guarded(py, || {
            let starts = (0..fibres).step_by(WIDTH);
            let pack = |first: u64| {
                let last = fibres.min(first + WIDTH as u64);
                let jobs: Vec<Job<'_>> =
                    (first..last).map(|replicate| Job::new(&description, replicate)).collect();
                fibre::Flight::new(&jobs, Isa::detect())
            };
            starts.map(pack).collect::<Result<Vec<_>, Failure>>()
        })?;
        Ok(Self { packs: Mutex::new(packs), fibres })
    }

    /// Advances all fibres by a time, to the nearest whole step: step("10 ms"), or step(0.01) in seconds.
    fn step(&self, py: Python<'_>, duration: &Bound<'_, PyAny>) -> PyResult<()> {
        let duration = seconds(duration)?;
        self.fly_to(py, |now| now + duration)
    }

    /// Advances all fibres to a time, "10 ms" or in seconds, to the nearest whole step. Ctrl-C stops them at
    /// a step in between.
    fn step_to(&self, py: Python<'_>, time: &Bound<'_, PyAny>) -> PyResult<()> {
        let time = seconds(time)?;
        self.fly_to(py, |_| time)
    }

    /// Changes a key between steps: set("air.velocity", 12.0) in SI units, "12 m/s", or "+20 %" of the present value.
    /// keys() says which keys may change. If it cannot, the flight stays as it is.
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
        guarded(py, || Ok(self.lock().first().map_or(0.0, fibre::Flight::time)))
    }

    /// The time step [s].
    #[getter]
    fn time_step(&self, py: Python<'_>) -> PyResult<f64> {
        guarded(py, || Ok(self.lock().first().map_or(0.0, fibre::Flight::time_step)))
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
        self.array(py, |nodes| nodes, |snapshot, lane, node| numbers(snapshot.position[node].lane(lane)))
    }

    /// Velocities of the nodes now [m/s], in the same order.
    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, |nodes| nodes, |snapshot, lane, node| numbers(snapshot.velocity[node].lane(lane)))
    }

    /// Tensions of the elements now [N], negative in compression: fibres x elements.
    #[getter]
    fn tensions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let elements = |nodes: usize| nodes.saturating_sub(1);
        let all = self.array(py, elements, |snapshot, lane, element| [snapshot.tension[element].0[lane]])?;
        all.call_method1("squeeze", (2,))
    }

    /// Energies and works now [J]: an array with a number for each fibre, by name.
    #[getter]
    fn energies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let snapshots = self.snapshots(py)?;
        type Number = fn(&spunlaid::fibre::Energy) -> spunlaid::ground::Lanes;
        let numbers: [(&str, Number); 6] = [
            ("kinetic_j", |energy| energy.kinetic),
            ("axial_j", |energy| energy.axial),
            ("bending_j", |energy| energy.bending),
            ("gravity_work_j", |energy| energy.gravity_work),
            ("air_work_j", |energy| energy.drag_work),
            ("imbalance_j", |energy| energy.imbalance()),
        ];
        let values = |quantity: Number| {
            let values = snapshots.iter().flat_map(|snapshot| quantity(&snapshot.energy).0);
            PyArray1::from_vec(py, values.take(self.fibres as usize).collect())
        };
        numbers.map(|(name, quantity)| (name, values(quantity))).into_py_dict(py)
    }

    /// What each fed fibre has laid on the belt since the last call: a dict of arrays for each fibre.
    fn take_laid<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let laid = guarded(py, || {
            let mut packs = self.lock();
            let curves = |pack: &mut fibre::Flight| -> Vec<Vec<LaidPoint>> {
                (0..pack.fibres()).map(|lane| pack.take_laid(lane)).collect()
            };
            Ok(packs.iter_mut().flat_map(curves).collect::<Vec<_>>())
        })?;
        laid.iter().map(|points| laid_columns(py, points)).collect()
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
    fn lock(&self) -> MutexGuard<'_, Vec<fibre::Flight>> {
        lock(&self.packs)
    }

    /// Flies to a time.
    ///
    /// * `end` – the time from that of now: no other thread steps the fibres in between
    fn fly_to(&self, py: Python<'_>, end: impl FnOnce(f64) -> f64 + Send) -> PyResult<()> {
        let watch = Watch::default();
        let stop = &watch.stop;
        watched(py, &watch, None, || {
            let mut packs = self.lock();
            let Some(first) = packs.first() else { return Ok(()) };
            let (mut now, slice) = (first.time(), STEPS * first.time_step());
            let time = end(now);
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
        guarded(py, || Ok(self.lock().iter().map(fibre::Flight::snapshot).collect()))
    }

    /// Numbers of all fibres now: fibres x places x `N`, NaN where a fibre has fewer places than another one.
    ///
    /// * `places` – of a fibre with so many nodes
    /// * `numbers` – of a snapshot, a lane and a place
    fn array<'py, const N: usize>(
        &self,
        py: Python<'py>,
        places: impl Fn(usize) -> usize,
        numbers: impl Fn(&Snapshot, usize, usize) -> [f64; N],
    ) -> PyResult<Bound<'py, PyAny>> {
        let snapshots = self.snapshots(py)?;
        let width = snapshots.iter().flat_map(|snapshot| snapshot.nodes).map(&places).max().unwrap_or(0);
        let mut flat = Vec::new();
        for snapshot in &snapshots {
            for (lane, nodes) in snapshot.nodes.into_iter().enumerate() {
                let places = places(nodes);
                flat.extend((0..places).flat_map(|place| numbers(snapshot, lane, place)));
                flat.extend(std::iter::repeat_n(f64::NAN, N * (width - places)));
            }
        }
        // The lanes that no fibre uses come last.
        flat.truncate(self.fibres as usize * width * N);
        Ok(PyArray1::from_vec(py, flat).reshape([self.fibres as usize, width, N])?.into_any())
    }
}

const fn numbers(vector: Vec3<f64>) -> [f64; 3] {
    [vector.x, vector.y, vector.z]
}

/// What a fibre laid: fed length, time, place along and across the belt.
fn laid_columns<'py>(py: Python<'py>, points: &[LaidPoint]) -> PyResult<Bound<'py, PyDict>> {
    type Number = fn(&LaidPoint) -> f64;
    let columns: [(&str, Number); 4] =
        [("s_m", |p| p.fed), ("time_s", |p| p.time), ("md_m", |p| p.md), ("cd_m", |p| p.cd)];
    columns
        .map(|(name, of)| Ok((name, column(py, points.iter().map(of))?)))
        .into_iter()
        .collect::<PyResult<Vec<_>>>()?
        .into_py_dict(py)
}
