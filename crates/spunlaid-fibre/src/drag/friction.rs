//! Drag laws along the fibre.

use super::Source;
use super::boundary_layer::BoundaryLayer;
use super::curve::Curve;
use super::table::TableLaw;

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
    /// Coefficients over the Reynolds number from a file.
    Table(TableLaw),
}

/// Exponent of the Reynolds number in Matsui's form.
const MATSUI: f64 = 0.61;

/// What is known of a law.
struct Law {
    /// Name in the case file.
    name: &'static str,
    /// Where it was published.
    source: Source,
    /// `β` [-] of the law, if it is an input.
    input: Option<f64>,
    form: Form,
}

/// How the kernel computes a law.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    /// `C_f = factor Re^-exponent`, as a power of the velocity.
    Power {
        /// Between 0 and 1 [-].
        exponent: f64,
        factor: f64,
    },
    /// From the table of a boundary layer.
    Layer(BoundaryLayer, Curve),
    /// From the table of a file.
    Table(TableLaw),
}

impl FrictionLaw {
    /// Every law with a name, Matsui's with the factor that the paper takes.
    pub const ALL: [Self; 4] =
        [Self::Matsui { factor: 0.9 }, Self::MajumdarShambaugh, Self::Sakiadis, Self::GlauertLighthill];

    fn law(self) -> Law {
        match self {
            Self::Matsui { factor } => Law {
                name: "matsui",
                source: Source {
                    short: "Matsui 1976",
                    full: "M. Matsui: Air drag on a continuous filament in melt spinning. Transactions of \
                        the Society of Rheology 20(3), 465–473, 1976.",
                },
                input: Some(factor),
                form: Form::Power { exponent: MATSUI, factor },
            },
            Self::MajumdarShambaugh => Law {
                name: "majumdar-shambaugh",
                source: Source {
                    short: "Majumdar and Shambaugh 1990",
                    full: "B. Majumdar, R. L. Shambaugh: Air drag on filaments in the melt blowing process. \
                        Journal of Rheology 34(4), 591–601, 1990.",
                },
                input: None,
                form: Form::Power { exponent: MATSUI, factor: 0.78 },
            },
            Self::Sakiadis => Law {
                name: "sakiadis",
                source: Source {
                    short: "Sakiadis 1961",
                    full: "B. C. Sakiadis: Boundary-layer behavior on continuous solid surfaces: III. The \
                        boundary layer on a continuous cylindrical surface. AIChE Journal 7(3), 467–472, \
                        1961.",
                },
                input: None,
                form: Form::Layer(BoundaryLayer::Moving, Curve::Moving),
            },
            Self::GlauertLighthill => Law {
                name: "glauert-lighthill",
                source: Source {
                    short: "Glauert and Lighthill 1955",
                    full: "M. B. Glauert, M. J. Lighthill: The axisymmetric boundary layer on a long thin \
                        cylinder. Proceedings of the Royal Society A 230, 188–203, 1955.",
                },
                input: None,
                form: Form::Layer(BoundaryLayer::Held, Curve::Held),
            },
            Self::Table(table) => {
                Law { name: table.name(), source: table.source(), input: None, form: Form::Table(table) }
            }
        }
    }

    /// Name in the case file; of a table the name of its file.
    pub fn name(self) -> &'static str {
        self.law().name
    }

    /// Where it was published.
    pub fn source(self) -> Source {
        self.law().source
    }

    /// `β` [-] of the law, if it is an input.
    pub fn factor(self) -> Option<f64> {
        self.law().input
    }

    pub(super) fn form(self) -> Form {
        self.law().form
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
    pub fn coefficient(self, re: f64, distance: f64) -> f64 {
        match self.form() {
            Form::Power { exponent, factor } => factor * libm::pow(re, -exponent),
            Form::Table(table) => table.coefficient(re),
            Form::Layer(layer, _) => 4.0 / (re * layer.thickness(4.0 * distance / re)),
        }
    }
}
