//! Writes the air of plane diffusers, by formulas: `cases/fields/diffuser.vtu` and, coarser,
//! `cases/fields/diffuser.csv`, and `cases/fields/spunbond.vtu`, which ends at a belt.
//!
//!     cargo run --release -p spunlaid --example diffuser_field
//!
//! The air comes in at `x = 0` around `y = z = 0` with `U₀ = 10 m/s` on average. The walls at `y = ±b` open by
//! 3.5° to each side, `b = 50 mm + x tan 3.5°`, those at `z = ±c`, `c = 100 mm`, are parallel; after 1.2 m it ends.
//! With `η = y/b` and `ζ = z/c`:
//!
//! * `u = (9/8)² U₀ (b₀/b) (1 − η⁸)(1 − ζ⁸)`: as much air through every section, and no slip at the walls
//! * `v = u η db/dx`, `w = 0`: streamlines keep their `η`, and nothing is created or lost anywhere
//! * `k = (0.8 + 2.5 s) u_τ² (1 − η¹⁶)(1 − ζ¹⁶)` with `s = 1 − (1 − η²)(1 − ζ²)` and the friction velocity
//!   `u_τ = U₀ b₀/(20 b)`: from the middle of a channel, 0.8 u_τ², to near its walls, 3.3 u_τ²
//! * `ε = 0.09^(3/4) ((0.8 + 2.5 s) u_τ²)^(3/2) / ℓ` with Nikuradse's mixing length
//!   `ℓ = b (0.14 − 0.08 η² − 0.06 η⁴)`, 0.01 b at the least
//!
//! The air of the spunbond line is faster and opens wider: 60 m/s in the middle of a slit of 30 mm, 10 m/s
//! half a metre below it. Its turbulence was made in the drawing unit: rms 10 % of the velocity in the
//! middle, eddies `0.43 k^(3/2)/ε` of 16 mm.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../../spunlaid-field/tests/field/vtk.rs"]
mod vtk;

use std::fmt::Write;
use std::fs;
use std::path::Path;
use vtk::{ASCII, DataPlace, Mesh, Squeeze, Style};

/// A plane diffuser, in m and m/s.
struct Diffuser {
    length: f64,
    /// At the inlet.
    half_height: f64,
    half_width: f64,
    /// Growth of the half height along x.
    slope: f64,
    /// Mean velocity at the inlet.
    velocity: f64,
    turbulence: Turbulence,
}

enum Turbulence {
    /// That of the flow along the walls.
    OfTheWalls,
    /// With an intensity and a length scale [m] from before the inlet.
    FromBefore { intensity: f64, length: f64 },
}

fn wide() -> Diffuser {
    let slope = 3.5_f64.to_radians().tan();
    let turbulence = Turbulence::OfTheWalls;
    Diffuser { length: 1.2, half_height: 0.05, half_width: 0.1, slope, velocity: 10.0, turbulence }
}

fn spunbond() -> Diffuser {
    let velocity = 60.0 / IN_THE_MIDDLE;
    let turbulence = Turbulence::FromBefore { intensity: 0.1, length: 0.016 };
    Diffuser { length: 0.5, half_height: 0.015, half_width: 0.1, slope: 0.15, velocity, turbulence }
}

/// Velocity in the middle over the mean velocity.
const IN_THE_MIDDLE: f64 = 81.0 / 64.0;

