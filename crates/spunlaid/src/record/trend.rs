//! How a quantity changes over a record.

use super::Interval;
use crate::statistics::student_t_95;

/// Change of a quantity over the record, by a straight line through its values in the blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trend {
    /// From the start of the record to its end, with its 95 % interval [m/s].
    pub change: Interval,
    /// Whether the change is more than 3.5 standard errors.
    pub significant: bool,
}

impl Trend {
    /// The trend of a quantity, given its value in each block.
    pub(super) fn new(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let place = |i: usize| (i as f64 + 0.5) / count - 0.5;
        let spread: f64 = (0..values.len()).map(|i| place(i) * place(i)).sum();
        let change = values.iter().enumerate().map(|(i, y)| place(i) * y).sum::<f64>() / spread;
        let residual = |(i, y): (usize, &f64)| y - mean - change * place(i);
        let squares: f64 = values.iter().enumerate().map(|pair| residual(pair).powi(2)).sum();
        let error = (squares / (count - 2.0) / spread).sqrt();
        let half = student_t_95((values.len() as u64).saturating_sub(2)) * error;
        Self {
            change: Interval { value: change, low: change - half, high: change + half },
            significant: change.abs() > 3.5 * error,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_trend_of_a_straight_line() {
        let values: Vec<f64> = (0..10).map(|i| 3.0 + 0.2 * f64::from(i)).collect();
        let trend = Trend::new(&values);
        assert!((trend.change.value - 2.0).abs() < 1e-12 && trend.significant);
        assert!(!Trend::new(&[1.0, 2.0, 1.0, 2.0, 1.0, 2.0, 1.0, 2.0]).significant);
    }
}
