//! Air drag on a fibre, along and across its axis.
//!
//! ```text
//! law (friction, normal; boundary_layer, table) → ElementDrag → DragLanes (powers and curve), in the kernel
//! ```

mod boundary_layer;
mod cubics;
mod curve;
mod friction;
mod normal;
mod table;

use crate::body::Fibre;
pub use boundary_layer::BoundaryLayer;
use cubics::Table;
pub use curve::Curve;
pub use friction::FrictionLaw;
pub use normal::NormalLaw;
use spunlaid_ground::lanes::{exp2, log2, power};
use spunlaid_ground::{Lanes, Register, Simd, Vec3, WIDTH, Wide};
use std::f64::consts::PI;
pub use table::{DragTable, TableLaw};

/// The drag laws and their constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drag {
    /// Law along the fibre.
    pub along: FrictionLaw,
    /// Law across the fibre.
    pub across: NormalLaw,
}

impl Drag {
    /// The laws along and across that come from files.
    pub(crate) fn tables(&self) -> [Option<TableLaw>; 2] {
        let along = if let FrictionLaw::Table(law) = self.along { Some(law) } else { None };
        let across = if let NormalLaw::Table(law) = self.across { Some(law) } else { None };
        [along, across]
    }

    /// The laws for an element of a fibre in air of `density` [kg/m³] and kinematic `viscosity` [m²/s].
    pub fn element_drag(&self, fibre: &Fibre, density: f64, viscosity: f64) -> ElementDrag {
        let d = fibre.diameter;
        let l = fibre.rest_length();
        let re_per_velocity = d / viscosity;
        let pressure_area = 0.5 * density * d * l;
        // The factor of a power is the force at |V| = 1 m/s; a curve is shifted along log2 V².
        let power = |factor, exponent| Share { factor, growth: Growth::Power(exponent) };
        let curve = |factor, curve, s: f64| Share {
            factor: factor * density * viscosity * l,
            growth: Growth::Curve(curve, 2.0 * libm::log2(s)),
        };
        let layer = |layer| curve(2.0 * PI, layer, 0.25 * d * re_per_velocity / l);
        let (along, across) = (self.along, self.across);
        ElementDrag {
            along: match along.form() {
                friction::Form::Power { exponent, .. } => {
                    let coefficient = along.coefficient(re_per_velocity, 1.0);
                    power(PI * pressure_area * coefficient, 1.0 - exponent)
                }
                friction::Form::Layer(_, curve) => layer(curve),
                friction::Form::Table(law) => curve(PI, Curve::Table(law), re_per_velocity),
            },
            across: match across.form() {
                normal::Form::Power { exponent, coefficient } => {
                    power(pressure_area * coefficient(re_per_velocity, d), 1.0 - exponent)
                }
                normal::Form::Curve { .. } => curve(1.0, Curve::Across(across), re_per_velocity),
                normal::Form::Table(law) => curve(1.0, Curve::Table(law), re_per_velocity),
            },
        }
    }
}

/// Drag of one element as `F = c_t g_t(|V_t|) V_t t + c_n g_n(|V_n|) V_n`.   theory.md (8), (45)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementDrag {
    /// Friction along the element.
    pub along: Share,
    /// Drag across it.
    pub across: Share,
}

/// The drag in one direction, `F = c g(|V|) V`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// `c`: the force [N] at `g V = 1`.
    pub factor: f64,
    /// `g`.
    pub growth: Growth,
}

/// How the ratio of drag to velocity grows with the velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Growth {
    /// `|V|^p`, `V` in m/s; `p` between 0 and 1 [-].
    Power(f64),
    /// A curve over `s`, with `log2 s² = log2 V² + shift`; along the fibre, `V` is first divided by the
    /// distance of the element's centre from the root in elements.
    Curve(Curve, f64),
}

impl ElementDrag {
    /// Half the drag, which is the share of each of the element's two nodes.
    pub(crate) fn half(self) -> Self {
        let half = |share: Share| Share { factor: 0.5 * share.factor, ..share };
        Self { along: half(self.along), across: half(self.across) }
    }
}

impl Share {
    /// The force [N] of the law at a speed [m/s].
    ///
    /// * `place` – distance of the element's centre from the root, in elements
    pub fn force(&self, speed: f64, place: f64) -> f64 {
        let speed = speed.abs();
        self.factor
            * match self.growth {
                Growth::Power(p) => libm::pow(speed, 1.0 + p),
                Growth::Curve(..) if speed == 0.0 => 0.0,
                Growth::Curve(curve, shift) => {
                    let fading = if curve.fades() { place } else { 1.0 };
                    speed * curve.exact(speed / fading * libm::exp2(0.5 * shift))
                }
            }
    }

    fn curve(&self) -> Option<Curve> {
        match self.growth {
            Growth::Power(_) => None,
            Growth::Curve(curve, _) => Some(curve),
        }
    }
}

