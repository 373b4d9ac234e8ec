//! Drag laws along the fibre.

use super::boundary_layer::BoundaryLayer;
use super::curve::Curve;

/// Drag law along the fibre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrictionLaw {
    /// `C_f = β Re^-0.61`, for the turbulent boundary layer of a long cylinder (Matsui 1976).
    Matsui {
        /// `β` [-]: 0.37 in Matsui's own work, 0.9 for a single fibre in a tube.
        factor: f64,
    },
    /// `C_f = 0.78 Re^-0.61`, measured in melt-blowing air (Majumdar & Shambaugh 1990).
    MajumdarShambaugh,
    /// Laminar boundary layer of a fibre drawn through air at rest (Sakiadis 1961).
    Sakiadis,
    /// Laminar boundary layer of a fibre that is held in a stream (Glauert & Lighthill 1955).
    GlauertLighthill,
}

/// Exponent of the Reynolds number in Matsui's form.
const MATSUI: f64 = 0.61;
/// `β` of [`FrictionLaw::MajumdarShambaugh`] [-].
const MAJUMDAR_SHAMBAUGH: f64 = 0.78;

/// How the kernel computes a law.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    /// As a power of the velocity: `p` in `C_f ∝ Re^-p`, between 0 and 1 [-].
    Power(f64),
    /// From the table of a boundary layer.
    Layer(Curve),
}

impl FrictionLaw {
    /// Every law, Matsui's with the factor that the paper takes.
    pub const ALL: [Self; 4] =
        [Self::Matsui { factor: 0.9 }, Self::MajumdarShambaugh, Self::Sakiadis, Self::GlauertLighthill];

    /// Name in the case file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Matsui { .. } => "matsui",
            Self::MajumdarShambaugh => "majumdar-shambaugh",
            Self::Sakiadis => "sakiadis",
            Self::GlauertLighthill => "glauert-lighthill",
        }
    }

    /// `β` [-] of the law, if it is an input.
    pub const fn factor(self) -> Option<f64> {
        match self {
            Self::Matsui { factor } => Some(factor),
            Self::MajumdarShambaugh | Self::Sakiadis | Self::GlauertLighthill => None,
        }
    }

    pub(super) const fn form(self) -> Form {
        match self {
            Self::Matsui { .. } | Self::MajumdarShambaugh => Form::Power(MATSUI),
            Self::Sakiadis => Form::Layer(Curve::Moving),
            Self::GlauertLighthill => Form::Layer(Curve::Held),
        }
    }

    /// Friction coefficient `C_f` [-] along the fibre.
    ///
    /// `C_f = β Re^-0.61` by Matsui's form                                    theory.md (2),
    /// `C_f = 4/(Re α)` of a laminar boundary layer                           theory.md (41)
    ///
    /// * `re` – Reynolds number on diameter and tangential velocity [-], `re > 0`
    /// * `distance` – distance from the start of the boundary layer divided by the diameter [-], `distance > 0`; only
    ///   the laminar laws depend on it
    ///
    /// The Reynolds numbers to which Matsui's form was fitted are not known here. The laminar laws are theory for an
    /// undisturbed layer that begins at the root, for either direction of the air.
    ///
    /// Sources: Matsui 1976; Majumdar & Shambaugh 1990; Sakiadis 1961; Glauert & Lighthill 1955.
    pub fn coefficient(self, re: f64, distance: f64) -> f64 {
        let laminar = |layer: BoundaryLayer| 4.0 / (re * layer.thickness(4.0 * distance / re));
        match self {
            Self::Matsui { factor } => factor * libm::pow(re, -MATSUI),
            Self::MajumdarShambaugh => MAJUMDAR_SHAMBAUGH * libm::pow(re, -MATSUI),
            Self::Sakiadis => laminar(BoundaryLayer::Moving),
            Self::GlauertLighthill => laminar(BoundaryLayer::Held),
        }
    }
}
