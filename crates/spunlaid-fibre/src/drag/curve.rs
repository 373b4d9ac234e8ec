//! Tables for the kernel of the drag laws that are not a power of the velocity.

use super::boundary_layer::BoundaryLayer;
use super::cubics::{CUBICS, Table};
use super::normal::{Form, NormalLaw};
use super::table::TableLaw;
use std::sync::{LazyLock, OnceLock};

/// A law as a positive function `g(s)` of one positive number [-]: the drag by the velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Curve {
    /// `1/α` over `s = V a²/(νx)`; moving through air at rest.                theory.md (43)
    Moving,
    /// `1/α` over `s = V a²/(νx)`; held in a stream.                          theory.md (43)
    Held,
    /// `½ s C_n(s)` over the Reynolds number `s` of a law across the fibre.   theory.md (45)
    Across(NormalLaw),
    /// `½ s C(s)` over the Reynolds number `s` of a law of a file, along or across the fibre.
    Table(TableLaw),
}

impl Curve {
    /// Whether `s` goes down with the distance from the root.
    pub(super) const fn fades(self) -> bool {
        matches!(self, Self::Moving | Self::Held)
    }

    /// `g(s)` itself, which the table of a named law follows to 1e-6.
    pub(crate) fn exact(self, s: f64) -> f64 {
        match self {
            Self::Moving => 1.0 / BoundaryLayer::Moving.thickness(1.0 / s),
            Self::Held => 1.0 / BoundaryLayer::Held.thickness(1.0 / s),
            Self::Across(law) => match law.form() {
                Form::Curve { resistance, .. } => resistance(s),
                Form::Power { coefficient, .. } => 0.5 * s * coefficient(s, 1.0),
                Form::Table(table) => 0.5 * s * table.coefficient(s),
            },
            Self::Table(table) => 0.5 * s * table.coefficient(s),
        }
    }

    pub(super) fn table(self) -> &'static Table {
        static MOVING: LazyLock<Table> = LazyLock::new(|| table_of(Curve::Moving));
        static HELD: LazyLock<Table> = LazyLock::new(|| table_of(Curve::Held));
        static ACROSS: [OnceLock<Table>; NormalLaw::ALL.len()] =
            [const { OnceLock::new() }; NormalLaw::ALL.len()];
        match self {
            Self::Moving => &MOVING,
            Self::Held => &HELD,
            Self::Table(law) | Self::Across(NormalLaw::Table(law)) => law.kernel(),
            Self::Across(law) => ACROSS[law.index()].get_or_init(|| table_of(self)),
        }
    }
}

/// The cubics of a law with a name.
fn table_of(curve: Curve) -> Table {
    let middle = CUBICS as f64 / 2.0 + 1.0;
    let joins = match curve {
        Curve::Across(law) => match law.form() {
            Form::Curve { joins, .. } => joins,
            Form::Power { .. } | Form::Table(_) => None,
        },
        Curve::Moving | Curve::Held | Curve::Table(_) => None,
    };
    let (per_unit, zero) = joins.map_or((1.0, middle), |(from, to)| {
        // Cubics end where the pieces of the law do.
        let [from, to] = [from, to].map(|s| 2.0 * libm::log2(s));
        let per_unit = (to - from).round() / (to - from);
        (per_unit, (middle + per_unit * from).round() - per_unit * from)
    });
    Table::of(per_unit, zero, 1.0 / 4096.0, |q| libm::log2(curve.exact(libm::exp2(0.5 * q))))
}

#[cfg(test)]
mod tests {
    use super::super::cubics::FURTHEST;
    use super::super::friction::FrictionLaw;
    use super::super::table::{DragTable, TableLaw};
    use super::{Curve, Form, NormalLaw};
    use spunlaid_air::FileContent;
    use spunlaid_ground::{Lanes, Plain, Register, Wide};
    use std::sync::Arc;

    /// Ends of the tables.
    const REACH: f64 = 63.0;
    fn curves() -> impl Iterator<Item = Curve> {
        let across = NormalLaw::ALL.into_iter().filter(|law| matches!(law.form(), Form::Curve { .. }));
        [Curve::Moving, Curve::Held].into_iter().chain(across.map(Curve::Across))
    }

    fn at(curve: Curve, q: f64) -> f64 {
        Register::store(curve.table().at::<Plain>(Wide::splat(q)).0).0[0]
    }

