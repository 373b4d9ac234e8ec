//! Coiling of a heavy elastic thread that is fed slowly on to a plane: its boundary-value problem, solved
//! without the chain, to compare the chain with.
//!
//! **The balance.** `N` and `M` are the force and the moment that the thread below a section puts on the
//! thread above it, `w = ρAg` the weight per length along +x, `c` the damping per mass, `V` and `a` the
//! velocity and the acceleration of the material:
//!
//!     N' + w x̂ − ρA c V = ρA a        M' + t × N = 0
//!
//! (no rotational inertia). Without twist `M = EI t × t'`, hence `t' = M × t / EI` and `M·t = 0`; `M·t` stays
//! as it is along the thread, `(M·t)' = (N × t)·t + M·(M × t)/EI = 0`. A steady coil turns like a solid body
//! with the angular velocity `Ω x̂`, while the thread runs through its shape at the feed speed `v`:
//!
//!     V = v t + Ω x̂ × r        a = v² t' + 2 v Ω x̂ × t + Ω² x̂ × (x̂ × r)
//!
//! In lengths of the height `H`, forces of `EI/H²` and moments of `EI/H`, with `G = wH³/EI`,
//! `Fr = v²/(gH)`, `C = c v/g` and `W = ΩH/v`:
//!
//!     r' = t     t' = m × t     m' = n × t
//!     n' = −G x̂ + G Fr (t' + 2W x̂ × t + W² x̂ × (x̂ × r)) + G C (t + W x̂ × r)
//!
//! **The ends.** What lies on the plane is a circle of radius `R` and does not move. So `V = 0` at the
//! touch-down: `t` is along the circle, and with `t = e_φ` (`x̂ × e_ρ = e_φ`) `W = −1/R`. The plane puts a
//! force on the touch-down, but no moment, so the curvature is that of the circle there too, `t' = −e_ρ/R`,
//! which is `m = x̂/R`: no curvature out of the plane, and `m·t = 0`. The touch-down is held at
//! `r = x̂ + R e_y`, so `t = e_z`. Unknown are `n` there, `R` and the length `S` in the air, five numbers. At
//! the root `r = 0`, and a clamped root has `t = x̂`, a pinned one `m = 0`. Both are two conditions beside the
//! three of the place, as the length of `t` and `m·t` are known already. That is all that a pinned root changes
//! in the equations. Its circle is wider, by 1.4 % at `G = 153`, 5.3 % at 28.6, 22 % at 5.35 and 66 % at 1, and a
//! weightless thread has no coil from a pin: the moments about the root, `x̂/R + (x̂ + R ŷ) × n`, cannot all be
//! zero. How stiff the clamp is matters likewise: as soft as 0.02 H of the thread, it adds 0.5 % at `G = 28.6`
//! and 1.6 % at 1.
//!
//! **The method.** Runge–Kutta of fourth order from the touch-down to the root, in pieces, for what is wrong at
//! one end grows like `exp(S√G)` to the other; Newton's method for the five numbers and for the states where
//! the pieces meet; continuation from the weightless thread. For a coil that turns the other way mirror `z`.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use super::{V, X};

/// Steps along the thread. Twice as many change `R` and `S` by less than 3e-8 up to `G = 153`.
const STEPS: usize = 200;
/// Pieces of the thread.
const PIECES: usize = 5;
/// `n`, `R` and `S` of the weightless thread from a clamped root, roughly; Newton's method does the rest.
/// Of 4000 starts spread widely about it, 173 came to an end, all at this coil.
const WEIGHTLESS: [f64; 5] = [-3.51, -2.85, -2.16, 0.68, 1.79];
/// The last change of an unknown in Newton's method, by its size.
const SETTLED: f64 = 1e-11;

/// One place of the thread, in a frame that turns with the coil.
#[derive(Clone, Copy, Debug)]
pub struct RodState {
    /// Distance from the root along the thread [H].
    pub s: f64,
    /// [H]
    pub position: V,
    /// Unit vector towards the plane.
    pub tangent: V,
    /// [EI/H]; without twist its length is that of the curvature [1/H].
    pub moment: V,
    /// Force of the thread below on the thread above [EI/H²].
    pub force: V,
}

/// A steady coil, in lengths of the height of the root above the plane.
#[derive(Clone, Debug)]
pub struct Coil {
    /// Of the circle on the plane [H]
    pub radius: f64,
    /// Of the thread in the air [H]
    pub length: f64,
    /// With which the root holds the thread, negative where it pushes it [EI/H²]
    pub root_tension: f64,
    /// From the root to the touch-down, evenly spaced.
    pub shape: Vec<RodState>,
}