impl Diffuser {
    /// Velocity, `k` and `ε`.
    ///
    /// * `x` – [m]
    /// * `eta`, `zeta` – −1 at one wall, 1 at the other
    fn air(&self, x: f64, eta: f64, zeta: f64) -> [f64; 5] {
        let power = |s: f64, n: i32| 1.0 - s.powi(n);
        let narrow = self.half_height / self.half_height_at(x);
        let u = IN_THE_MIDDLE * self.velocity * narrow * power(eta, 8) * power(zeta, 8);
        let (k, epsilon) = match self.turbulence {
            Turbulence::OfTheWalls => {
                let friction = 0.05 * self.velocity * narrow;
                let k = (0.8 + 2.5 * (1.0 - power(eta, 2) * power(zeta, 2))) * friction * friction;
                let mixing =
                    (0.14 - 0.08 * eta.powi(2) - 0.06 * eta.powi(4)).max(0.01) * self.half_height_at(x);
                (k, 0.09_f64.powf(0.75) * k.powf(1.5) / mixing)
            }
            Turbulence::FromBefore { intensity, length } => {
                let k = 1.5 * (intensity * IN_THE_MIDDLE * self.velocity * narrow).powi(2);
                (k, 0.43 * k.powf(1.5) / length)
            }
        };
        [u, u * eta * self.slope, 0.0, k * power(eta, 16) * power(zeta, 16), epsilon]
    }

    fn half_height_at(&self, x: f64) -> f64 {
        self.half_height + x * self.slope
    }
}

/// Points in rows along x, closer to each other at the walls, and the air there.
fn rows(diffuser: &Diffuser, [nx, ny, nz]: [usize; 3]) -> Vec<([f64; 3], [f64; 5])> {
    let share = |i: usize, n: usize| i as f64 / (n - 1) as f64;
    let across =
        |i: usize, n: usize| if i + 1 == n { 1.0 } else { -(std::f64::consts::PI * share(i, n)).cos() };
    let mut points = Vec::new();
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let x = diffuser.length * share(i, nx);
                let eta = across(j, ny);
                let zeta = across(k, nz);
                let place = [x, eta * diffuser.half_height_at(x), zeta * diffuser.half_width];
                points.push((place, diffuser.air(x, eta, zeta)));
            }
        }
    }
    points
}

fn vtu(diffuser: &Diffuser, size: [usize; 3]) -> Vec<u8> {
    let [nx, ny, nz] = size;
    let rows = rows(diffuser, size);
    let mut cells = Vec::new();
    for k in 0..nz - 1 {
        for j in 0..ny - 1 {
            for i in 0..nx - 1 {
                let first = i + nx * (j + ny * k);
                let face = [first, first + 1, first + 1 + nx, first + nx];
                cells.push((
                    12,
                    face.into_iter().chain(face.map(|point| point + nx * ny)).collect(),
                    Vec::new(),
                ));
            }
        }
    }
    let of = |quantity: usize| rows.iter().map(|(_, air)| air[quantity]).collect();
    let mesh = Mesh {
        points: rows.iter().map(|(point, _)| *point).collect(),
        cells,
        point_data: vec![
            ("U", 3, rows.iter().flat_map(|(_, air)| air[..3].to_vec()).collect()),
            ("k", 1, of(3)),
            ("epsilon", 1, of(4)),
        ],
        cell_data: Vec::new(),
    };
    let (place, squeeze) = (DataPlace::AppendedRaw, Squeeze::Zlib);
    let style = Style { place, squeeze, block: 1 << 15, float: "Float32", integer: "Int32", ..ASCII };
    vtk::vtu(&[mesh], style)
}

fn csv(diffuser: &Diffuser, size: [usize; 3]) -> String {
    let mut table = String::from("x_m,y_m,z_m,u_m_s,v_m_s,w_m_s,k_m2_s2,epsilon_m2_s3\n");
    for ([x, y, z], [u, v, w, k, epsilon]) in rows(diffuser, size) {
        writeln!(table, "{x:.4},{y:.5},{z:.5},{u:.4},{v:.4},{w},{k:.5},{epsilon:.4}").unwrap();
    }
    table
}

fn main() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/fields");
    fs::write(folder.join("diffuser.vtu"), vtu(&wide(), [25, 19, 13])).unwrap();
    fs::write(folder.join("diffuser.csv"), csv(&wide(), [17, 13, 9])).unwrap();
    fs::write(folder.join("spunbond.vtu"), vtu(&spunbond(), [26, 17, 9])).unwrap();
}
