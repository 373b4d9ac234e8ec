//! How uneven a web is: the coefficient of variation of its basis weight over square patches.

use super::basis_weight::Map;
use super::waves::{FEWEST, Parts, Places, Powers};
use spunlaid_ground::statistics::{interval_of_deviation, interval_of_deviation_by, student_t_95_at};

/// The CV over patches of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchCv {
    /// Side of the square patches [m].
    pub patch: f64,
    /// Standard deviation of the basis weight of patches over its mean.
    pub cv: f64,
    /// Standard error of `cv`; none if the sheet is too small to say. It is a share of `cv` that depends on
    /// the size of the sheet and of its clouds.
    pub standard_error: Option<f64>,
}

impl PatchCv {
    /// The 95 % confidence interval of the CV of all such webs; none if the sheet is too small to say.
    pub fn interval(&self) -> Option<[f64; 2]> {
        Some(interval_of_deviation(self.cv, self.standard_error?))
    }

    /// [`PatchCv::interval`] where the waves that make the CV are few, so that their own powers say only
    /// roughly how much they scatter, as in a web whose filaments share one air: by Student's t with the
    /// degrees of freedom of the CV.
    pub(crate) fn interval_of_few(&self) -> Option<[f64; 2]> {
        let quantile = student_t_95_at(self.degrees()?);
        Some(interval_of_deviation_by(quantile, self.cv, self.standard_error?))
    }

    /// Degrees of freedom of the CV: so many independent patches would give as much. None if the sheet is too
    /// small to say.
    pub(crate) fn degrees(&self) -> Option<f64> {
        Some(0.5 * (self.cv / self.standard_error?).powi(2))
    }
}

/// A variance is given with an error only if it has at least this many degrees of freedom: the number of
/// independent values that would give as much.
pub(super) const DEGREES: f64 = 5.0;
/// Places of a patch each way whose waves are looked at, and the most of them: so many that patches of the
/// next places overlap by half. Waves between farther places would pass for longer ones, of which there are
/// fewer, so that the error would be too large.
const WAVES: usize = 512;
const MOST_WAVES: usize = 2048;
/// Size of the patches that the eye judges first [m].
const SEEN: f64 = 10e-3;

/// Which of the sides of patches [m] is nearest to what the eye judges first.
pub fn nearest_to_seen(patches: impl Iterator<Item = f64>) -> Option<usize> {
    let far = |patch: f64| libm::log(patch / SEEN).abs();
    patches.map(far).enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map(|(number, _)| number)
}

/// [`unevenness_at`] of filaments at places of which nothing is known.
pub fn patch_cv(map: &Map, side: usize) -> Option<PatchCv> {
    unevenness_at(map, side, &Places::Unknown)
}

/// The coefficient of variation over patches of one side, at every place of the patch on the lattice of cells.
///
/// The variance is a sum over waves. For many independent filaments the basis weight is a normal field, whose waves are
/// independent, each with a power that scatters by as much as its mean; so the powers themselves say how much their sum
/// scatters between webs. (theory.md, "Chance in a map".) On a sheet that is not closed, the mean is known
/// from the sheet only; the variance is larger by that of the mean.
///
/// * `side` – of a patch [cells], at least one and within the sheet; None otherwise, and without any fibre
/// * `places` – what is known of the places of the filaments
pub fn unevenness_at(map: &Map, side: usize, places_of_filaments: &Places) -> Option<PatchCv> {
    let (squares, powers) = deviations(map, side)?;
    let of_mean = match places_of_filaments {
        Places::Unknown => powers.as_ref().map_or(0.0, |powers| powers.variance_of_mean(map.closed)),
        Places::Known(streaks) => streaks.variance_of_mean,
    };
    let cv = (squares + of_mean).sqrt();
    let error = powers.and_then(|powers| {
        let mut parts = Parts::default();
        let places = match places_of_filaments {
            Places::Known(streaks) => Places::Known(streaks.over(side as f64 / map.columns as f64)),
            Places::Unknown => Places::Unknown,
        };
        powers.numbers().for_each(|wave| powers.add(wave, &places, 0, 1.0, &mut parts));
        let share = parts.share([false; 2]);
        (share > 0.0 && 2.0 / share >= DEGREES).then(|| 0.5 * cv * share.sqrt())
    });
    Some(PatchCv {
        patch: side as f64 * map.cell,
        cv,
        standard_error: error.filter(|error| error.is_finite()),
    })
}

