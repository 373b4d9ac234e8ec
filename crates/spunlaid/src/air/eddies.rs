//! How the turbulence varies along a fibre: which elements feel the same eddy.

/// How the turbulence at one place of the fibre is related to that at the next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum EddyModel {
    /// Eddies one length scale long, side by side along the fibre and independent of one another.
    /// theory.md (23)
    #[default]
    Independent,
    /// A pattern that the mean flow carries along the fibre (Taylor's hypothesis). Its correlation decays with
    /// `decay_time` [s]; infinite for a frozen pattern.                       theory.md (47)
    Convected {
        /// Time constant of the correlation of the carried pattern [s].
        decay_time: f64,
    },
}

impl EddyModel {
    /// Name in the case file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Convected { .. } => "convected",
        }
    }
}

/// The eddy of each element of a fibre.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Eddies {
    index_of_element: Vec<u32>,
    count: usize,
}

impl Eddies {
    /// Eddies of `length_scale` [m] along a fibre of `length` [m] with `elements`. An element belongs to the eddy
    /// that contains its centre, by arc length.                               theory.md (23)
    pub fn along(length: f64, elements: usize, length_scale: f64) -> Self {
        let size = length / elements as f64;
        // A centre on a border belongs to the next eddy, also when rounding puts it just before the border.
        Self::collect((0..elements).map(|j| ((j as f64 + 0.5) * size / length_scale + 1e-9).floor() as u32))
    }

    /// Eddies whose length is the length scale [m] at the arc length [m] where they begin, but at least one element.
    pub fn growing(length: f64, elements: usize, length_scale: impl Fn(f64) -> f64) -> Self {
        let size = length / elements as f64;
        let (mut eddy, mut end) = (0, length_scale(0.0).max(size));
        Self::collect((0..elements).map(|j| {
            if (j as f64 + 0.5) * size >= end * (1.0 - 1e-9) {
                (eddy, end) = (eddy + 1, end + length_scale(end).max(size));
            }
            eddy
        }))
    }

    /// One eddy for every element, for a pattern that is carried along the fibre.
    pub fn one_for_each(elements: usize) -> Self {
        Self::collect(0..elements as u32)
    }

    /// The same eddies along a fibre with fewer elements, each of which feels the one at its middle, or the one before.
    pub fn coarsen(&self, elements: usize) -> Self {
        let parts = self.index_of_element.len() / elements.max(1);
        if parts < 2 {
            return self.clone();
        }
        let middles = (0..elements).map(|j| self.index_of_element[j * parts + (parts - 1) / 2]);
        Self { index_of_element: middles.collect(), count: self.count }
    }

    fn collect(eddies: impl Iterator<Item = u32>) -> Self {
        let index_of_element: Vec<u32> = eddies.collect();
        let count = index_of_element.last().map_or(0, |&last| last as usize + 1);
        Self { index_of_element, count }
    }

    /// Index of the eddy of each element.
    pub fn index_of_element(&self) -> &[u32] {
        &self.index_of_element
    }

    /// Number of eddies.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Middle of each eddy, in elements from the root. An eddy without elements has the middle of the next one.
    pub fn middles(&self) -> Vec<f64> {
        let mut middles = vec![0.0; self.count];
        let mut first = 0;
        for (j, &eddy) in self.index_of_element.iter().enumerate() {
            if j > 0 && self.index_of_element[j - 1] != eddy {
                first = j;
            }
            middles[eddy as usize] = 0.5 * (first + j + 1) as f64;
        }
        for eddy in (0..self.count.saturating_sub(1)).rev() {
            if middles[eddy] == 0.0 {
                middles[eddy] = middles[eddy + 1];
            }
        }
        middles
    }
}
