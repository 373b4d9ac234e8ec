//! Laws of the drag across the fibre: each is a file of this folder and a line in the list.

use super::Source;
use super::table::TableLaw;
use std::ops::RangeInclusive;

mod ju_shambaugh;
mod marheineke_wegener;

macro_rules! laws {
    ($($(#[$doc:meta])* $law:ident = $file:ident,)+) => {
        /// Law of the drag across the fibre.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum NormalLaw {
            $($(#[$doc])* $law,)+
            /// Coefficients over the Reynolds number from a file.
            Table(TableLaw),
        }

        impl NormalLaw {
            /// Every law with a name.
            pub const ALL: [Self; [$($file::LAW.name),+].len()] = [$(Self::$law),+];

            fn law(self) -> Law {
                match self {
                    $(Self::$law => $file::LAW,)+
                    Self::Table(table) => Law {
                        name: table.name(),
                        source: table.source(),
                        fitted_diameters: None,
                        fitted_reynolds: Some(table.reynolds()),
                        form: Form::Table(table),
                    },
                }
            }

            /// Its place among the laws with names; a table comes behind them.
            pub(super) const fn index(self) -> usize {
                enum Place { $($law,)+ Table }
                match self {
                    $(Self::$law => Place::$law as usize,)+
                    Self::Table(_) => Place::Table as usize,
                }
            }
        }
    };
}

laws! {
    /// `C_n = 6.96 Re^-0.440 (d/78 µm)^0.404`, fitted for 13–390 µm (Ju & Shambaugh 1994).
    JuShambaugh = ju_shambaugh,
    /// Theory of slow flow, measurements of cylinders and boundary layers in one law of the Reynolds number
    /// (Marheineke & Wegener 2011).
    MarheinekeWegener = marheineke_wegener,
}

/// What the file of a law says.
#[derive(Debug)]
struct Law {
    /// Name in the case file.
    name: &'static str,
    /// Where it was published.
    source: Source,
    /// The diameters it was fitted to [m]; none if it depends on the Reynolds number alone.
    fitted_diameters: Option<RangeInclusive<f64>>,
    /// The Reynolds numbers it holds for [-], if they are known.
    fitted_reynolds: Option<RangeInclusive<f64>>,
    form: Form,
}

/// How the kernel computes a law.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    /// As a power of the velocity.
    Power {
        /// `p` in `C_n ∝ Re^-p`, between 0 and 1 [-].
        exponent: f64,
        /// `C_n` [-] from the Reynolds number [-] and the diameter [m].
        coefficient: fn(f64, f64) -> f64,
    },
    /// From a table that is made of the law.
    Curve {
        /// `½ Re C_n` [-] from the Reynolds number [-].
        resistance: fn(f64) -> f64,
        /// The two Reynolds numbers at which the pieces of the law meet, if it has pieces.
        joins: Option<(f64, f64)>,
    },
    /// From the table of a file.
    Table(TableLaw),
}

impl NormalLaw {
    /// Name in the case file; of a table the name of its file.
    pub fn name(self) -> &'static str {
        self.law().name
    }

    /// Where it was published.
    pub fn source(self) -> Source {
        self.law().source
    }

    /// The diameters the law was fitted to [m]; none if it depends on the Reynolds number alone.
    pub(crate) fn fitted_diameters(self) -> Option<RangeInclusive<f64>> {
        self.law().fitted_diameters
    }

    /// The Reynolds numbers the law holds for [-], if they are known.
    pub(crate) fn fitted_reynolds(self) -> Option<RangeInclusive<f64>> {
        self.law().fitted_reynolds
    }

    pub(super) fn form(self) -> Form {
        self.law().form
    }

    /// Normal drag coefficient `C_n` [-].
    ///
    /// * `re` – Reynolds number on diameter and normal velocity [-], `re > 0`
    /// * `diameter` – [m]; some laws do not depend on it
    pub fn coefficient(self, re: f64, diameter: f64) -> f64 {
        match self.form() {
            Form::Power { coefficient, .. } => coefficient(re, diameter),
            Form::Curve { resistance, .. } => 2.0 * resistance(re) / re,
            Form::Table(table) => table.coefficient(re),
        }
    }
}