/// Variance of the mean basis weight of a part of a sheet between its edges, over its square; zero of a whole sheet
/// that is closed to a ring.
///
/// A filament lays all its fibre on the sheet, so the mean varies with what crosses the two edges of the part. What
/// has crossed a place is the mass up to it less that of an even web. For filaments at random places that is a
/// random walk from edge to edge, of a third of the variance that their number gives the mean.    theory.md (103b)
///
/// The ends of a sheet that is no ring along the machine cut clouds: the power of the longest waves along it.
///
/// * `side` – of the patches whose waves are looked at [cells]
/// * `share` – of the sheet's width
/// * `places` – of the filaments
pub fn variance_of_mean(map: &Map, side: usize, share: f64, places: &Places) -> f64 {
    let waves = if map.closed[1] { None } else { deviations(map, side).and_then(|(_, powers)| powers) };
    let ends = waves.map_or(0.0, |powers| powers.variance_of_mean([true, false]));
    if map.closed[0] {
        return ends;
    }
    let (profile, mean) = (map.profile_cd(), map.basis_weight());
    let mut up_to = 0.0;
    let (sum, squares) = profile.iter().fold((0.0, 0.0), |(sum, squares), weight| {
        up_to += (weight / mean - 1.0) / profile.len() as f64;
        (sum + up_to, squares + up_to * up_to)
    });
    let crossed = 2.0 * (squares - sum * sum / profile.len() as f64) / profile.len() as f64;
    let by_number = match places {
        Places::Known(streaks) => streaks.variance_of_mean,
        Places::Unknown => 0.0,
    };
    ends + by_number * (1.0 - share).max(0.0) + (crossed - by_number / 3.0).max(0.0)
}

/// The mean square of the deviations of the patches of one side from the mean, over it, and the powers of their
/// waves, if they are enough.
fn deviations(map: &Map, side: usize) -> Option<(f64, Option<Powers>)> {
    let (places, mean) = places_of_patches(map, side)?;
    // So many of the places, evenly spread, a power of two.
    let overlapping = |places: usize| places.min((2 * places / side).clamp(WAVES, MOST_WAVES));
    let [columns, rows] = places.map(|places| 1 << overlapping(places).ilog2());
    let mut some = Vec::with_capacity(columns * rows);
    let mut squares = 0.0;
    boxes(map, side, places, |row, boxes| {
        let deviation = |weight: &u64| *weight as f64 / mean - 1.0;
        squares += boxes.iter().map(|weight| deviation(weight).powi(2)).sum::<f64>();
        if some.len() / columns * places[1] / rows == row {
            some.extend((0..columns).map(|column| deviation(&boxes[column * places[0] / columns])));
        }
    });
    let powers = (columns.min(rows) >= FEWEST)
        .then(|| Powers::new(columns, rows, 1, |row, column| some[row * columns + column]));
    Some((squares / (places[0] * places[1]) as f64, powers))
}

/// The coefficient of variation over the patches of this very map, at every place within its edges. That of
/// the web is larger, by what the mean of a piece varies.
///
/// * `side` – of a patch [cells]; None unless it is within the map, and without any fibre
pub fn cv_of_piece(map: &Map, side: usize) -> Option<f64> {
    let sizes = [map.columns, map.rows];
    if side == 0 || sizes.iter().any(|size| side > *size) {
        return None;
    }
    let places = sizes.map(|size| size - side + 1);
    let (mut sum, mut squares) = (0.0, 0.0);
    boxes(map, side, places, |_, boxes| {
        sum += boxes.iter().map(|weight| *weight as f64).sum::<f64>();
        squares += boxes.iter().map(|weight| (*weight as f64).powi(2)).sum::<f64>();
    });
    let count = (places[0] * places[1]) as f64;
    let mean = sum / count;
    (mean > 0.0).then(|| (squares / count / (mean * mean) - 1.0).max(0.0).sqrt())
}

