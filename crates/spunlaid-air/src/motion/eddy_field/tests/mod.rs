//! The field against the closed formulas of its spectra, correlations and coherence, and against itself.

mod formulas;
mod statistics;

use super::{EddyField, EddyFields, Extent, Room};
use crate::motion::{Air, EddyModel, SpectrumShape, StreamKey};
use spunlaid_ground::{Isa, Register, Task, Vec3, WIDTH};

const SPEED: f64 = 25.0;
const LENGTH: f64 = 16e-3;
const CUTOFF: f64 = SPEED / 4.0 / LENGTH;
const EXTENT: Extent = Extent { y: 10.0 * LENGTH, z: 12.0 * LENGTH };
const LATERAL: f64 = 15.4;
const KEY: StreamKey = StreamKey { seed: 1, replicate: 0 };

fn air(decay_time: f64, spectrum: SpectrumShape, cutoff_frequency: f64) -> Air {
    let eddies = EddyModel::Convected { decay_time };
    Air { eddies, spectrum, ..Air::uniform(SPEED, 0.1, LENGTH, cutoff_frequency) }
}

fn frozen(spectrum: SpectrumShape, cutoff_frequency: f64) -> EddyField {
    EddyField::new(&air(f64::INFINITY, spectrum, cutoff_frequency), 0.5, EXTENT, LATERAL, KEY)
}

fn at(field: &EddyField, time: f64, place: [f64; 3]) -> [f64; 3] {
    Isa::detect().run(LookOnce { field, time, place })
}

struct LookOnce<'a> {
    field: &'a EddyField,
    time: f64,
    place: [f64; 3],
}

impl Task for LookOnce<'_> {
    type Output = [f64; 3];

    #[inline(always)]
    fn call<S: Register>(self) -> [f64; 3] {
        look::<S>(self.field, self.time, self.place)
    }
}

#[inline(always)]
fn look<S: Register>(field: &EddyField, time: f64, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let Vec3 { x, y, z } =
        EddyFields::new([field; WIDTH]).fluctuations::<S>(time, &Vec3::splat(Vec3::new(x, y, z))).0;
    [x.0[5], y.0[5], z.0[5]]
}

/// Places and times that fill a block evenly: number `i` of them.
fn spread(i: usize, from: f64, block: f64, distance: f64) -> (f64, [f64; 3]) {
    let turn = |ratio: f64| (i as f64 * ratio).fract();
    let place = [distance * turn(0.754_877_67), EXTENT.y * turn(0.569_840_29), EXTENT.z * turn(0.414_213_56)];
    (from + block * turn(0.618_033_99), place)
}

/// Correlations of each component at a place with each one at another, `apart` [m] from it and `later` [s].
///
/// * `places` – in each block of time
fn correlations(
    field: &mut EddyField,
    distance: f64,
    blocks: usize,
    places: usize,
    apart: &[(f64, [f64; 3])],
) -> Vec<[[f64; 3]; 3]> {
    let block = field.plan.repeat_time;
    let mut products = vec![[[0.0; 3]; 3]; apart.len()];
    let mut squares = vec![[0.0; 3]; apart.len()];
    for number in 0..blocks {
        let from = number as f64 * block;
        let last = apart.iter().map(|(later, _)| *later).fold(0.0, f64::max);
        field.make(from..from + block + last, 2);
        for i in 0..places {
            let (time, place) = spread(i, from, block, distance);
            let here = at(field, time, place);
            for (n, (later, apart)) in apart.iter().enumerate() {
                let there = at(field, time + later, [0, 1, 2].map(|k| place[k] + apart[k]));
                for i in 0..3 {
                    squares[n][i] += 0.5 * (here[i] * here[i] + there[i] * there[i]);
                    (0..3).for_each(|j| products[n][i][j] += here[i] * there[j]);
                }
            }
        }
    }
    let pairs = products.iter().zip(&squares);
    let correlation = |(products, squares): (&[[f64; 3]; 3], &[f64; 3])| {
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| products[i][j] / (squares[i] * squares[j]).sqrt()))
    };
    pairs.map(correlation).collect()
}