impl Coil {
    /// Position at a distance from the root [H]: a cubic between places that has their tangents. Beyond the
    /// touch-down it follows the circle.
    pub fn position(&self, s: f64) -> V {
        if s >= self.length {
            let turned = (s - self.length) / self.radius;
            return V::new(1.0, self.radius * turned.cos(), self.radius * turned.sin());
        }
        let step = self.length / (self.shape.len() - 1) as f64;
        let i = ((s / step) as usize).min(self.shape.len() - 2);
        let (a, b) = (&self.shape[i], &self.shape[i + 1]);
        let x = (s - a.s) / step;
        let y = 1.0 - x;
        a.position * (y * y * (1.0 + 2.0 * x))
            + b.position * (x * x * (1.0 + 2.0 * y))
            + (a.tangent * y - b.tangent * x) * (x * y * step)
    }
}

/// The coil of a thread from a clamped root.
///
/// * `g` – `G = wH³/EI`
/// * `froude` – `v²/(gH)`, with the feed speed `v`
/// * `damping` – `c v/g`, with the damping `c` per mass [1/s]
pub fn coil(g: f64, froude: f64, damping: f64) -> Coil {
    Thread { g, froude, damping, give: 0.0 }.coil(STEPS)
}

/// The same from a pinned root.
pub fn coil_from_a_pin(g: f64, froude: f64, damping: f64) -> Coil {
    Thread { g, froude, damping, give: 1.0 }.coil(STEPS)
}

/// The numbers of the problem.
#[derive(Clone, Copy, Debug)]
pub struct Thread {
    pub g: f64,
    pub froude: f64,
    pub damping: f64,
    /// How soft the root is held: 0 clamped, 1 pinned; between them it turns against a spring of the stiffness
    /// `(1 − give)/give` [EI/H].
    pub give: f64,
}

impl Thread {
    /// The coil by `steps` along the thread, as many in each piece.
    ///
    /// # Panics
    ///
    /// When continuation from the weightless thread does not get there, or steps are no multiple of the pieces.
    pub fn coil(&self, steps: usize) -> Coil {
        assert_eq!(steps % PIECES, 0, "steps in each of {PIECES} pieces");
        let weightless = Self { g: 0.0, give: 0.0, ..*self };
        let mut unknowns = WEIGHTLESS.to_vec();
        for piece in 1..PIECES {
            let end = *weightless.piece(&unknowns, piece - 1, steps).last().expect("its start at least");
            unknowns.extend(end.state());
        }
        // Weight, speed and damping grow together, by shares of the bending length (EI/w)^⅓; then the root gives.
        let whole_way = if self.give > 0.0 { 2.0 } else { 1.0 };
        let (mut done, mut stride) = (-1.0, 1.0);
        while done < whole_way {
            let next = f64::min(done + stride, whole_way);
            let weight = next.clamp(0.0, 1.0).powi(3);
            let on_the_way = Self { g: self.g * weight, give: self.give * (next - 1.0).max(0.0), ..*self };
            match on_the_way.closed(unknowns.clone(), steps) {
                Some(found) => (unknowns, done, stride) = (found, next, f64::min(2.0 * stride, 0.1)),
                None => stride *= 0.5,
            }
            assert!(stride > 1e-6, "no coil of {self:?} beyond {done} of the way");
        }
        let mut shape: Vec<RodState> = (0..PIECES)
            .flat_map(|piece| self.piece(&unknowns, piece, steps).into_iter().skip(usize::from(piece > 0)))
            .collect();
        shape.reverse();
        let root = shape[0];
        let (radius, length) = (unknowns[3], unknowns[4]);
        Coil { radius, length, root_tension: root.force.dot(root.tangent), shape }
    }

    /// Newton's method: the unknowns for which the thread is whole and the root is held as it should be, if a
    /// few steps get there.
    fn closed(&self, mut unknowns: Vec<f64>, steps: usize) -> Option<Vec<f64>> {
        for _ in 0..8 {
            let missed = self.missed(&unknowns, steps);
            let mut slopes = vec![vec![0.0; unknowns.len()]; missed.len()];
            for i in 0..unknowns.len() {
                let apart = 1e-6 * unknowns[i].abs().max(1.0);
                let mut at = |by: f64| {
                    let old = unknowns[i];
                    unknowns[i] += by;
                    let missed = self.missed(&unknowns, steps);
                    unknowns[i] = old;
                    missed
                };
                let (up, down) = (at(apart), at(-apart));
                for (row, (up, down)) in slopes.iter_mut().zip(up.iter().zip(down)) {
                    row[i] = (up - down) / (2.0 * apart);
                }
            }
            let changes = solved(slopes, missed)?;
            let mut settled = true;
            for (unknown, change) in unknowns.iter_mut().zip(changes) {
                *unknown -= change;
                settled &= change.abs() < SETTLED * unknown.abs().max(1.0);
            }
            if settled {
                return Some(unknowns);
            }
        }
        None
    }

