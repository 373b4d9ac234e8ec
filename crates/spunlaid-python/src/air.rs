//! `AirSampler`: the turbulent air of a case, which Python looks at.

use crate::case::Case;
use crate::warning::warn_of;
use crate::watched::{guarded, threads};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use spunlaid::air::AirAtPlaces;
use spunlaid::ground::Vec3;
use spunlaid::ground::threads::lock;
use spunlaid_results::Failure;
use std::sync::Mutex;

/// The turbulent air of a case. spunlaid.Air shows it.
#[pyclass(frozen, module = "spunlaid._spunlaid")]
#[derive(Debug)]
pub(crate) struct AirSampler {
    air: Mutex<AirAtPlaces>,
}

#[pymethods]
impl AirSampler {
    /// * `replicate` – from 0
    #[new]
    fn new(py: Python<'_>, case: &Case, replicate: u64) -> PyResult<Self> {
        warn_of(py, &case.notes)?;
        let description = &*case.case;
        let air = guarded(py, || description.air_at_places(replicate, threads(None)))?;
        Ok(Self { air: Mutex::new(air) })
    }

    /// Velocities at times and places, number by number: arrays of n times, and of n x 3 places and velocities.
    fn velocities<'py>(
        &self,
        py: Python<'py>,
        times: PyReadonlyArray1<'py, f64>,
        places: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let times: Vec<f64> = times.as_array().iter().copied().collect();
        let places = places.as_array();
        let places: Vec<Vec3<f64>> = places.rows().into_iter().map(|p| Vec3::new(p[0], p[1], p[2])).collect();
        let found = guarded(py, || {
            let mut air = lock(&self.air);
            // In the order of the times, in which the turbulence is made.
            let mut order: Vec<usize> = (0..times.len()).collect();
            order.sort_by(|a, b| times[*a].total_cmp(&times[*b]));
            let mut found = vec![[0.0; 3]; times.len()];
            for same in order.chunk_by(|a, b| times[*a] == times[*b]) {
                let there: Vec<Vec3<f64>> = same.iter().map(|i| places[*i]).collect();
                for (i, velocity) in same.iter().zip(air.velocities(times[same[0]], &there)?) {
                    found[*i] = [velocity.x, velocity.y, velocity.z];
                }
            }
            Ok::<_, Failure>(found)
        })?;
        let count = found.len();
        PyArray1::from_vec(py, found.into_flattened()).reshape([count, 3])
    }

    /// After what distances the turbulence repeats itself along y and z [m].
    #[getter]
    fn extent(&self, py: Python<'_>) -> (f64, f64) {
        // Another thread may look up air meanwhile.
        let extent = py.detach(|| lock(&self.air).extent());
        (extent.y, extent.z)
    }
}