/// Number of places of a patch on a map, across and along, and its quanta on average; None unless it is within the
/// map, and without any fibre.
pub(crate) fn places_of_patches(map: &Map, side: usize) -> Option<([usize; 2], f64)> {
    let sizes = [map.columns, map.rows];
    let mean = map.total() as f64 / map.cells.len() as f64 * (side * side) as f64;
    if side == 0 || sizes.iter().any(|size| side > *size) || mean <= 0.0 {
        return None;
    }
    Some(([0, 1].map(|axis| if map.closed[axis] { sizes[axis] } else { sizes[axis] - side + 1 }), mean))
}

/// Passes on the quanta in all patches, row by row of their places.
pub(crate) fn boxes(map: &Map, side: usize, places: [usize; 2], mut take: impl FnMut(usize, &[u64])) {
    let mut columns = vec![0u64; map.columns];
    for row in 0..side - 1 {
        add(&mut columns, map.row(row % map.rows));
    }
    let mut boxes = vec![0u64; places[0]];
    // On a closed sheet, the last patches reach beyond its edge.
    let within = (map.columns + 1 - side).min(places[0]);
    for row in 0..places[1] {
        add(&mut columns, map.row((row + side - 1) % map.rows));
        let mut sum: u64 = columns[..side - 1].iter().sum();
        let mut slide = |boxes: &mut [u64], first: &[u64], last: &[u64]| {
            for ((total, first), last) in boxes.iter_mut().zip(first).zip(last) {
                sum += last;
                *total = sum;
                sum -= first;
            }
        };
        let (inner, beyond) = boxes.split_at_mut(within);
        slide(inner, &columns, &columns[side - 1..]);
        slide(beyond, &columns[within..], &columns);
        take(row, &boxes);
        for (sum, cell) in columns.iter_mut().zip(map.row(row)) {
            *sum -= u64::from(*cell);
        }
    }
}

