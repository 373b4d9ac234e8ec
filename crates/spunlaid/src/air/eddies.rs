//! Which eddy an element lies in.

/// Eddies of one length side by side along a fibre.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Eddies {
    of_element: Vec<u32>,
    count: usize,
}

impl Eddies {
    /// Eddies of `length_scale` [m] along a fibre of `length` [m] cut into `elements`: an element lies in
    /// the eddy that its centre lies in, by arc length.                       theory.md (23)
    pub fn along(length: f64, elements: usize, length_scale: f64) -> Self {
        let size = length / elements as f64;
        let of_element: Vec<u32> = (0..elements)
            // A centre on a border, but for rounding, belongs to the eddy below it.
            .map(|j| ((j as f64 + 0.5) * size / length_scale + 1e-9).floor() as u32)
            .collect();
        let count = of_element.last().map_or(0, |&last| last as usize + 1);
        Self { of_element, count }
    }

    /// Index of the eddy of each element.
    pub fn of_element(&self) -> &[u32] {
        &self.of_element
    }

    /// Number of eddies.
    pub const fn count(&self) -> usize {
        self.count
    }
}
