//! Writes the air of a plane diffuser, by formulas, to `cases/fields/diffuser.vtu` and, coarser,
//! `cases/fields/diffuser.csv`.
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

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../tests/common/vtk.rs"]
mod vtk;

use std::fmt::Write;
use std::fs;
use std::path::Path;
use vtk::{ASCII, Mesh, Place, Squeeze, Style};

const LENGTH: f64 = 1.2;
const HALF_HEIGHT: f64 = 0.05;
const HALF_WIDTH: f64 = 0.1;
const VELOCITY: f64 = 10.0;

/// Velocity, `k` and `ε`.
///
/// * `x` – [m]
/// * `eta`, `zeta` – −1 at one wall, 1 at the other
fn air(x: f64, eta: f64, zeta: f64) -> [f64; 5] {
    let power = |s: f64, n: i32| 1.0 - s.powi(n);
    let narrow = HALF_HEIGHT / half_height(x);
    let u = (9.0_f64 / 8.0).powi(2) * VELOCITY * narrow * power(eta, 8) * power(zeta, 8);
    let friction = 0.05 * VELOCITY * narrow;
    let k = (0.8 + 2.5 * (1.0 - power(eta, 2) * power(zeta, 2))) * friction * friction;
    let mixing = (0.14 - 0.08 * eta.powi(2) - 0.06 * eta.powi(4)).max(0.01) * half_height(x);
    let epsilon = 0.09_f64.powf(0.75) * k.powf(1.5) / mixing;
    [u, u * eta * slope(), 0.0, k * power(eta, 16) * power(zeta, 16), epsilon]
}

fn slope() -> f64 {
    3.5_f64.to_radians().tan()
}

fn half_height(x: f64) -> f64 {
    HALF_HEIGHT + x * slope()
}

/// Points in rows along x, closer to each other at the walls, and the air there.
fn rows([nx, ny, nz]: [usize; 3]) -> Vec<([f64; 3], [f64; 5])> {
    let share = |i: usize, n: usize| i as f64 / (n - 1) as f64;
    let across =
        |i: usize, n: usize| if i + 1 == n { 1.0 } else { -(std::f64::consts::PI * share(i, n)).cos() };
    let mut points = Vec::new();
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let (x, eta, zeta) = (LENGTH * share(i, nx), across(j, ny), across(k, nz));
                points.push(([x, eta * half_height(x), zeta * HALF_WIDTH], air(x, eta, zeta)));
            }
        }
    }
    points
}

fn vtu(size: [usize; 3]) -> Vec<u8> {
    let [nx, ny, nz] = size;
    let rows = rows(size);
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
    let (place, squeeze) = (Place::AppendedRaw, Squeeze::Zlib);
    let style = Style { place, squeeze, block: 1 << 15, float: "Float32", integer: "Int32", ..ASCII };
    vtk::vtu(&[mesh], style)
}

fn csv(size: [usize; 3]) -> String {
    let mut table = String::from("x_m,y_m,z_m,u_m_s,v_m_s,w_m_s,k_m2_s2,epsilon_m2_s3\n");
    for ([x, y, z], [u, v, w, k, epsilon]) in rows(size) {
        writeln!(table, "{x:.4},{y:.5},{z:.5},{u:.4},{v:.4},{w},{k:.5},{epsilon:.4}").unwrap();
    }
    table
}

fn main() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/fields");
    fs::write(folder.join("diffuser.vtu"), vtu([25, 19, 13])).unwrap();
    fs::write(folder.join("diffuser.csv"), csv([17, 13, 9])).unwrap();
}
