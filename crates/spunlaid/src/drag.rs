//! Air drag on a fibre, along and across its axis.

use crate::fibre::Fibre;
use crate::lanes::{Lanes, Simd, Wide, power};
use crate::vec3::Vec3;
use std::f64::consts::PI;

/// Law of the friction along the fibre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrictionLaw {
    /// `C_f = β Re^-0.61`, turbulent boundary layer of a long cylinder (Matsui 1976).
    Matsui,
}

impl FrictionLaw {
    /// Name in the case file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Matsui => "matsui",
        }
    }
}

/// Law of the drag across the fibre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NormalLaw {
    /// `C_n = 6.96 Re^-0.440 (d/78 µm)^0.404`, fitted for 13–390 µm (Ju & Shambaugh 1994).
    JuShambaugh,
}

/// The drag laws and their constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drag {
    /// Law along the fibre.
    pub along: FrictionLaw,
    /// Law across the fibre.
    pub across: NormalLaw,
    /// `β` of the friction law [-]: 0.37 Matsui's own, 0.78 Majumdar & Shambaugh's, 0.9 for a single
    /// fibre in a tube.
    pub friction_coefficient: f64,
}

/// Exponent of the Reynolds number in [`FrictionLaw::Matsui`].
const MATSUI: f64 = 0.61;
/// Constants of [`NormalLaw::JuShambaugh`]: factor, exponents of Re and of d, reference diameter [m].
const JU_SHAMBAUGH: (f64, f64, f64, f64) = (6.96, 0.440, 0.404, 78e-6);

impl NormalLaw {
    /// Name in the case file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::JuShambaugh => "ju-shambaugh",
        }
    }

    /// The diameters the law was fitted to [m].
    pub const fn fitted_diameters(self) -> (f64, f64) {
        match self {
            Self::JuShambaugh => (13e-6, 390e-6),
        }
    }
}

impl Drag {
    /// Friction coefficient `C_f = β Re^-0.61` [-] along the fibre.           theory.md (2)
    ///
    /// * `re` – Reynolds number on diameter and tangential velocity [-], `re > 0`
    ///
    /// Source: Matsui 1976.
    pub fn tangential_coefficient(&self, re: f64) -> f64 {
        match self.along {
            FrictionLaw::Matsui => self.friction_coefficient * libm::pow(re, -MATSUI),
        }
    }

    /// Normal drag coefficient `C_n = 6.96 Re^-0.440 (d/d₀)^0.404`, `d₀ = 78 µm` [-].  theory.md (4)
    ///
    /// * `re` – Reynolds number on diameter and normal velocity [-], `re > 0`
    /// * `diameter` – [m], fitted for 13–390 µm
    ///
    /// Source: Ju & Shambaugh 1994.
    pub fn normal_coefficient(&self, re: f64, diameter: f64) -> f64 {
        let NormalLaw::JuShambaugh = self.across;
        let (a, b, c, d0) = JU_SHAMBAUGH;
        a * libm::pow(re, -b) * libm::pow(diameter / d0, c)
    }

    /// The laws as factors and exponents of the velocity, for the element of a fibre in air of
    /// `density` [kg/m³] and `viscosity` (kinematic) [m²/s].
    pub fn of_element(&self, fibre: &Fibre, density: f64, viscosity: f64) -> ElementDrag {
        let d = fibre.diameter;
        let l = fibre.rest_length();
        let re_per_velocity = d / viscosity;
        let pressure_area = 0.5 * density * d * l;
        let (_, b, _, _) = JU_SHAMBAUGH;
        ElementDrag {
            tangential: PI * pressure_area * self.tangential_coefficient(re_per_velocity),
            tangential_exponent: 1.0 - MATSUI,
            normal: pressure_area * self.normal_coefficient(re_per_velocity, d),
            normal_exponent: (1.0 - b) / 2.0,
        }
    }
}

/// Drag of one element as `F = c_t |V_t|^p V_t t + c_n (|V_n|²)^q V_n`.      theory.md (8)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementDrag {
    /// `c_t` [N/(m/s)^(1+p)].
    pub tangential: f64,
    /// `p` [-].
    pub tangential_exponent: f64,
    /// `c_n` [N/(m/s)^(1+2q)].
    pub normal: f64,
    /// `q` [-].
    pub normal_exponent: f64,
}

impl ElementDrag {
    /// Half of it: the share of each of the element's two nodes.
    pub(crate) fn half(self) -> Self {
        Self { tangential: 0.5 * self.tangential, normal: 0.5 * self.normal, ..self }
    }
}

/// [`ElementDrag`] of eight fibres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DragLanes {
    tangential: Lanes,
    tangential_exponent: Lanes,
    normal: Lanes,
    normal_exponent: Lanes,
}

impl DragLanes {
    /// Packs the element drag of each lane's fibre.
    pub fn pack(lanes: &[ElementDrag; crate::lanes::WIDTH]) -> Self {
        Self {
            tangential: Lanes::from_fn(|i| lanes[i].tangential),
            tangential_exponent: Lanes::from_fn(|i| lanes[i].tangential_exponent),
            normal: Lanes::from_fn(|i| lanes[i].normal),
            normal_exponent: Lanes::from_fn(|i| lanes[i].normal_exponent),
        }
    }

    /// What the powers of the law are taken of: the relative velocity along the element and across it.
    ///
    /// * `relative` – velocity of the air relative to the element's centre [m/s]
    /// * `tangent` – unit vector along the element
    #[inline(always)]
    pub(crate) fn split<S: Simd>(relative: Vec3<Wide<S>>, tangent: Vec3<Wide<S>>) -> Split<S> {
        let along = relative.dot(tangent);
        let across = tangent.neg_mul_add(along, relative);
        Split { along, across, powers: Wide([along.abs().0, across.dot(across).0]) }
    }

    /// Takes the two powers, `|V_t|^p` and `(|V_n|²)^q`.
    #[inline(always)]
    pub(crate) fn raise<S: Simd>(&self, split: &mut Split<S>) {
        let exponents = [S::load(&self.tangential_exponent), S::load(&self.normal_exponent)];
        split.powers = power(split.powers, Wide(exponents));
    }

    /// Force of the air on an element [N].                                   theory.md (8)
    #[inline(always)]
    pub(crate) fn force<S: Simd>(&self, split: &Split<S>, tangent: Vec3<Wide<S>>) -> Vec3<Wide<S>> {
        let [tangential, normal] = split.powers.0;
        let friction = Wide::load(&self.tangential) * split.along * Wide(tangential);
        split.across.mul_add(Wide::load(&self.normal) * Wide(normal), tangent * friction)
    }
}

/// A relative velocity along and across an element, on the way to its drag.
#[derive(Clone, Copy)]
pub(crate) struct Split<S: Simd> {
    along: Wide<S>,
    across: Vec3<Wide<S>>,
    /// `|V_t|` and `|V_n|²` abreast, then their powers.
    powers: Wide<[S; 2]>,
}

impl<S: Simd> Split<S> {
    #[inline(always)]
    pub(crate) fn none() -> Self {
        Self { along: Wide::zero(), across: Vec3::zero(), powers: Wide::zero() }
    }
}
