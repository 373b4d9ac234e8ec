//! A key whose value is sought.

use spunlaid_fibre::case::keys::VariedKey;

/// A key whose value is sought, with the range in which it may lie.
///
/// The search moves in a coordinate in which steps are of like size everywhere: the logarithm of a value that
/// is above zero in all of its range, otherwise the value over half of its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// The key.
    pub key: VariedKey,
    /// The value from which the search starts [SI].
    pub start: f64,
    /// Least and greatest value [SI].
    pub range: [f64; 2],
}

/// Without a range, a value may be so many times smaller or larger than at the start.
pub const USUAL_FACTOR: f64 = 5.0;

impl Parameter {
    /// Whether the search moves in the logarithm of its value.
    pub fn is_logarithmic(&self) -> bool {
        self.range[0] > 0.0
    }

    /// The coordinate of a value.
    pub(super) fn coordinate(&self, value: f64) -> f64 {
        if self.is_logarithmic() { libm::log(value) } else { value / self.half_range() }
    }

    /// The value at a coordinate, within the range [SI].
    pub(super) fn value(&self, coordinate: f64) -> f64 {
        let value =
            if self.is_logarithmic() { libm::exp(coordinate) } else { coordinate * self.half_range() };
        let value = if self.key.is_whole() { value.round() } else { value };
        value.clamp(self.range[0], self.range[1])
    }

    /// The coordinate of the value at a coordinate: another one where the value is a whole number, or beyond the range.
    pub(super) fn taken(&self, coordinate: f64) -> f64 {
        let [low, high] = self.ends();
        if self.key.is_whole() {
            self.coordinate(self.value(coordinate))
        } else {
            coordinate.clamp(low, high)
        }
    }

    /// The shortest step that changes the value at a coordinate.
    pub(super) fn shortest_step(&self, coordinate: f64) -> f64 {
        let value = self.value(coordinate);
        if self.key.is_whole() { self.coordinate(value + 1.0) - self.coordinate(value) } else { 0.0 }
    }

    /// The ends of the range as coordinates.
    pub(super) fn ends(&self) -> [f64; 2] {
        self.range.map(|end| self.coordinate(end))
    }

    fn half_range(&self) -> f64 {
        0.5 * (self.range[1] - self.range[0])
    }
}
