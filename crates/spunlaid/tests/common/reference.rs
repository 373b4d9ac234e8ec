//! The force model in plain scalar Rust, written from the equations and not from the kernel: angles by the
//! arctangent, forces by unit normals, drag by Reynolds numbers. The yardstick of the kernel.

use super::V;
use spunlaid_fibre::{FibreParameters, Root};
use std::f64::consts::PI;

pub struct ReferenceDrag {
    pub air_density: f64,
    pub viscosity: f64,
    pub beta: f64,
}

/// Forces on the nodes [N]: tension, bending, gravity, drag in air of the given velocity per element.
pub fn forces(s: &FibreParameters, drag: Option<&ReferenceDrag>, air: &[V], r: &[V], v: &[V]) -> Vec<V> {
    let fibre = &s.fibre;
    let n = fibre.elements;
    let d = fibre.diameter;
    let l = fibre.length / fibre.elements as f64;
    let area = PI * d * d / 4.0;
    let ka = fibre.youngs_modulus * area / l;
    let kt = fibre.youngs_modulus * PI * d.powi(4) / 64.0 / l;
    let mass = fibre.density * area * l;
    let mut f = vec![V::default(); n + 1];
    let edge = |j: usize| r[j + 1] - r[j];
    for j in 0..n {
        let e = edge(j);
        let t = e * (1.0 / e.norm());
        let pull = t * (ka * (e.norm() - l));
        f[j] += pull;
        f[j + 1] -= pull;
        if let Some(drag) = drag {
            let half = element_drag(drag, d, l, air[j] - (v[j] + v[j + 1]) * 0.5, t) * 0.5;
            f[j] += half;
            f[j + 1] += half;
        }
    }
    let mut bend = |i: usize, above: V, stiffness: f64, below: V| {
        let (l0, l1) = (above.norm(), below.norm());
        let (t0, t1) = (above * (1.0 / l0), below * (1.0 / l1));
        let c = t0.cross(t1);
        if c.norm() == 0.0 {
            return;
        }
        let moment = stiffness * c.norm().atan2(t0.dot(t1));
        let normal = c * (1.0 / c.norm());
        let a = normal.cross(t0) * (moment / l0);
        let b = normal.cross(t1) * (moment / l1);
        if i > 0 {
            f[i - 1] -= a;
        }
        f[i] += a + b;
        f[i + 1] -= b;
    };
    for i in 1..n {
        bend(i, edge(i - 1), kt, edge(i));
    }
    if fibre.root == Root::Clamped {
        bend(0, fibre.direction, 2.0 * kt, edge(0));
    }
    for (i, force) in f.iter_mut().enumerate() {
        force.x += s.gravity * if i == 0 || i == n { mass / 2.0 } else { mass };
    }
    f
}

fn element_drag(drag: &ReferenceDrag, d: f64, l: f64, relative: V, t: V) -> V {
    let along = relative.dot(t);
    let across = relative - t * along;
    let mut force = V::default();
    if along != 0.0 {
        let cf = drag.beta * (along.abs() * d / drag.viscosity).powf(-0.61);
        force += t * (0.5 * PI * d * l * drag.air_density * cf * along.abs() * along);
    }
    let speed = across.norm();
    if speed > 0.0 {
        let cn = 6.96 * (speed * d / drag.viscosity).powf(-0.440) * (d / 78e-6).powf(0.404);
        force += across * (0.5 * d * l * drag.air_density * cn * speed);
    }
    force
}

/// Potential energy of stretch and bending [J].
pub fn elastic_energy(s: &FibreParameters, r: &[V]) -> f64 {
    let fibre = &s.fibre;
    let n = fibre.elements;
    let d = fibre.diameter;
    let l = fibre.length / fibre.elements as f64;
    let ka = fibre.youngs_modulus * PI * d * d / 4.0 / l;
    let kt = fibre.youngs_modulus * PI * d.powi(4) / 64.0 / l;
    let edge = |j: usize| r[j + 1] - r[j];
    let angle = |a: V, b: V| a.cross(b).norm().atan2(a.dot(b));
    let stretch: f64 = (0..n).map(|j| 0.5 * ka * (edge(j).norm() - l).powi(2)).sum();
    let bend: f64 = (1..n).map(|i| 0.5 * kt * angle(edge(i - 1), edge(i)).powi(2)).sum();
    let root = if fibre.root == Root::Clamped { kt * angle(fibre.direction, edge(0)).powi(2) } else { 0.0 };
    stretch + bend + root
}