    /// Fourth derivative of `log2 g`, the largest of three at and beside `q`; large where pieces of a law meet.
    fn fourth(curve: Curve, q: f64) -> f64 {
        const STEP: f64 = 0.5;
        let log_g = |steps: f64| libm::log2(curve.exact(libm::exp2(0.5 * (q + steps * STEP))));
        let terms = [(-2.0, 1.0), (-1.0, -4.0), (0.0, 6.0), (1.0, -4.0), (2.0, 1.0)];
        let difference = |at: f64| terms.iter().map(|(step, factor)| factor * log_g(at + step)).sum::<f64>();
        [-2.0, 0.0, 2.0].map(|at| difference(at).abs() / STEP.powi(4)).into_iter().fold(0.0, f64::max)
    }

    #[test]
    fn analytic_table_follows_the_law() {
        // A cubic between values and slopes is off by g⁗/384 at most; 2^x is to 7.5e-8.
        for curve in curves() {
            for i in 0..=(2.0 * REACH * 37.0) as i32 {
                let q = f64::from(i) / 37.0 - REACH;
                let s = libm::exp2(0.5 * q);
                let error = at(curve, q) / curve.exact(s) - 1.0;
                assert!(error.abs() < fourth(curve, q) / 384.0 + 7.5e-8, "{curve:?} at {s}: {error:e}");
                assert!(error.abs() < 1e-6, "{curve:?} at {s}: {error:e}");
            }
        }
    }

    #[test]
    fn analytic_powers_beyond_the_table() {
        for curve in curves() {
            for sign in [1.0, -1.0] {
                let [a, b, c] = [1.0, 2.0, 3.0].map(|k| at(curve, sign * (REACH + 100.0 * k)));
                assert!((b * b / (a * c) - 1.0).abs() < 1e-6, "{curve:?}: {a} {b} {c}");
                assert_eq!(at(curve, sign * FURTHEST), at(curve, sign * 1e9));
                assert!(at(curve, sign * f64::INFINITY).is_finite());
            }
            // The drag grows faster than the velocity, and no faster than its square.
            for q in [-REACH, -1.0, 3.0, REACH] {
                let rise = at(curve, q + 0.5) / at(curve, q);
                assert!(rise > 1.0 && rise < f64::exp2(0.25) * (1.0 + 1e-6), "{curve:?} at {q}: {rise}");
            }
            assert!(at(curve, f64::NAN).is_finite());
        }
    }

    #[test]
    fn identical_lane_by_lane() {
        for curve in curves() {
            let q = Lanes::from_fn(|i| 7.3 * i as f64 - 30.0);
            let all = Register::store(curve.table().at::<Plain>(Wide::load(&q)).0);
            assert_eq!(all, Lanes::from_fn(|i| at(curve, q.0[i])));
        }
    }

    #[test]
    fn analytic_a_named_law_as_a_table_is_that_law() {
        let laws: [(&str, &dyn Fn(f64) -> f64); 3] = [
            ("matsui", &|re| FrictionLaw::ALL[0].coefficient(re, 1.0)),
            ("ju-shambaugh", &|re| NormalLaw::JuShambaugh.coefficient(re, 20e-6)),
            ("marheineke-wegener", &|re| NormalLaw::MarheinekeWegener.coefficient(re, 20e-6)),
        ];
        for (name, law) in laws {
            // So many rows to a decade, and the largest error that is asked for.
            for (per_decade, most) in [(2, 2e-2f64), (5, 1e-3), (20, 1e-4)] {
                let re: Vec<f64> = (0..=7 * per_decade)
                    .map(|i| libm::exp10(f64::from(i) / f64::from(per_decade) - 3.0))
                    .collect();
                let rows = DragTable::new(&re, &re.iter().map(|re| law(*re)).collect::<Vec<_>>());
                let stated = rows.change_without_every_second_row().unwrap() / 3.0;
                let table = Arc::new(rows);
                let curve = Curve::Table(TableLaw::new(FileContent::new(name.into(), 1, Arc::clone(&table))));
                for i in 0..7000 {
                    let re = libm::exp10(f64::from(i) / 1000.0 - 3.0);
                    let [error, in_kernel] =
                        [table.coefficient(re), 2.0 / re * at(curve, 2.0 * libm::log2(re))]
                            .map(|found| (found / law(re) - 1.0).abs());
                    assert!(
                        error <= most.min(stated + 1e-13),
                        "{name}, {per_decade} at {re}: {error}, stated {stated}"
                    );
                    // That of the cubics, of a fourteenth of a decade, on top of it.
                    assert!(in_kernel < most + 5e-5, "{name}, {per_decade} at {re}: {in_kernel}");
                }
            }
        }
    }
}
