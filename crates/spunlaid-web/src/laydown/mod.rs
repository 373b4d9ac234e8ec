//! A laid fibre as a curve on the belt: what its points say about the laydown.
//!
//! A [`Trace`] takes the points of one fibre in the order of feed and keeps sums only, so its memory does not grow
//! with the length of the fibre.

mod trace;

pub use trace::{LaidCurve, Trace, TraceSettings};

use spunlaid_ground::{Isa, Register, Task};

/// Cells along each side of a footprint.
const CELLS: usize = 96;

/// How often a fibre was found in each cell of a square lattice.
///
/// A point outside the lattice doubles the width of the cells, four of which become one. Widths are powers of two
/// times the first one and cells are counted from one centre, so the counts are those that the final lattice
/// would have found from the start.
#[derive(Clone, Debug, PartialEq)]
pub struct Footprint {
    /// Length of a cell's side [m].
    pub cell: f64,
    /// Position of the lattice's centre, a corner of four cells: machine and cross direction [m].
    pub centre: [f64; 2],
    /// Points in each cell, `[cross direction][machine direction]`, from the smallest coordinates on.
    counts: Vec<u64>,
}

impl Footprint {
    /// An empty lattice.
    ///
    /// * `cell` – side of its cells to begin with [m]
    /// * `centre` – its centre [m]
    fn new(cell: f64, centre: [f64; 2]) -> Self {
        Self { cell, centre, counts: vec![0; CELLS * CELLS] }
    }

    /// Points in each row of cells, row after row in cross direction; within a row in machine direction.
    pub fn rows(&self) -> impl Iterator<Item = &[u64]> {
        self.counts.chunks_exact(CELLS)
    }

    /// The smallest coordinates that the lattice covers: machine and cross direction [m].
    pub fn corner(&self) -> [f64; 2] {
        self.centre.map(|centre| centre - (CELLS / 2) as f64 * self.cell)
    }

    /// Counts a point; points that are not finite are left out.
    fn add(&mut self, point: [f64; 2]) {
        let offset = [point[0] - self.centre[0], point[1] - self.centre[1]];
        if !(offset[0].is_finite() && offset[1].is_finite()) {
            return;
        }
        let place = loop {
            let index = offset.map(|offset| (offset / self.cell).floor() + (CELLS / 2) as f64);
            if index.iter().all(|index| (0.0..CELLS as f64).contains(index)) {
                break index[1] as usize * CELLS + index[0] as usize;
            }
            self.grow();
        };
        self.counts[place] += 1;
    }

    fn grow(&mut self) {
        let quarter = CELLS / 4;
        let mut coarse = vec![0; CELLS * CELLS];
        for (place, count) in self.counts.iter().enumerate() {
            let (row, column) = (place / CELLS, place % CELLS);
            coarse[(quarter + row / 2) * CELLS + quarter + column / 2] += count;
        }
        self.counts = coarse;
        self.cell *= 2.0;
    }
}

/// Sums of lagged products of a series, about a reference near its mean.
///
/// Lags are multiples of `stride` samples. Samples that lie a multiple of `stride` apart form one of `stride`
/// interleaved series; each keeps its last `lags` samples.
#[derive(Clone, Debug)]
struct LaggedProducts {
    isa: Isa,
    stride: usize,
    /// Number of lags, lag zero included.
    lags: usize,
    reference: f64,
    count: u64,
    sum: f64,
    products: Vec<f64>,
    /// Sum of the first `k·stride` samples, for each lag `k` reached so far.
    first: Vec<f64>,
    recent: Vec<Recent>,
}

/// The last samples of a series, the newest first.
#[derive(Clone, Debug)]
struct Recent {
    /// Every sample stands at two places, so that the last ones always lie in a row.
    twice: Vec<f64>,
    newest: usize,
}

impl Recent {
    fn new(lags: usize) -> Self {
        Self { twice: vec![0.0; 2 * lags], newest: 0 }
    }

    fn push(&mut self, x: f64) -> &[f64] {
        let lags = self.twice.len() / 2;
        self.newest = (self.newest + lags - 1) % lags;
        self.twice[self.newest] = x;
        self.twice[self.newest + lags] = x;
        self.samples()
    }

    fn samples(&self) -> &[f64] {
        &self.twice[self.newest..self.newest + self.twice.len() / 2]
    }
}

/// Adds the products of a sample with those before it.
struct AddProducts<'a> {
    x: f64,
    recent: &'a [f64],
    products: &'a mut [f64],
}

impl Task for AddProducts<'_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        for (product, before) in self.products.iter_mut().zip(self.recent) {
            *product += self.x * before;
        }
    }
}

impl LaggedProducts {
    /// * `stride` – samples from one lag to the next, one or more
    /// * `lags` – number of lags, lag zero included, one or more
    fn new(stride: usize, lags: usize) -> Self {
        Self {
            isa: Isa::detect(),
            stride,
            lags,
            reference: 0.0,
            count: 0,
            sum: 0.0,
            products: vec![0.0; lags],
            first: vec![0.0],
            recent: vec![Recent::new(lags); stride],
        }
    }

