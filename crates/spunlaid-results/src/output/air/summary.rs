//! `summary.json` of the air.

use super::{PLANES, Plane, Slices};
use crate::output::summary::resolved;
use crate::output::versioned_json;
use serde_json::{Value as Json, json};
use spunlaid::case::Case;
use spunlaid::vec3::Vec3;

/// What was found in a plane [m/s].
#[derive(Clone, Copy, Debug)]
pub struct PlaneFindings {
    /// Mean velocity, x, y, z.
    pub mean: [f64; 3],
    /// Rms of the velocity about the mean flow at each place, x, y, z.
    pub rms: [f64; 3],
    /// The rms of each component that the case asks for, over the plane.
    pub expected_rms: f64,
}

/// The text of the file.
///
/// * `replicate` – from 0
pub fn summary(case: &Case, slices: &Slices, replicate: u64, notes: &[String]) -> String {
    let extent = case.extent_of_air();
    let plane = |i: usize| {
        let PlaneFindings { mean, rms, expected_rms } = PlaneFindings::new(case, slices, i);
        let points = slices.planes[i].points;
        let told =
            json!({"points": points, "mean_m_s": mean, "rms_m_s": rms, "expected_rms_m_s": expected_rms});
        (PLANES[i], told)
    };
    let content = json!({
        "replicate": replicate + 1,
        // After these distances the turbulence repeats itself.
        "repeats_md_m": extent.y,
        "repeats_cd_m": extent.z,
        "times_s": slices.times,
        "planes": (0..PLANES.len()).map(plane).collect::<Json>(),
        "notes": notes,
        "case": resolved(case),
    });
    versioned_json(1, content)
}

impl PlaneFindings {
    /// Of a plane, counted from 0.
    pub fn new(case: &Case, slices: &Slices, plane: usize) -> Self {
        let (plane, velocities): (&Plane, &[Vec<Vec3<f64>>]) =
            (&slices.planes[plane], &slices.velocities[plane]);
        let places = plane.places();
        let mut hint = spunlaid::field::Hint::default();
        let flow: Vec<_> = places.iter().map(|place| case.air.local(*place, &mut hint)).collect();
        let count = (velocities.len() * places.len()).max(1) as f64;
        let axes: [fn(&Vec3<f64>) -> f64; 3] = [|v| v.x, |v| v.y, |v| v.z];
        let mean = |term: &dyn Fn(&Vec3<f64>, usize) -> f64| {
            let sum = |all: &Vec<Vec3<f64>>| all.iter().enumerate().map(|(n, v)| term(v, n)).sum::<f64>();
            velocities.iter().map(sum).sum::<f64>() / count
        };
        Self {
            mean: axes.map(|axis| mean(&|v, _| axis(v))),
            rms: axes.map(|axis| mean(&|v, n| (axis(v) - axis(&flow[n].velocity)).powi(2)).sqrt()),
            expected_rms: mean(&|_, n| flow[n].rms.powi(2)).sqrt(),
        }
    }
}