/// Air keeps its volume: `∂u/∂x + ∂v/∂y + ∂w/∂z = 0`. A pattern that is carried has `∂/∂x = −(1/U) ∂/∂t`.
/// With the sign of one wave number wrong, the sum would be larger than its parts.
#[test]
fn invariant_isotropic_turbulence_is_free_of_divergence() {
    let mut field = frozen(SpectrumShape::VonKarman, SPEED / LENGTH);
    let (h, block) = (0.05 * LENGTH, field.plan.repeat_time);
    field.make(0.0..block, 2);
    let (mut divergence, mut gradients) = (0.0, 0.0);
    for i in 0..20_000 {
        let (time, place) = spread(i, 0.1 * block, 0.8 * block, 0.5);
        let slope = |axis: usize| {
            let [below, above] = [-h, h].map(|by| {
                at(&field, time, std::array::from_fn(|k| place[k] + if k == axis { by } else { 0.0 }))[axis]
            });
            (above - below) / (2.0 * h)
        };
        let slopes = [0, 1, 2].map(slope);
        divergence += slopes.iter().sum::<f64>().powi(2);
        gradients += slopes.iter().map(|slope| slope * slope).sum::<f64>();
    }
    assert!(divergence < 0.03 * gradients, "{}", divergence / gradients);
}

#[test]
fn invariant_the_variance_is_one_at_every_phase_of_the_interpolation() {
    let mut field = EddyField::new(&air(5e-3, SpectrumShape::Flat, CUTOFF), 0.5, EXTENT, LATERAL, KEY);
    let block = field.plan.repeat_time;
    // Between two generations, in the middle between and at the points across, and likewise in time.
    let generation = 0.5 / 24.0;
    let [step_y, step_z] =
        [EXTENT.y / field.plan.lattice.points[0] as f64, EXTENT.z / field.plan.lattice.points[1] as f64];
    let mut sums = [[0.0; 8]; 3];
    for number in 0..4 {
        let from = f64::from(number) * block;
        field.make(from..from + block, 2);
        for i in 0..60_000 {
            let (time, [x, y, z]) = spread(i, from, block, 0.48);
            let phase = i % 8;
            let half = |bit: usize| if phase >> bit & 1 == 1 { 0.5 } else { 0.0 };
            let place = [
                ((x / generation).floor() + half(0)) * generation,
                ((y / step_y).floor() + half(1)) * step_y,
                ((z / step_z).floor() + half(2)) * step_z,
            ];
            let value = at(&field, time, place);
            (0..3).for_each(|k| sums[k][phase] += value[k] * value[k] / 30_000.0);
        }
    }
    for (k, squares) in sums.iter().enumerate() {
        let mean = squares.iter().sum::<f64>() / 8.0;
        assert!((mean - 1.0).abs() < 0.02, "component {k}: {mean}");
        for variance in squares {
            assert!((variance / mean - 1.0).abs() < 0.03, "component {k}: {squares:?}");
        }
    }
}

/// The windows of time join without a seam: the two windows of a transform, and those of two transforms. In a
/// spectrum like von Kármán's the real and the imaginary part of a transform have much in common at unequal
/// times.
#[test]
#[ignore = "slow: many fields at many instants"]
fn invariant_the_variance_is_the_same_in_the_joints_of_the_windows() {
    for (spectrum, cutoff) in [(SpectrumShape::Flat, CUTOFF), (SpectrumShape::VonKarman, SPEED / LENGTH)] {
        let mut field = frozen(spectrum, cutoff);
        let hop = 0.75 * field.plan.repeat_time;
        // In every second window: in its joint with the one before, and behind it.
        let mut sums = [[[0.0; 3]; 2]; 2];
        for window in 1..161 {
            let from = f64::from(window) * hop;
            field.make(from..from + hop, 2);
            for i in 0..4000 {
                for (sums, start) in sums[window as usize % 2].iter_mut().zip([0.0, 0.5]) {
                    let (time, place) = spread(i, from + start * hop, hop / 3.0, 0.0);
                    let value = at(&field, time, place);
                    (0..3).for_each(|k| sums[k] += value[k] * value[k] / (4000.0 * 80.0));
                }
            }
        }
        for variance in sums.as_flattened().as_flattened() {
            assert!((variance - 1.0).abs() < 0.03, "{sums:?}");
        }
    }
}

