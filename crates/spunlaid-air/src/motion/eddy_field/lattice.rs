//! The lattice on which a field is kept, across the way and in time.

use super::transform::ABREAST;
use std::f64::consts::{PI, TAU};

/// Share of the highest wave number that a lattice can carry.
const CARRIED: f64 = 0.8;
/// Points that are made beyond one that a fibre has come to.
const MARGIN: usize = 3;
/// Samples in the shortest period of a generation.
const SAMPLES_IN_PERIOD: usize = 4;

/// The distances after which a field repeats itself across the way [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Along y, the machine direction.
    pub y: f64,
    /// Along z, the cross direction.
    pub z: f64,
}

/// Successive points along an axis, after whose last the first one follows: all, or those near a fibre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Band {
    first: usize,
    pub(super) count: usize,
    /// Number of all.
    of: usize,
}

impl Band {
    /// The four points from one on, and a margin to either side.
    fn around(first: usize, margin: usize, of: usize) -> Self {
        let count = NEEDED + 2 * margin;
        if count >= of {
            Self { first: 0, count: of, of }
        } else {
            Self { first: (first + of - margin) % of, count, of }
        }
    }

    /// Where the first of four points lies in the band; none if one of them is not in it.
    #[inline(always)]
    pub(super) fn place(self, first: usize) -> Option<usize> {
        let place = if first < self.first { first + self.of - self.first } else { first - self.first };
        (self.count == self.of || place + NEEDED <= self.count).then_some(place)
    }

    /// The number of a point among all.
    pub(super) fn point(self, place: usize) -> usize {
        (self.first + place) % self.of
    }

    /// The band that also holds four points from one on, with a margin beyond them.
    fn widened(self, first: usize, margin: usize) -> Self {
        if self.place(first).is_some() {
            return self;
        }
        let Self { first: start, of, .. } = self;
        let up = (first + of - start) % of + NEEDED + margin;
        let down = (start + of - first) % of + margin;
        let (start, count) = if up - self.count.min(up) <= down {
            (start, up)
        } else {
            ((first + of - margin.min(of)) % of, self.count + down)
        };
        if count >= of { Self { first: 0, count: of, of } } else { Self { first: start, count, of } }
    }
}

/// The points of a field that are made, along y and z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Part(pub(super) [Band; 2]);

impl Part {
    /// Where four lines and four points of each lie in it.
    #[inline(always)]
    pub(super) fn place(&self, first: [usize; 2]) -> Option<[usize; 2]> {
        let Self([y, z]) = self;
        Some([y.place(first[0])?, z.place(first[1])?])
    }

    /// Number of points along y and z.
    pub(super) fn counts(&self) -> [usize; 2] {
        self.0.map(|band| band.count)
    }

    /// The part that also holds the points around a place, with a margin beyond them.
    pub(super) fn widened(&self, first: [usize; 2]) -> Self {
        let [y, z] = self.0;
        Self([y.widened(first[0], MARGIN), z.widened(first[1], MARGIN)])
    }
}

/// The points of a field across the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lattice {
    pub(super) extent: Extent,
    /// Number of points along y and z.
    pub(super) points: [usize; 2],
    /// Largest wave number across [1/m].
    pub(super) largest: f64,
}

impl Lattice {
    /// * `largest` – wave number across [1/m]; zero for a field that is the same everywhere across
    pub(super) fn new(extent: Extent, largest: f64) -> Self {
        let spacing = CARRIED * PI / largest;
        let points = [extent.y, extent.z].map(|extent| smooth((extent / spacing).ceil() as usize));
        Self { extent, points, largest }
    }

    /// Whether a field is the same everywhere across.
    pub(super) fn is_uniform(&self) -> bool {
        self.most_waves() == [0, 0]
    }

    /// The numbers of waves along z that go with a number of waves along y, from `-n` to `n`; none if the
    /// latter alone is too large.
    pub(super) fn waves_beside(&self, waves_y: i64) -> Option<i64> {
        let [y, z] = self.wave_number_units();
        let left = self.largest * self.largest - (waves_y as f64 * y).powi(2);
        (left >= 0.0).then(|| (left.sqrt() / z + 1e-9) as i64)
    }

    /// Most waves along y.
    pub(super) fn most_waves(&self) -> [i64; 2] {
        self.wave_number_units().map(|unit| (self.largest / unit + 1e-9) as i64)
    }