impl ElementDrag {
    /// The curves along and across, which all fibres of a flight have in common.
    pub(crate) fn curves(&self) -> [Option<Curve>; 2] {
        [self.along.curve(), self.across.curve()]
    }
}

/// [`ElementDrag`] of eight fibres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct DragLanes {
    /// Along and across.
    factor: [Lanes; 2],
    /// Of laws that are no powers, found once and not for each element.
    table: [Option<&'static Table>; 2],
    /// Whether the law along the fibre fades with the distance from the root.
    fades: bool,
    /// Exponent, of `|V_t|` and of `|V_n|²`, or shift of the curve.
    growth: [Lanes; 2],
}

impl DragLanes {
    /// Packs the element drag of each lane's fibre.
    ///
    /// * `curve` – of all of them, along and across
    pub(crate) fn pack(curve: [Option<Curve>; 2], lanes: &[ElementDrag; WIDTH]) -> Self {
        let both = |number: &dyn Fn(&Share, f64) -> f64| {
            [
                Lanes::from_fn(|i| number(&lanes[i].along, 1.0)),
                Lanes::from_fn(|i| number(&lanes[i].across, 0.5)),
            ]
        };
        let growth = |share: &Share, per_square| match share.growth {
            Growth::Power(p) => per_square * p,
            Growth::Curve(_, shift) => shift,
        };
        Self {
            factor: both(&|share, _| share.factor),
            table: curve.map(|curve| curve.map(Curve::table)),
            fades: curve[0].is_some_and(Curve::fades),
            growth: both(&growth),
        }
    }

    /// Splits the relative velocity into its parts along and across the element.
    ///
    /// * `relative` – velocity of the air relative to the element's centre [m/s]
    /// * `tangent` – unit vector along the element
    #[inline(always)]
    pub(crate) fn split<S: Simd>(relative: Vec3<Wide<S>>, tangent: Vec3<Wide<S>>) -> Split<S> {
        let along = relative.dot(tangent);
        let across = tangent.neg_mul_add(along, relative);
        Split { along, across, powers: Wide([along.abs().0, across.dot(across).0]) }
    }

    /// Whether both laws are powers of the velocity, as in the paper.
    #[inline(always)]
    pub(crate) fn is_powers(&self) -> bool {
        self.table[0].is_none() && self.table[1].is_none()
    }

    /// Computes `g_t` and `g_n` if both laws are powers.
    #[inline(always)]
    pub(crate) fn raise<S: Simd>(&self, split: &mut Split<S>) {
        let exponents = [S::load(&self.growth[0]), S::load(&self.growth[1])];
        split.powers = power(split.powers, Wide(exponents));
    }

    /// Computes `g_t` and `g_n` of element `j` for any laws.
    #[inline(always)]
    pub(crate) fn look_up<S: Register>(&self, j: usize, split: &mut Split<S>) {
        let [mut along, across] = split.powers.0;
        if self.fades {
            along = along.mul(S::splat(1.0 / (j as f64 + 0.5)));
        }
        let [along, across] = log2(Wide([along, across])).0;
        split.powers = Wide([self.grown(0, Wide(along), 2.0).0, self.grown(1, Wide(across), 1.0).0]);
    }

    /// `g` in one direction from `log2`, the logarithm of the base of its power; `to_square · log2` is `log2 V²`.
    #[inline(always)]
    fn grown<S: Register>(&self, direction: usize, log2: Wide<S>, to_square: f64) -> Wide<S> {
        let growth = Wide::load(&self.growth[direction]);
        match self.table[direction] {
            None => exp2(log2 * growth),
            Some(table) => table.at(log2.mul_add(Wide::splat(to_square), growth)),
        }
    }

    /// Force of the air on an element [N].                                   theory.md (8), (45)
    #[inline(always)]
    pub(crate) fn force<S: Simd>(&self, split: &Split<S>, tangent: Vec3<Wide<S>>) -> Vec3<Wide<S>> {
        let [tangential, normal] = split.powers.0;
        let friction = Wide::load(&self.factor[0]) * split.along * Wide(tangential);
        split.across.mul_add(Wide::load(&self.factor[1]) * Wide(normal), tangent * friction)
    }
}

/// A relative velocity along and across an element, with the powers that give the drag.
#[derive(Clone, Copy)]
pub(crate) struct Split<S: Simd> {
    along: Wide<S>,
    across: Vec3<Wide<S>>,
    /// First `|V_t|` and `|V_n|²`, then `g_t` and `g_n`.
    powers: Wide<[S; 2]>,
}

impl<S: Simd> Split<S> {
    #[inline(always)]
    pub(crate) fn none() -> Self {
        Self { along: Wide::zero(), across: Vec3::zero(), powers: Wide::zero() }
    }
}

/// The publication of a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// How a text names it: `Matsui 1976`.
    pub short: &'static str,
    /// Its entry in a list of references.
    pub full: &'static str,
}