#[test]
fn limit_without_waves_across_the_air_is_the_same_everywhere_across() {
    let mut field = EddyField::new(&air(5e-3, SpectrumShape::Flat, CUTOFF), 0.5, EXTENT, 0.0, KEY);
    let block = field.plan.repeat_time;
    field.make(0.0..20.0 * block, 1);
    let mut squares = [0.0; 3];
    for i in 0..50_000 {
        let (time, place) = spread(i, 0.0, 20.0 * block, 0.5);
        let value = at(&field, time, place);
        let beside = at(&field, time, [place[0], 0.0, 0.0]);
        assert!(value.iter().zip(beside).all(|(a, b)| (a - b).abs() < 2e-6), "{value:?} {beside:?}");
        (0..3).for_each(|k| squares[k] += value[k] * value[k] / 50_000.0);
    }
    for variance in squares {
        assert!((variance - 1.0).abs() < 0.03, "{squares:?}");
    }
}

struct Looks<'a>(&'a EddyField);

impl Task for Looks<'_> {
    type Output = Vec<[f64; 3]>;

    #[inline(always)]
    fn call<S: Register>(self) -> Self::Output {
        let block = self.0.block();
        (0..500)
            .map(|i| {
                let (time, place) = spread(i, 3.0 * block, block, 0.5);
                look::<S>(self.0, time, place)
            })
            .collect()
    }
}

#[test]
fn reproducible_a_field_has_the_same_bits_however_it_is_made_and_looked_at() {
    let made = |field: EddyField, threads: usize, steps: &[f64]| {
        let mut field = field;
        for pair in steps.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|step| step * field.block());
            field.make(from..to, threads);
        }
        field
    };
    let new = |key| EddyField::new(&air(5e-3, SpectrumShape::Flat, CUTOFF), 0.5, EXTENT, 6.0, key);
    let expected = Isa::Baseline.run(Looks(&made(new(KEY), 1, &[0.0, 4.0])));
    for isa in Isa::available() {
        for (threads, steps) in [(2, &[3.0, 4.0][..]), (3, &[0.0, 1.0, 2.5, 4.0])] {
            // The same key again after another one.
            let field = new(StreamKey { seed: 2, replicate: 1 }).with_key(KEY);
            let field = made(field, threads, steps);
            if steps[steps.len() - 2] <= 3.0 {
                assert_eq!(isa.run(Looks(&field)), expected, "{} {threads} {steps:?}", isa.name());
            }
        }
    }
    let other = Isa::Baseline.run(Looks(&made(new(StreamKey { seed: 1, replicate: 1 }), 1, &[0.0, 4.0])));
    assert!(expected.iter().zip(&other).all(|(a, b)| a != b));
}

#[test]
fn invariant_a_field_repeats_itself_after_its_extent() {
    let extent = Extent { y: 0.125, z: 0.25 };
    let mut field = EddyField::new(&air(f64::INFINITY, SpectrumShape::Flat, CUTOFF), 0.5, extent, 6.0, KEY);
    let block = field.block();
    field.make(0.0..block, 1);
    for i in 0..1000 {
        // Binary fractions, so that the sums are exact.
        let [y, z] = [i % 32, i % 57].map(|n| f64::from(n) / 512.0);
        let here = at(&field, 0.5 * block, [0.1, y, z]);
        for (laps_y, laps_z) in [(1.0, 0.0), (0.0, 1.0), (-2.0, 3.0)] {
            assert_eq!(here, at(&field, 0.5 * block, [0.1, y + laps_y * extent.y, z + laps_z * extent.z]));
        }
    }
}

