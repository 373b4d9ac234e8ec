//! The difference of two means, and whether it is beyond chance.

use super::{Estimate, student_t_95};

/// The difference of two means with its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Second mean minus first mean.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Degrees of freedom of the error; they need not be whole.
    pub degrees: f64,
}

impl Difference {
    /// A difference that has nothing to do with chance.
    pub const fn exact(value: f64) -> Self {
        Self { value, standard_error: 0.0, degrees: f64::INFINITY }
    }

    /// Of two independent samples, which may have different variances (Welch's test).
    ///
    /// None if a sample has fewer than two finite values.
    ///
    /// Source: B. L. Welch, Biometrika 34 (1947) 28–35.
    pub fn independent(first: &[f64], second: &[f64]) -> Option<Self> {
        let sample = |values: &[f64]| {
            let finite: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
            let (free, estimate) = (finite.len() as f64 - 1.0, Estimate::new(finite));
            Some((estimate.mean, estimate.standard_error?.powi(2), free))
        };
        let (a, b) = (sample(first)?, sample(second)?);
        let variance = a.1 + b.1;
        let degrees = variance * variance / (a.1 * a.1 / a.2 + b.1 * b.1 / b.2);
        let degrees = if variance > 0.0 { degrees } else { a.2 + b.2 };
        Some(Self { value: b.0 - a.0, standard_error: variance.sqrt(), degrees })
    }

    /// Of two samples that belong together value by value. Pairs with a missing value and values without a partner are
    /// left out.
    ///
    /// None if there are fewer than two pairs.
    pub fn paired(first: &[f64], second: &[f64]) -> Option<Self> {
        let differences = first.iter().zip(second).map(|(a, b)| b - a).filter(|d| d.is_finite());
        let estimate = Estimate::new(differences.collect());
        let degrees = estimate.values.len() as f64 - 1.0;
        Some(Self { value: estimate.mean, standard_error: estimate.standard_error?, degrees })
    }

    /// Half the width of the 95 % confidence interval.
    pub fn half_width(&self) -> f64 {
        if self.standard_error == 0.0 { 0.0 } else { student_t_95_at(self.degrees) * self.standard_error }
    }

    /// [`Difference::half_width`]; None if the error is not known.
    pub fn known_half_width(&self) -> Option<f64> {
        Some(self.half_width()).filter(|half| half.is_finite())
    }

    /// Whether the 95 % confidence interval leaves out zero.
    pub fn is_significant(&self) -> bool {
        self.value.abs() > self.half_width()
    }

    /// Whether the confidence interval of this probability, as 0.95, leaves out zero. Degrees of freedom that are not
    /// whole count as fewer.
    pub fn is_beyond(&self, probability: f64) -> bool {
        let ratio = (self.value / self.standard_error).abs();
        let degrees = if self.degrees.is_nan() { 1.0 } else { self.degrees.clamp(1.0, MANY) };
        self.value != 0.0 && (self.standard_error == 0.0 || within(ratio, degrees as u32) > probability)
    }
}

/// Degrees of freedom from which on more of them change nothing.
const MANY: f64 = 10_000.0;

/// Probability that the size of Student's t is less.
///
/// Source: Abramowitz & Stegun 26.7.3 and 26.7.4.
fn within(t: f64, degrees: u32) -> f64 {
    let angle = libm::atan(t / f64::from(degrees).sqrt());
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    let is_odd = degrees % 2 == 1;
    // The powers of the cosine below the degrees of freedom, every second one.
    let (mut term, mut sum) = (if is_odd { cos } else { 1.0 }, 0.0);
    let mut power = degrees % 2;
    while power + 2 <= degrees {
        sum += term;
        let [above, below] = [power + 1, power + 2].map(f64::from);
        term *= cos * cos * above / below;
        power += 2;
    }
    if is_odd { std::f64::consts::FRAC_2_PI * (angle + sin * sum) } else { sin * sum }
}

/// The difference of two positive values, with the standard errors of their logarithms. The error of the difference is
/// made so that it says the same as that of the logarithms, and the same of the values, of their squares and of any
/// other powers.
pub fn difference_of_logarithms([first, second]: [f64; 2], log_errors: [f64; 2]) -> Difference {
    let log = libm::log(second / first);
    // The difference over that of the logarithms: a mean of both.
    let mean = if log.abs() > 1e-6 { (second - first) / log } else { 0.5 * (first + second) };
    let standard_error = mean * log_errors[0].hypot(log_errors[1]);
    Difference { value: second - first, standard_error, degrees: f64::INFINITY }
}