fn add(sums: &mut [u64], row: &[u32]) {
    for (sum, cell) in sums.iter_mut().zip(row) {
        *sum += u64::from(*cell);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::waves::Streaks;
    use super::*;
    use std::f64::consts::PI;

    fn map(sides: [usize; 2], closed: [bool; 2], weight: impl Fn(usize, usize) -> f64) -> Map {
        let [columns, rows] = sides;
        let cells = (0..columns * rows).map(|i| weight(i % columns, i / columns).round() as u32).collect();
        Map { columns, rows, cell: 1e-3, quantum: 1e-9, closed, cells }
    }

    /// The sums over the cells of each patch, and the CV that follows from them.
    #[test]
    fn analytic_patches_are_the_sums_of_their_cells() {
        for closed in [[true, true], [true, false], [false, true], [false, false]] {
            let map = map([7, 5], closed, |x, y| (100 + x * x * 7 + y * 31 + x * y) as f64);
            for side in 1..=5 {
                let (places, mean) = places_of_patches(&map, side).unwrap();
                assert_eq!(places, [0, 1].map(|i| if closed[i] { [7, 5][i] } else { [8, 6][i] - side }));
                let sum = |x: usize, y: usize| {
                    let row = |y: usize| (x..x + side).map(|x| u64::from(map.row(y % 5)[x % 7])).sum::<u64>();
                    (y..y + side).map(row).sum::<u64>()
                };
                let (mut rows, mut within) = (0, Vec::new());
                boxes(&map, side, places, |row, boxes| {
                    assert_eq!(
                        boxes,
                        (0..places[0]).map(|x| sum(x, row)).collect::<Vec<_>>(),
                        "{closed:?} {side}"
                    );
                    rows += 1;
                });
                assert_eq!(rows, places[1]);
                assert!((mean - map.total() as f64 / 35.0 * (side * side) as f64).abs() < 1e-9);
                (0..6 - side).for_each(|y| within.extend((0..8 - side).map(|x| sum(x, y) as f64)));
                let mean = within.iter().sum::<f64>() / within.len() as f64;
                let squares = within.iter().map(|sum| (sum / mean - 1.0).powi(2)).sum::<f64>();
                let cv = (squares / within.len() as f64).sqrt();
                assert!((cv_of_piece(&map, side).unwrap() - cv).abs() < 1e-9, "{side}");
            }
            for side in [0, 6] {
                assert_eq!((places_of_patches(&map, side), cv_of_piece(&map, side)), (None, None));
            }
        }
        let empty = map([7, 5], [true; 2], |_, _| 0.0);
        assert_eq!((places_of_patches(&empty, 2), cv_of_piece(&empty, 2)), (None, None));
    }

    /// Half of a web is heavier by a fifth: up to its middle a tenth of the mass has crossed, as a triangle.
    #[test]
    fn analytic_the_mean_of_a_part_varies_with_what_crosses_its_edges() {
        let heavier = |x: usize, _: usize| if x < 500 { 1200.0 } else { 800.0 };
        let found = |closed, share, places: &Places| {
            variance_of_mean(&map([1000, 4], closed, heavier), 1, share, places)
        };
        let crossed = 0.04 / 24.0;
        let random = |variance_of_mean| {
            Places::Known(Streaks { variance_of_mean, powers: Vec::new(), has_rows: false })
        };
        for (closed, share, places, wanted) in [
            ([true, true], 0.5, Places::Unknown, 0.0),
            ([false, true], 0.5, Places::Unknown, crossed),
            ([false, true], 0.75, random(0.003), 0.25 * 0.003 + crossed - 0.001),
            ([false, true], 1.5, random(0.003), crossed - 0.001),
            ([false, true], 0.5, random(0.3), 0.15),
        ] {
            let found = found(closed, share, &places);
            assert!((found - wanted).abs() < 1e-3 * crossed, "{closed:?} {places:?}: {found} {wanted}");
        }
        // The ends of a sheet cut its longest waves: each sense has 0.01 of the power, and the mean a quarter of both.
        let along = map([64, 64], [true, false], |_, y| 1e6 * (1.0 + 0.2 * (PI * y as f64 / 32.0).cos()));
        assert!((variance_of_mean(&along, 1, 0.5, &Places::Unknown) / 0.005 - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_cv_of_few_waves_has_the_wider_interval_of_students_t() {
        let known = PatchCv { patch: 0.01, cv: 0.2, standard_error: Some(0.04) };
        assert!((known.degrees().unwrap() - 12.5).abs() < 1e-12);
        let [usual, few] = [known.interval(), known.interval_of_few()].map(Option::unwrap);
        assert_eq!(usual, interval_of_deviation(0.2, 0.04));
        assert_eq!(few, interval_of_deviation_by(student_t_95_at(12.5), 0.2, 0.04));
        assert!(few[0] < usual[0] && usual[1] < few[1]);
        let unknown = PatchCv { standard_error: None, ..known };
        assert_eq!((unknown.degrees(), unknown.interval(), unknown.interval_of_few()), (None, None, None));
        // By ratio: 24 mm are nearer to 10 mm than 4 mm are.
        assert_eq!(nearest_to_seen([1e-3, 4e-3, 24e-3, 50e-3].into_iter()), Some(2));
    }

    /// Sixteen equal waves on 96 × 112 cells, of whose positions 64 × 64 are looked at. With those of the other sense
    /// they are thirty-two, so that the variance scatters by 2/31 of its square. The variance of the mean is added.
    #[test]
    fn analytic_the_error_of_the_cv_of_equal_waves() {
        let wave = |i: usize, x: usize, y: usize| {
            let turns = (1 + i % 4) as f64 * x as f64 / 96.0 + (1 + i / 4) as f64 * y as f64 / 112.0;
            0.02 * (2.0 * PI * turns).cos()
        };
        let sum = |x: usize, y: usize| (0..16).map(|i| wave(i, x, y)).sum::<f64>();
        let map = map([96, 112], [true; 2], |x, y| 1e6 * (1.0 + sum(x, y)));
        let of = |places: &Places| unevenness_at(&map, 1, places).unwrap();
        let found = of(&Places::Unknown);
        assert!((found.cv / (16.0 * 0.5 * 0.02 * 0.02_f64).sqrt() - 1.0).abs() < 1e-5, "{found:?}");
        // A position is a whole cell, up to half of one off where it should be.
        let ratio = found.standard_error.unwrap() / (0.5 * found.cv / 31f64.sqrt());
        assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
        let streaks =
            of(&Places::Known(Streaks { variance_of_mean: 0.001, powers: Vec::new(), has_rows: false }));
        assert!((streaks.cv.powi(2) - found.cv.powi(2) - 0.001).abs() < 1e-12, "{streaks:?}");
    }
}
