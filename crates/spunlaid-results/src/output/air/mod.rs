//! The turbulent air of a case, looked at in two planes while it passes.
//!
//! ```text
//! Slices   the velocities on the points of both planes, instant by instant
//! points   the air at given places as CSV
//! vtk      each instant as VTK images
//! pictures the first instant as figures
//! summary  what was looked at, and how strong the gusts are
//! ```

mod pictures;
mod points;
mod summary;
mod vtk;

pub use pictures::{PLANES, pictures};
pub use points::{POINT_COLUMNS, point_row, points_csv};
pub use summary::{PlaneFindings, summary};
pub use vtk::write_vtk;

use crate::Failure;
use spunlaid::air::AirAtPlaces;
use spunlaid::case::Case;
use spunlaid::vec3::Vec3;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Points along the longer side of a plane.
const POINTS: usize = 120;
/// Fewest points along the shorter side.
const FEWEST: usize = 8;

/// Points of a plane, evenly spaced along two axes of space.
#[derive(Clone, Debug)]
pub struct Plane {
    /// A corner [m].
    pub corner: Vec3<f64>,
    /// From one point to the next along the first and the second axis [m].
    pub steps: [Vec3<f64>; 2],
    /// Number of points along each axis.
    pub points: [usize; 2],
}

impl Plane {
    fn places(&self) -> Vec<Vec3<f64>> {
        let [columns, rows] = self.points;
        let place = |n: usize| {
            let [i, j] = [n % columns, n / columns].map(|i| i as f64);
            self.corner + self.steps[0] * i + self.steps[1] * j
        };
        (0..columns * rows).map(place).collect()
    }
}

/// The velocities on the points of two planes at even times.
#[derive(Clone, Debug)]
pub struct Slices {
    /// The plane of the way and the machine direction through its middle, and the plane across the end of the way.
    pub planes: [Plane; 2],
    /// [s]
    pub times: Vec<f64>,
    /// Of each plane and time the velocities on its points [m/s].
    pub velocities: [Vec<Vec<Vec3<f64>>>; 2],
}

/// What is looked at.
#[derive(Clone, Copy, Debug)]
pub struct AirViews {
    /// Number of the replicate whose air it is, from 0.
    pub replicate: u64,
    /// Number of instants.
    pub frames: u64,
    /// Time from the first to the last of them [s]; the time that the air needs for the way if left out.
    pub duration: Option<f64>,
    /// Threads that make the turbulence.
    pub threads: usize,
}

impl Slices {
    /// Looks at the air of a case.
    ///
    /// * `done` – number of instants so far
    ///
    /// # Errors
    /// If the air of the case has no turbulence in space, or `stop` was set.
    pub fn new(case: &Case, looks: &AirViews, done: &AtomicU64, stop: &AtomicBool) -> Result<Self, Failure> {
        let mut air = case.air_at_places(looks.replicate, looks.threads)?;
        let planes = planes(case, &air);
        let places = planes.each_ref().map(Plane::places);
        let duration = looks.duration.unwrap_or_else(|| case.travel_of_air());
        let last = looks.frames.saturating_sub(1).max(1) as f64;
        let times: Vec<f64> = (0..looks.frames).map(|i| duration * i as f64 / last).collect();
        let mut velocities = [Vec::new(), Vec::new()];
        for time in &times {
            if stop.load(Ordering::Relaxed) {
                return Err(spunlaid::error::Error::Interrupted);
            }
            for (velocities, places) in velocities.iter_mut().zip(&places) {
                velocities.push(air.velocities(*time, places)?);
            }
            done.fetch_add(1, Ordering::Relaxed);
        }
        Ok(Self { planes, times, velocities })
    }
}

/// The planes: as long as the way, and at most as wide as the turbulence before it repeats itself.
fn planes(case: &Case, air: &AirAtPlaces) -> [Plane; 2] {
    let (way, extent) = (case.way_of_air(), air.extent());
    let [y, z] = [extent.y.min(way), extent.z.min(way)];
    let plane = |sides: [f64; 2], axes: [Vec3<f64>; 2], corner: Vec3<f64>| {
        let spacing = sides[0].max(sides[1]) / (POINTS - 1) as f64;
        let points = sides.map(|side| ((side / spacing).round() as usize + 1).max(FEWEST));
        let step = |i: usize| axes[i] * (sides[i] / (points[i] - 1) as f64);
        Plane { corner, steps: [step(0), step(1)], points }
    };
    let [along_x, along_y, along_z] =
        [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)];
    [
        plane([way, y], [along_x, along_y], Vec3::new(0.0, -0.5 * y, 0.0)),
        plane([z, y], [along_z, along_y], Vec3::new(way, -0.5 * y, -0.5 * z)),
    ]
}