/// [`student_t_95`] for a number of degrees of freedom that need not be whole, linear in its reciprocal.
pub fn student_t_95_at(degrees: f64) -> f64 {
    let degrees = if degrees.is_nan() { 1.0 } else { degrees.clamp(1.0, 1e9) };
    let below = degrees.floor();
    let share = (1.0 / below - 1.0 / degrees) / (1.0 / below - 1.0 / (below + 1.0));
    let [a, b] = [below, below + 1.0].map(|degrees| student_t_95(degrees as u64));
    a + share * (b - a)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hours of sleep gained with two drugs: Student, Biometrika 6 (1908) 1–25.
    const FIRST: [f64; 10] = [0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0];
    const SECOND: [f64; 10] = [1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4];

    #[test]
    fn published_sleep_of_student() {
        // As R prints them for these data: t.test(extra ~ group) and with paired values. The table of t has six digits.
        let difference = Difference::independent(&FIRST, &SECOND).unwrap();
        assert!(
            (difference.value / difference.standard_error - 1.8608).abs() < 5e-5
                && (difference.degrees - 17.776).abs() < 5e-4
        );
        assert!(
            (difference.value + difference.half_width() - 3.3654832).abs() < 1e-4,
            "{}",
            difference.value + difference.half_width()
        );
        assert!(!difference.is_significant());
        let difference = Difference::paired(&FIRST, &SECOND).unwrap();
        assert!(
            (difference.value / difference.standard_error - 4.0621).abs() < 5e-5 && difference.degrees == 9.0
        );
        assert!(
            (difference.value - difference.half_width() - 0.7001142).abs() < 1e-5,
            "{}",
            difference.value - difference.half_width()
        );
        assert!(difference.is_significant());
    }

    #[test]
    fn published_quantiles_of_students_t() {
        for degrees in (1..40).chain([100, 10_000]) {
            let half = within(super::super::student_t_95(degrees), degrees as u32);
            assert!((half - 0.95).abs() < 2e-6, "{degrees}: {half}");
        }
        // Abramowitz & Stegun, table 26.10: 99 %.
        for (degrees, t) in [(1, 63.657), (2, 9.925), (5, 4.032), (15, 2.947), (60, 2.660)] {
            let half = within(t, degrees);
            assert!((half - 0.99).abs() < 2e-5, "{degrees}: {half}");
        }
        let difference = |ratio: f64| Difference { value: 0.5 * ratio, standard_error: 0.5, degrees: 15.5 };
        assert!(difference(-2.9).is_beyond(0.987) && !difference(2.6).is_beyond(0.987));
        assert!(Difference::exact(1e-9).is_beyond(0.987) && !Difference::exact(0.0).is_beyond(0.987));
        assert!(!difference(f64::NAN).is_beyond(0.987));
    }

    #[test]
    fn equal_samples_do_not_differ_and_missing_values_are_left_out() {
        let same = Difference::paired(&FIRST, &FIRST).unwrap();
        assert_eq!((same.value, same.half_width(), same.is_significant()), (0.0, 0.0, false));
        let mut with_gap = SECOND.to_vec();
        with_gap[3] = f64::NAN;
        let difference = Difference::paired(&FIRST, &with_gap).unwrap();
        assert_eq!(difference.degrees, 8.0);
        assert_eq!(Difference::independent(&[1.0], &SECOND), None);
        assert_eq!(Difference::paired(&[1.0, 2.0], &[1.0, f64::NAN]), None);
    }

    #[test]
    fn samples_without_scatter_have_no_error_but_degrees_of_freedom() {
        let difference = Difference::independent(&[1.0; 3], &[2.0; 2]).unwrap();
        assert_eq!(difference, Difference { value: 1.0, standard_error: 0.0, degrees: 3.0 });
        assert_eq!(difference.known_half_width(), Some(0.0));
        let known = Difference { standard_error: 0.5, ..Difference::exact(1.0) };
        assert_eq!(known.known_half_width(), Some(known.half_width()));
        assert_eq!(Difference { standard_error: f64::NAN, ..known }.known_half_width(), None);
    }

    /// The values, their squares and their logarithms differ by as many errors; nearly equal ones are no special case.
    #[test]
    fn invariant_the_difference_of_powers_is_as_significant_as_that_of_logarithms() {
        let errors = [0.03, 0.04];
        for (first, second) in [(2.0, 3.0), (3.0, 2.0), (2.0, 2.1)] {
            let in_errors = libm::log(second / first) / 0.05;
            for power in [1, 2] {
                let values = [first, second].map(|x: f64| x.powi(power));
                let found = difference_of_logarithms(values, errors.map(|error| f64::from(power) * error));
                assert_eq!(found.value, values[1] - values[0]);
                assert!((found.value / found.standard_error / in_errors - 1.0).abs() < 1e-12, "{found:?}");
            }
        }
        for second in [4.0, 4.0 + 1e-9] {
            let found = difference_of_logarithms([4.0, second], errors);
            assert!((found.standard_error / 0.2 - 1.0).abs() < 1e-9, "{found:?}");
        }
    }
}
