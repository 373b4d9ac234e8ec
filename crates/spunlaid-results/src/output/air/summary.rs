//! `summary.json` of the air.

use super::{PLANES, Plane, Slices};
use crate::output::in_order::OrderedObject;
use crate::output::summary::resolved;
use crate::output::versioned_json;
use serde::Serialize;
use serde_json::Value as Json;
use spunlaid::case::Case;
use spunlaid::vec3::Vec3;

/// Content of the file.
#[derive(Debug, Serialize)]
pub struct Summary {
    /// Number of the replicate whose air it is, from 1.
    pub replicate: u64,
    /// After what distance the turbulence repeats itself in machine direction [m].
    pub repeats_md_m: f64,
    /// And in cross direction [m].
    pub repeats_cd_m: f64,
    /// [s]
    pub times_s: Vec<f64>,
    /// By name: along, across.
    pub planes: OrderedObject<PlaneSummary>,
    /// Remarks.
    pub notes: Vec<String>,
    /// The resolved case.
    pub case: OrderedObject<OrderedObject<Json>>,
}

/// What was found in a plane.
#[derive(Clone, Debug, Serialize)]
pub struct PlaneSummary {
    /// Number of points along its axes.
    pub points: [usize; 2],
    /// Mean velocity, x, y, z [m/s].
    pub mean_m_s: [f64; 3],
    /// Rms of the velocity about the mean flow at each place, x, y, z [m/s].
    pub rms_m_s: [f64; 3],
    /// The rms of each component that the case asks for, over the plane [m/s].
    pub expected_rms_m_s: f64,
}

impl Summary {
    /// * `replicate` – from 0
    pub fn new(case: &Case, slices: &Slices, replicate: u64, notes: &[String]) -> Self {
        let extent = case.extent_of_air();
        let plane = |i: usize| {
            (PLANES[i].to_owned(), summarise_plane(case, &slices.planes[i], &slices.velocities[i]))
        };
        Self {
            replicate: replicate + 1,
            repeats_md_m: extent.y,
            repeats_cd_m: extent.z,
            times_s: slices.times.clone(),
            planes: OrderedObject((0..PLANES.len()).map(plane).collect()),
            notes: notes.to_vec(),
            case: resolved(case),
        }
    }

    /// The file's text.
    pub fn to_json(&self) -> String {
        versioned_json(1, self)
    }
}

fn summarise_plane(case: &Case, plane: &Plane, velocities: &[Vec<Vec3<f64>>]) -> PlaneSummary {
    let places = plane.places();
    let mut hint = spunlaid::field::Hint::default();
    let flow: Vec<_> = places.iter().map(|place| case.air.local(*place, &mut hint)).collect();
    let count = (velocities.len() * places.len()).max(1) as f64;
    let axes: [fn(&Vec3<f64>) -> f64; 3] = [|v| v.x, |v| v.y, |v| v.z];
    let mean = |term: &dyn Fn(&Vec3<f64>, usize) -> f64| {
        let sum = |all: &Vec<Vec3<f64>>| all.iter().enumerate().map(|(n, v)| term(v, n)).sum::<f64>();
        velocities.iter().map(sum).sum::<f64>() / count
    };
    PlaneSummary {
        points: plane.points,
        mean_m_s: axes.map(|axis| mean(&|v, _| axis(v))),
        rms_m_s: axes.map(|axis| mean(&|v, n| (axis(v) - axis(&flow[n].velocity)).powi(2)).sqrt()),
        expected_rms_m_s: mean(&|_, n| flow[n].rms.powi(2)).sqrt(),
    }
}