/// What passes 1.25 times as fast is there as much earlier: the field that shares its samples, and the one
/// that is made for the fast air alone.
#[test]
fn analytic_faster_air_of_one_pattern_is_the_same_field_earlier() {
    let (pace, decay_time) = (1.25, 20e-3);
    let slow = air(decay_time, SpectrumShape::VonKarman, CUTOFF);
    let eddies = EddyModel::Convected { decay_time: decay_time / pace };
    let fast = Air { eddies, velocity: pace * SPEED, cutoff_frequency: pace * CUTOFF, ..slow.clone() };
    let room = Room::of(&[(&slow, 0.4, EXTENT), (&fast, 0.5, Extent { y: 0.1, z: 0.1 })]);
    assert_eq!((room.extent, room.distance), (EXTENT, 0.5));
    let mut of_slow = EddyField::in_room(&slow, &room, 6.0, KEY);
    let (of_fast, found) = of_slow.at_pace_of([&slow, &fast], &room).unwrap();
    assert!((found / pace - 1.0).abs() < 1e-6, "{found}");
    let mut alone = EddyField::in_room(&fast, &room, 6.0, KEY);
    let block = of_slow.block();
    of_slow.make(0.0..block, 1);
    alone.make(0.0..block / pace, 1);
    let of_fast = of_fast.made_as(&of_slow, found);
    for i in 0..1000 {
        let (time, place) = spread(i, 0.01 * block, 0.98 * block, 0.5);
        let [slow, fast, alone] = [(&of_slow, time), (&of_fast, time / pace), (&alone, time / pace)]
            .map(|(field, time)| at(field, time, place));
        for component in 0..3 {
            assert!((slow[component] - fast[component]).abs() < 2e-3, "{slow:?} {fast:?}");
            assert!((alone[component] - fast[component]).abs() < 1e-2, "{alone:?} {fast:?}");
        }
    }
    // Another decay time for its speed is another pattern.
    let forgetful = Air { eddies: EddyModel::Convected { decay_time }, ..fast.clone() };
    assert!(of_slow.at_pace_of([&slow, &forgetful], &room).is_none());
}

/// A field of a larger cut-off is that of a smaller one and smaller eddies. Without common phases the two would have
/// nothing in common.
#[test]
fn analytic_fields_of_two_cut_offs_have_their_larger_waves_in_common() {
    const LARGER: f64 = 4.0;
    let air = air(20e-3, SpectrumShape::VonKarman, CUTOFF);
    let room = Room::alone(0.5, EXTENT).with_waves_in_common(LARGER);
    let mut fields = [LARGER, LATERAL].map(|cutoff| EddyField::in_room(&air, &room, cutoff, KEY));
    let block = fields[0].block();
    fields.iter_mut().for_each(|field| field.make(0.0..block, 1));
    let (mut squares, mut product) = ([0.0; 2], 0.0);
    for i in 0..4000 {
        let (time, place) = spread(i, 0.01 * block, 0.98 * block, 0.5);
        let [larger, all] = [0, 1].map(|number| at(&fields[number], time, place)[1]);
        squares[0] += larger * larger;
        squares[1] += all * all;
        product += larger * all;
    }
    let correlation = product / (squares[0] * squares[1]).sqrt();
    assert!((0.85..0.999).contains(&correlation), "{correlation}");
    // A field of that cut-off alone has the same bits as in a room with others.
    let mut alone = EddyField::new(&air, 0.5, EXTENT, LARGER, KEY);
    alone.make(0.0..block, 1);
    assert_eq!(at(&alone, 0.4 * block, [0.2, 0.01, 0.02]), at(&fields[0], 0.4 * block, [0.2, 0.01, 0.02]));
}
