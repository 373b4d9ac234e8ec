//! Looks at fields: cubic B-splines in label, y and z, and between two generations.
//!
//! Eight places are looked at together: where they lie and all weights are computed side by side, and then the points around
//! each are summed up.

use super::EddyField;
use super::lattice::weights;
use super::tape::{BEFORE, NEEDED, REPEATED};
use crate::lanes::{Lanes, Register, Singles, WIDTH};
use crate::vec3::Vec3;
use std::array::from_fn;

/// A number of each place.
type Each<T> = [T; WIDTH];

/// Where places lie along an axis: the numbers of the first of four points around them, and the weights of these.
struct Around {
    first: Each<i64>,
    weights: [Each<f32>; NEEDED],
}

impl EddyField {
    /// Fluctuations of fields of rms one, x, y and z [-].
    ///
    /// * `fields` – of each place
    /// * `time` – for which they have been made [s]
    /// * `at` – places: distance from the inlet, and y and z [m]
    #[inline(always)]
    pub(crate) fn fluctuations<S: Register>(fields: Each<&Self>, time: f64, at: &Vec3<Lanes>) -> Vec3<Lanes> {
        let passages = from_fn::<_, WIDTH, _>(|lane| fields[lane].plan.way.passage(at.x.0[lane]));
        let last = fields.map(|field| field.tapes.len() - 1);
        // The second generation is the first one again where there is only one, or where eddies are not carried.
        let fading = fields.map(|field| if field.plan.way.is_carried() { 1.0 } else { 0.0 });
        let young: Each<usize> = from_fn(|lane| {
            (passages[lane].generation as usize).min(last[lane].saturating_sub(fading[lane] as usize))
        });
        let old: Each<usize> = from_fn(|lane| (young[lane] + fading[lane] as usize).min(last[lane]));
        let share: Each<f64> =
            from_fn(|lane| fading[lane] * (passages[lane].generation - young[lane] as f64).clamp(0.0, 1.0));

        let across_y =
            around_ring(&at.y, fields.map(|f| (f.plan.lattice.extent.y, f.plan.lattice.points[0])));
        let across_z =
            around_ring(&at.z, fields.map(|f| (f.plan.lattice.extent.z, f.plan.lattice.points[1])));
        let mut sums = [[S::Singles::zero(); NEEDED]; WIDTH];
        for (generations, parts) in [(young, share.map(|share| 1.0 - share)), (old, share)] {
            let along = around(from_fn(|lane| {
                (time - passages[lane].travel) * fields[lane].plan.samples_per_time(generations[lane])
            }));
            let of_label: [Each<f32>; NEEDED] =
                along.weights.map(|weights| from_fn(|lane| weights[lane] * parts[lane] as f32));
            let of_both: [[Each<f32>; NEEDED]; NEEDED] = across_y
                .weights
                .map(|of_y| of_label.map(|of_label| from_fn(|lane| of_y[lane] * of_label[lane])));
            for (lane, sums) in sums.iter_mut().enumerate() {
                let place = (along.first[lane], across_y.first[lane] as usize, across_z.first[lane] as usize);
                fields[lane].add::<S>(sums, generations[lane], place, |y, m| of_both[y][m][lane]);
            }
        }
        // Four points of three components.
        let sums = sums.map(|[a, b, c, d]| a.add(b).add(c.add(d)).store());
        let value = |component: usize| {
            let of_z = &across_z.weights;
            let sum: Each<f32> = from_fn(|lane| {
                let part = |point: usize| of_z[point][lane] * sums[lane][3 * point + component];
                (part(0) + part(1)) + (part(2) + part(3))
            });
            let correlation: Each<f64> =
                from_fn(|lane| fields[lane].plan.correlations[young[lane]][component]);
            Lanes(from_fn(|lane| {
                let both = 2.0 * share[lane] * (1.0 - share[lane]);
                f64::from(sum[lane]) / (1.0 - both * (1.0 - correlation[lane])).sqrt()
            }))
        };
        Vec3::new(value(0), value(1), value(2))
    }

    /// Adds what lies around a place in a generation, for each of four samples.
    ///
    /// * `place` – numbers of the first sample, of the first line and of its first point
    /// * `weight` – of a line and a sample
    #[inline(always)]
    fn add<S: Register>(
        &self,
        sums: &mut [S::Singles; NEEDED],
        generation: usize,
        (sample, first_line, point): (i64, usize, usize),
        weight: impl Fn(usize, usize) -> f32,
    ) {
        let Some(block) = self.tapes[generation].around(sample) else { return };
        let [lines, points] = self.plan.lattice.points;
        let row = 3 * (points + REPEATED);
        let start = (sample - block.first) as usize * row + 3 * point;
        let mut line = first_line;
        for y in 0..NEEDED {
            // All rows of a line at once, so that its end is looked at once.
            let Some(rows) = block.lines[line].get(start..start + (NEEDED - 1) * row + 3 * NEEDED) else {
                return;
            };
            for (m, sum) in sums.iter_mut().enumerate() {
                if let Some(points) = rows[m * row..].first_chunk() {
                    *sum = sum.add_weighted(points, weight(y, m));
                }
            }
            line = if line + 1 == lines { 0 } else { line + 1 };
        }
    }
}

/// The points around places among evenly spaced ones.
#[inline(always)]
fn around(places: Each<f64>) -> Around {
    let floors = places.map(f64::floor);
    let shares: Each<f32> = from_fn(|lane| (places[lane] - floors[lane]) as f32);
    Around { first: floors.map(|floor| floor as i64 - BEFORE), weights: weights(shares) }
}

/// The points around places on rings.
///
/// * `rings` – extent [m] and number of points of each
#[inline(always)]
fn around_ring(at: &Lanes, rings: Each<(f64, usize)>) -> Around {
    let turns: Each<f64> = from_fn(|lane| at.0[lane] / rings[lane].0);
    let places = from_fn(|lane| (turns[lane] - turns[lane].floor()) * rings[lane].1 as f64);
    let Around { first, weights } = around(places);
    // Rounding may put a place on the point after the last, which is the first.
    let first = from_fn(|lane| {
        let points = rings[lane].1 as i64;
        let first = if first[lane] < 0 { first[lane] + points } else { first[lane] };
        if first >= points { first - points } else { first }
    });
    Around { first, weights }
}