    /// Wave numbers of one wave along y and z [1/m].
    pub(super) fn wave_number_units(&self) -> [f64; 2] {
        [TAU / self.extent.y, TAU / self.extent.z]
    }

    /// The points within a distance [m] of the middle, or all.
    pub(super) fn part(&self, within: Option<f64>) -> Part {
        let margin = |of: usize, extent: f64| match within {
            Some(within) => (within * of as f64 / extent).ceil().min(of as f64) as usize + 1,
            None => of,
        };
        let [y, z] = self.points;
        let [of_y, of_z] = [margin(y, self.extent.y), margin(z, self.extent.z)];
        // As many points along z as are transformed together take no longer than one.
        let of_z = ((NEEDED + 2 * of_z).next_multiple_of(ABREAST) - NEEDED) / 2;
        Part([Band::around(y - BEFORE as usize, of_y, y), Band::around(z - BEFORE as usize, of_z, z)])
    }

    /// What the interpolation leaves of the rms of waves: along y, and along z.
    pub(super) fn left(&self, waves: [i64; 2]) -> f64 {
        let each = [0, 1].map(|axis| left(TAU * waves[axis] as f64 / self.points[axis] as f64));
        each[0] * each[1]
    }
}

/// Samples of a generation with so many harmonics in the time after which they repeat; a multiple of four.
pub(super) fn samples(harmonics: usize) -> usize {
    4 * smooth(harmonics * SAMPLES_IN_PERIOD / 4)
}

/// Rms that cubic B-splines leave of a wave of rms one, averaged over the phase.
///
/// * `turn` – phase from point to point [rad]
pub(super) fn left(turn: f64) -> f64 {
    let cos = |times: f64| libm::cos(times * turn);
    ((2416.0 + 2382.0 * cos(1.0) + 240.0 * cos(2.0) + 2.0 * cos(3.0)) / 5040.0).sqrt()
}

/// The smallest number without other factors than 2, 3 and 5 that is not below `least`, or `least` where that is too
/// large for a number. Such numbers lie far apart where they are large, so they are not sought one after the other.
fn smooth(least: usize) -> usize {
    let powers = |factor: usize| std::iter::successors(Some(1_usize), move |power| power.checked_mul(factor));
    let multiples = powers(3).flat_map(|three| powers(5).map_while(move |five| three.checked_mul(five)));
    let of_odd = |odd: usize| odd.checked_mul(least.div_ceil(odd).checked_next_power_of_two()?);
    multiples.filter_map(of_odd).min().unwrap_or(least)
}

/// Samples before a place that its interpolation needs, and all that it needs.
pub(super) const BEFORE: i64 = 1;
pub(super) const NEEDED: usize = 4;
/// Samples, or points, that a piece repeats of the one beside it, so that those around a place lie side by side.
pub(super) const REPEATED: usize = NEEDED - 1;
/// Points along z in a brick. In a row of all points the samples around a place would lie far apart in memory.
pub(super) const BRICK: usize = 32;
/// Numbers of a sample in a brick of a line of points, with the points that it repeats of the next one.
pub(super) fn row_size(points: usize) -> usize {
    3 * (BRICK.min(points) + REPEATED)
}
/// Numbers that are read for a sample: four points of three components, and what follows them.
pub(super) const READ: usize = 16;
/// Numbers in a line of a block. What follows the last point is read, but does not count.
pub(super) fn line_size(samples: usize, points: usize) -> usize {
    points.div_ceil(BRICK) * samples * row_size(points) + READ - 3 * NEEDED
}

#[cfg(test)]
mod tests {
    use super::smooth;

    /// A page that turned a knob very far waited for the next such number for minutes.
    #[test]
    fn analytic_smooth_numbers_are_the_next_products_of_two_three_and_five() {
        let without = |mut number: usize, factor: usize| {
            while number.is_multiple_of(factor) {
                number /= factor;
            }
            number
        };
        let is_smooth = |number: &usize| [2, 3, 5].into_iter().fold(*number, without) == 1;
        for least in 1..2000 {
            assert_eq!(Some(smooth(least)), (least..).find(is_smooth), "{least}");
        }
        assert_eq!([0, (1 << 62) + 1].map(smooth)[0], 1);
        // Numbers as large have such a neighbour within 1 %.
        let large = smooth((1 << 62) + 1);
        assert!(large > 1 << 62 && (large as f64) < 1.01 * 2_f64.powi(62), "{large}");
    }
}