    /// What should be zero: gaps between the pieces, and what is asked of the root.
    fn missed(&self, unknowns: &[f64], steps: usize) -> Vec<f64> {
        let mut missed = Vec::new();
        for piece in 0..PIECES {
            let end = *self.piece(unknowns, piece, steps).last().expect("its start at least");
            if piece + 1 < PIECES {
                missed.extend(end.state().iter().zip(above(unknowns, piece)).map(|(end, start)| end - start));
            } else {
                let r = end.position;
                let t = end.tangent;
                let m = end.moment;
                let (firm, give) = (1.0 - self.give, self.give);
                missed.extend([r.x, r.y, r.z, firm * t.y - give * m.z, firm * t.z + give * m.y]);
            }
        }
        missed
    }

    /// One piece of the thread, upwards; the first starts at the touch-down.
    fn piece(&self, unknowns: &[f64], piece: usize, steps: usize) -> Vec<RodState> {
        let (radius, length) = (unknowns[3], unknowns[4]);
        let start = if piece == 0 {
            RodState {
                s: length,
                position: V::new(1.0, radius, 0.0),
                tangent: V::new(0.0, 0.0, 1.0),
                moment: X * (1.0 / radius),
                force: V::new(unknowns[0], unknowns[1], unknowns[2]),
            }
        } else {
            let s = length * (PIECES - piece) as f64 / PIECES as f64;
            RodState::new(s, above(unknowns, piece - 1))
        };
        let step = -length / steps as f64;
        let mut places = vec![start];
        for i in 0..steps / PIECES {
            let a = places[i];
            let k1 = self.slope(&a, radius);
            let k2 = self.slope(&a.moved(&k1, 0.5 * step), radius);
            let k3 = self.slope(&a.moved(&k2, 0.5 * step), radius);
            let k4 = self.slope(&a.moved(&k3, step), radius);
            let outer = a.moved(&k1, step / 6.0).moved(&k4, step / 6.0);
            places.push(outer.moved(&k2, step / 3.0).moved(&k3, step / 3.0));
        }
        places
    }

    /// How a place changes along the thread.
    fn slope(&self, at: &RodState, radius: f64) -> RodState {
        let RodState { position: r, tangent: t, moment: m, force: n, .. } = *at;
        let turning = X * (-1.0 / radius);
        let bent = m.cross(t);
        let velocity = t + turning.cross(r);
        let acceleration = bent + turning.cross(t + velocity);
        RodState {
            s: 1.0,
            position: t,
            tangent: bent,
            moment: n.cross(t),
            force: (acceleration * self.froude + velocity * self.damping - X) * self.g,
        }
    }
}

/// The state at the upper end of a piece, among the unknowns.
fn above(unknowns: &[f64], piece: usize) -> &[f64] {
    &unknowns[5 + 12 * piece..17 + 12 * piece]
}

impl RodState {
    /// All but `s`, in a row.
    fn state(&self) -> [f64; 12] {
        let r = self.position;
        let t = self.tangent;
        let m = self.moment;
        let n = self.force;
        [r.x, r.y, r.z, t.x, t.y, t.z, m.x, m.y, m.z, n.x, n.y, n.z]
    }

    /// The place of a state.
    fn new(s: f64, state: &[f64]) -> Self {
        let vector = |i: usize| V::new(state[i], state[i + 1], state[i + 2]);
        Self { s, position: vector(0), tangent: vector(3), moment: vector(6), force: vector(9) }
    }

    /// The place further along by `step` of a slope.
    fn moved(&self, slope: &Self, step: f64) -> Self {
        Self {
            s: self.s + slope.s * step,
            position: self.position + slope.position * step,
            tangent: self.tangent + slope.tangent * step,
            moment: self.moment + slope.moment * step,
            force: self.force + slope.force * step,
        }
    }
}

/// The solution of linear equations: Gauss, with pivots.
fn solved(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Option<Vec<f64>> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))?;
        a.swap(k, pivot);
        b.swap(k, pivot);
        let (done, rest) = a.split_at_mut(k + 1);
        for (i, row) in rest.iter_mut().enumerate() {
            let factor = row[k] / done[k][k];
            if factor != 0.0 {
                row.iter_mut().zip(&done[k]).skip(k).for_each(|(x, y)| *x -= factor * y);
                b[k + 1 + i] -= factor * b[k];
            }
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - known) / a[k][k];
    }
    b.iter().all(|x| x.is_finite()).then_some(b)
}
