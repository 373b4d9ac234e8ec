//! The air at given places, as columns of numbers and as CSV.

use spunlaid::air::LocalAir;
use spunlaid::vec3::Vec3;
use spunlaid_charts::shortest;

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

/// The numbers of a place in these columns. They are NaN where the air is not known, and those of eddies where it is not
/// turbulent.
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
