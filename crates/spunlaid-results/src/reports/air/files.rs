//! The planes as numbers and as VTK images for ParaView: `along.pvd` and `across.pvd` open the whole series.

use crate::Failure;
use crate::files::folder::Staging;
use crate::files::paraview::{AppendedArrays, collection};
use crate::files::versioned_json;
use crate::reports::run::summary::resolved;
use serde_json::{Value as Json, json};
use spunlaid_air::{AirAtPlaces, LocalAir};
use spunlaid_charts::shortest;
use spunlaid_fibre::Case;
use spunlaid_ground::Vec3;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Names of the planes, and of the pictures of them.
pub(super) const PLANES: [&str; 2] = ["along", "across"];
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
                return Err(spunlaid_ground::Error::Interrupted);
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
        let object =
            json!({"points": points, "mean_m_s": mean, "rms_m_s": rms, "expected_rms_m_s": expected_rms});
        (PLANES[i], object)
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
        let mut hint = spunlaid_air::Hint::default();
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

/// The columns: place, velocity, its magnitude, turbulence.
pub const POINT_COLUMNS: [&str; 10] = [
    "x_m",
    "y_m",
    "z_m",
    "u_m_s",
    "v_m_s",
    "w_m_s",
    "speed_m_s",
    "k_m2_s2",
    "length_scale_m",
    "cutoff_frequency_hz",
];

/// The numbers of a place in these columns. They are NaN where the air is not known, and those of eddies where it is
/// not turbulent.
pub fn point_row(at: Vec3<f64>, air: Option<LocalAir>) -> [f64; POINT_COLUMNS.len()] {
    let Some(air) = air else {
        let mut row = [f64::NAN; POINT_COLUMNS.len()];
        (row[0], row[1], row[2]) = (at.x, at.y, at.z);
        return row;
    };
    let (v, k) = (air.velocity, air.k());
    let [length, cutoff] = if k > 0.0 { [air.length_scale, air.cutoff_frequency] } else { [f64::NAN; 2] };
    [at.x, at.y, at.z, v.x, v.y, v.z, v.norm(), k, length, cutoff]
}

/// A row for each place, whose numbers read back to the same bits; what is not known is an empty cell.
pub fn points_csv(places: &[Vec3<f64>], found: &[Option<LocalAir>]) -> String {
    let rows = places.iter().zip(found).map(|(at, air)| point_row(*at, *air).map(shortest).join(","));
    let lines = std::iter::once(POINT_COLUMNS.join(",")).chain(rows);
    lines.map(|line| line + "\n").collect()
}

/// Writes each instant of each plane, and the collections with their times.
pub fn write_vtk(staging: &Staging<'_>, slices: &Slices) -> Result<(), Failure> {
    let digits = slices.times.len().to_string().len();
    for ((name, plane), velocities) in ["along", "across"].iter().zip(&slices.planes).zip(&slices.velocities)
    {
        let mut series = Vec::new();
        for (number, (time, velocities)) in slices.times.iter().zip(velocities).enumerate() {
            let file = format!("slices/{name}_{number:0digits$}.vts");
            staging.write(&file, structured_grid(plane, velocities))?;
            series.push((*time, file));
        }
        staging.write(&format!("{name}.pvd"), collection(&series))?;
    }
    Ok(())
}

/// VTK XML StructuredGrid of a plane in space, with single numbers behind the text.
fn structured_grid(plane: &Plane, velocities: &[Vec3<f64>]) -> Vec<u8> {
    let places = plane.places();
    let vectors = |all: &[Vec3<f64>]| -> Vec<u8> {
        all.iter().flat_map(|v| [v.x, v.y, v.z]).flat_map(|x| (x as f32).to_le_bytes()).collect()
    };
    let [columns, rows] = plane.points.map(|points| points - 1);
    let mut arrays = AppendedArrays::default();
    let velocities = arrays.declare("velocity_m_s", "Float32", 3, vectors(velocities));
    let points = arrays.declare("Points", "Float32", 3, vectors(&places));
    let text = format!(
        "<StructuredGrid WholeExtent=\"0 {columns} 0 {rows} 0 0\">\n\
        <Piece Extent=\"0 {columns} 0 {rows} 0 0\">\n<PointData Vectors=\"velocity_m_s\">\n{velocities}\
        </PointData>\n<Points>\n{points}</Points>\n</Piece>\n</StructuredGrid>\n"
    );
    arrays.file("StructuredGrid", &text)
}

/// What is said of places at which the air is not known.
pub fn outside(places: &[Vec3<f64>], found: &[Option<LocalAir>]) -> Option<String> {
    let outside = found.iter().filter(|air| air.is_none()).count();
    let (at, row) = places.iter().zip(1..).zip(found).find(|(_, air)| air.is_none())?.0;
    Some(format!(
        "{outside} of {} positions are where the air is not known, the first of them in row {row} ({}, {}, {} m): \
         their cells are empty",
        places.len(),
        at.x,
        at.y,
        at.z
    ))
}