    fn add(&mut self, value: f64) {
        if self.count == 0 {
            self.reference = value;
        }
        let x = value - self.reference;
        // Places that no sample has taken yet are zero and add nothing.
        let recent = self.recent[(self.count % self.stride as u64) as usize].push(x);
        self.isa.run(AddProducts { x, recent, products: &mut self.products });
        self.sum += x;
        self.count += 1;
        if self.count.is_multiple_of(self.stride as u64) && self.first.len() < self.lags {
            self.first.push(self.sum);
        }
    }

    /// Samples from one lag to the next.
    const fn stride(&self) -> usize {
        self.stride
    }

    /// Number of samples.
    const fn count(&self) -> u64 {
        self.count
    }

    /// Mean; NaN without samples.
    fn mean(&self) -> f64 {
        self.reference + self.sum / self.count as f64
    }

    /// `⟨(x_i − x̄)(x_{i+k} − x̄)⟩` for each lag that has a pair, divided by the number of pairs; x̄ is the
    /// mean of all samples.
    fn covariances(&self) -> Vec<f64> {
        let n = self.count as f64;
        let mean = self.sum / n;
        let mut last = 0.0;
        let pairs =
            |lag: usize| self.count.checked_sub((lag * self.stride) as u64).filter(|pairs| *pairs > 0);
        (0..self.lags)
            .map_while(|lag| {
                let pairs = pairs(lag)? as f64;
                let covariance = (self.products[lag] - mean * (2.0 * self.sum - last - self.first[lag]))
                    / pairs
                    + mean * mean;
                last += self.recent.iter().map(|recent| recent.samples()[lag]).sum::<f64>();
                Some(covariance)
            })
            .collect()
    }
}

/// The lag at which an autocorrelation first falls to ½, by linear interpolation, in steps of the lag; NaN if
/// it does not.
fn half_lag(coefficients: &[f64]) -> f64 {
    let at = coefficients.windows(2).position(|pair| pair[1] <= 0.5);
    at.map_or(f64::NAN, |at| {
        let (above, below) = (coefficients[at], coefficients[at + 1]);
        at as f64 + (above - 0.5) / (above - below)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_do_not_depend_on_when_the_lattice_grew() {
        let point = |i: u32| {
            let a = f64::from(i * 7919 % 1009) - 500.0;
            let b = f64::from(i * 104_729 % 997) - 300.0;
            [1.0 + a * 1e-3, -2.0 + b * 1e-3]
        };
        let mut grown = Footprint::new(0.001, [1.0, -2.0]);
        (0..5000).for_each(|i| grown.add(point(i)));
        // 0.697 m to one side need 48 cells of 16 mm.
        assert!((grown.cell - 0.016).abs() < 1e-15);
        let mut at_once = Footprint::new(grown.cell, [1.0, -2.0]);
        (0..5000).for_each(|i| at_once.add(point(i)));
        assert_eq!(grown, at_once);
        assert_eq!(grown.rows().flatten().sum::<u64>(), 5000);
        let corner = grown.corner();
        assert!((corner[0] - (1.0 - 48.0 * 0.016)).abs() < 1e-12 && grown.rows().count() == CELLS);
    }

    #[test]
    fn a_point_lies_in_its_cell_and_points_beyond_number_are_left_out() {
        let mut footprint = Footprint::new(1.0, [0.0, 0.0]);
        footprint.add([-0.5, 3.2]);
        footprint.add([f64::NAN, 0.0]);
        footprint.add([0.0, f64::INFINITY]);
        let found: Vec<(usize, usize)> = (footprint.rows().enumerate())
            .flat_map(|(row, counts)| counts.iter().enumerate().filter(|c| *c.1 > 0).map(move |c| (row, c.0)))
            .collect();
        assert_eq!(found, [(51, 47)]);
    }
}

#[cfg(test)]
mod correlation_tests {
    use super::*;

    #[test]
    fn analytic_covariances_are_those_of_the_stored_series() {
        let values: Vec<f64> = (0..997).map(|i| 3.0 + f64::from(i * i % 101) * 0.01).collect();
        for (stride, lags) in [(1, 1), (1, 40), (3, 40), (7, 300)] {
            for n in [1, 2, 20, 300, 997] {
                let mut sums = LaggedProducts::new(stride, lags);
                values[..n].iter().for_each(|x| sums.add(*x));
                let mean = values[..n].iter().sum::<f64>() / n as f64;
                assert!((sums.mean() - mean).abs() < 1e-13 && sums.count() == n as u64);
                let found = sums.covariances();
                assert_eq!(found.len(), lags.min((n - 1) / stride + 1), "{stride} {lags} {n}");
                for (lag, found) in found.iter().enumerate() {
                    let pairs = n - lag * stride;
                    let product = |i: usize| (values[i] - mean) * (values[i + lag * stride] - mean);
                    let wanted = (0..pairs).map(product).sum::<f64>() / pairs as f64;
                    // Rounding of a few hundred sums of numbers near 1.
                    assert!(
                        (found - wanted).abs() < 1e-12,
                        "{stride} {lags} {n} at {lag}: {found}, {wanted}"
                    );
                }
            }
        }
    }

    #[test]
    fn half_lag_is_interpolated() {
        assert!((half_lag(&[1.0, 0.8, 0.4, 0.6, 0.1]) - 1.75).abs() < 1e-14);
        assert_eq!(half_lag(&[1.0, 0.5]), 1.0);
        assert!(
            half_lag(&[1.0, 0.8]).is_nan() && half_lag(&[]).is_nan() && half_lag(&[f64::NAN; 3]).is_nan()
        );
    }
}
