//! A field in bricks of values, so that looking it up costs the same for every kind of field.
//!
//! The box of the field is divided into bricks. A brick holds values on a small lattice and is filled when a
//! point in it is first looked up. If the lattice is not accurate enough, the brick is divided into eight. A
//! brick that is still not accurate after several divisions is not used: there the field itself is sampled.
//!
//! The content of a brick does not depend on who fills it, or when, so results are reproducible.

use super::node::Quantities;
use super::{Hint, Support};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Bricks along the longest side of the box.
const ALONG: f64 = 32.0;
/// Cells along the side of a brick.
const CELLS: usize = 4;
/// Points along the side of a brick.
const SIDE: usize = CELLS + 1;
/// How often a brick is divided into eight at most.
const DEEPEST: u32 = 6;
/// Largest error of a brick, as a share of the largest value in the undivided brick.
const ERROR: f64 = 1e-3;
/// A brick that was divided more often than this may be wrong by twice as much for each division more: the layer
/// about a kink where it is wrong is half as thick each time, and the fibre is in it half as long.
const FINE: u32 = 3;
/// Points between those of the lattice where the error is measured.
const PROBES: usize = 24;
/// How far a brick may be continued over its faces, as a share of its side. An element that swings about a
/// face would be looked up at almost every step without it.
const MARGIN: f64 = 0.125 / CELLS as f64;
/// Most memory that bricks take [bytes]. Bricks beyond it are made again at every look.
const MOST_MEMORY: usize = 1 << 30;
/// Most bricks before any is divided.
const MOST_BRICKS: f64 = 1e6;

/// Velocity along x, y and z and `√k` [m/s]. Unlike `k`, its root is proportional to the fluctuation.
type AirNumbers = [f64; 4];

/// The air around a point, linear in space, see [`Field::around`](super::Field::around).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AirAround {
    /// Velocity along x, y and z and `√k` at the point [m/s].
    pub value: [f64; 4],
    /// Their changes along x, y and z [1/s].
    pub gradients: [[f64; 4]; 3],
    /// Distance along each axis within which the gradients are accurate enough [m].
    pub reach: f64,
    /// Whether the point lies in the field.
    pub inside: bool,
}

#[derive(Debug)]
pub(super) struct OctreeCache {
    low: [f64; 3],
    high: [f64; 3],
    /// Side of an undivided brick.
    size: f64,
    count: [usize; 3],
    bricks: OnceLock<Box<[OnceLock<Brick>]>>,
    memory: AtomicUsize,
}

#[derive(Debug)]
enum Brick {
    /// Not accurate enough.
    Rough,
    Whole(Box<Values>),
    Divided(Box<Parts>),
}

#[derive(Debug)]
struct Parts {
    parts: [OnceLock<Brick>; 8],
    /// Largest error allowed in them.
    allowed: f64,
}

#[derive(Debug)]
struct Values {
    /// Of the points of the lattice; along an axis in which the field has no extent there is one.
    at: Box<[AirNumbers]>,
    /// How far neighbours along each axis lie apart in it; zero where there is one point.
    stride: [usize; 3],
    inside: bool,
    /// [`MARGIN`], or zero where the flow changes at the faces.
    margin: f64,
}

/// A place in a brick.
struct PlaceInBrick {
    /// Corner of the brick.
    corner: [f64; 3],
    /// Side of the brick.
    size: f64,
    /// From the corner, 0 to 1 across the brick.
    share: [f64; 3],
    divisions: u32,
}

impl OctreeCache {
    pub(super) fn new((low, high): ([f64; 3], [f64; 3])) -> Self {
        let extent = [0, 1, 2].map(|axis| high[axis] - low[axis]);
        let longest = extent.into_iter().fold(0.0, f64::max);
        let mut size = longest / ALONG;
        let count = |size: f64| extent.map(|extent| (extent / size).ceil().clamp(1.0, MOST_BRICKS));
        if !(size > 0.0 && count(size).into_iter().product::<f64>() <= MOST_BRICKS) {
            size = 0.0;
        }
        let count = if size > 0.0 { count(size).map(|count| count as usize) } else { [1; 3] };
        Self { low, high, size, count, bricks: OnceLock::new(), memory: AtomicUsize::new(0) }
    }

    /// The memory taken so far [bytes].
    pub(super) fn memory(&self) -> usize {
        self.memory.load(Ordering::Relaxed)
    }

    /// The air around a point.
    ///
    /// * `hint` – where the field itself is sampled
    pub(super) fn around(&self, at: [f64; 3], hint: &mut Hint, field: &Support) -> AirAround {
        let within = (0..3).all(|axis| {
            let flat = self.low[axis] == self.high[axis];
            flat || self.low[axis] <= at[axis] && at[axis] <= self.high[axis]
        });
        if within && self.size > 0.0 {
            let mut place = self.place(at);
            let bricks = self.bricks.get_or_init(|| {
                let count = self.count.iter().product();
                self.memory.fetch_add(count * size_of::<OnceLock<Brick>>(), Ordering::Relaxed);
                (0..count).map(|_| OnceLock::new()).collect()
            });
            let index =
                [0, 1, 2].map(|axis| ((place.corner[axis] - self.low[axis]) / self.size).round() as usize);
            let index = index[0] + self.count[0] * (index[1] + self.count[1] * index[2]);
            if let Some(brick) = bricks.get(index)
                && let Some(around) = self.look(brick, &mut place, None, field)
            {
                return around;
            }
        }
        let (values, inside) = field.sample(at, hint);
        AirAround { value: air_numbers(values), gradients: [[0.0; 4]; 3], reach: 0.0, inside }
    }

    fn place(&self, at: [f64; 3]) -> PlaceInBrick {
        let (mut corner, mut share) = (self.low, [0.0; 3]);
        for axis in (0..3).filter(|axis| self.low[*axis] < self.high[*axis]) {
            let along = (at[axis] - self.low[axis]) / self.size;
            let before = along.floor().min((self.count[axis] - 1) as f64).max(0.0);
            corner[axis] = self.low[axis] + before * self.size;
            share[axis] = (along - before).clamp(0.0, 1.0);
        }
        PlaceInBrick { corner, size: self.size, share, divisions: 0 }
    }

    fn look(
        &self,
        brick: &OnceLock<Brick>,
        place: &mut PlaceInBrick,
        allowed: Option<f64>,
        field: &Support,
    ) -> Option<AirAround> {
        let made;
        let brick = match brick.get() {
            Some(brick) => brick,
            None if self.memory() > MOST_MEMORY => {
                made = self.make(place, allowed, field);
                &made
            }
            None => brick.get_or_init(|| {
                let brick = self.make(place, allowed, field);
                let memory = match &brick {
                    Brick::Rough => 0,
                    Brick::Whole(values) => size_of::<Values>() + size_of_val(&*values.at),
                    Brick::Divided(_) => size_of::<Parts>(),
                };
                self.memory.fetch_add(memory, Ordering::Relaxed);
                brick
            }),
        };
        match brick {
            Brick::Rough => None,
            Brick::Whole(values) => Some(self.within(values, place)),
            Brick::Divided(parts) => {
                let half = 0.5 * place.size;
                let mut part = 0;
                for axis in 0..3 {
                    let upper = place.share[axis] >= 0.5;
                    part |= usize::from(upper) << axis;
                    place.corner[axis] += if upper { half } else { 0.0 };
                    place.share[axis] = 2.0 * place.share[axis] - if upper { 1.0 } else { 0.0 };
                }
                (place.size, place.divisions) = (half, place.divisions + 1);
                self.look(&parts.parts[part], place, Some(parts.allowed), field)
            }
        }
    }

    /// The air at a place of a brick. It reaches little beyond its faces.
    #[inline]
    fn within(&self, values: &Values, place: &PlaceInBrick) -> AirAround {
        let around = values.around(place);
        let mut reach = around.reach;
        for axis in (0..3).filter(|axis| self.low[*axis] < self.high[*axis]) {
            let to_face = place.share[axis].min(1.0 - place.share[axis]);
            reach = reach.min((to_face + values.margin) * place.size);
        }
        AirAround { reach, ..around }
    }

    #[inline(never)]
    fn make(&self, place: &PlaceInBrick, allowed: Option<f64>, field: &Support) -> Brick {
        let flat = [0, 1, 2].map(|axis| self.low[axis] == self.high[axis]);
        let to_point = |share: [f64; 3]| {
            [0, 1, 2].map(|axis| {
                let x = place.corner[axis] + share[axis] * place.size;
                x.clamp(self.low[axis], self.high[axis])
            })
        };
        // The brick's own hint, because its content must not depend on who asks for it.
        let mut hint = Hint::default();
        let mut at = |share: [f64; 3]| {
            let (values, inside) = field.sample(to_point(share), &mut hint);
            (air_numbers(values), inside)
        };
        let mut outside = 0;
        let points = flat.map(|flat| if flat { 1 } else { SIDE });
        let all = indices(points).map(|index| {
            let (value, inside) = at(index.map(|index| index as f64 / CELLS as f64));
            outside += usize::from(!inside);
            value
        });
        let all = all.collect();
        let stride = [(0, 1), (1, points[0]), (2, points[0] * points[1])];
        let stride = stride.map(|(axis, stride)| if flat[axis] { 0 } else { stride });
        let mut values = Values { at: all, stride, inside: outside == 0, margin: 0.0 };
        let largest = values.at.as_flattened().iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let allowed = allowed.unwrap_or(ERROR * largest);
        let here = allowed * f64::from(1 << place.divisions.saturating_sub(FINE));
        // Continued from points at random, because a regular pattern could miss a regular flow, to the corners of
        // their reach.
        let random = |i: usize| [0, 1, 2].map(|axis| (0.5 + (i + 1) as f64 * RATIOS[axis]).fract());
        let mut probe = |i: usize, from: [f64; 3], margin: f64| {
            let to = [0, 1, 2].map(|axis| {
                let to_face = from[axis].min(1.0 - from[axis]);
                let reach = (0.5 / CELLS as f64).min(to_face + margin);
                from[axis] + if i >> axis & 1 == 0 { reach } else { -reach }
            });
            let (exact, inside) = at(to);
            let found = values.continued(from, to);
            if inside == values.inside { difference(&exact, &found) } else { f64::INFINITY }
        };
        // The dearer tests only where the cheaper ones find no fault.
        let mut error = values.error_of_every_second();
        if error <= here {
            error = (0..PROBES).map(|i| probe(i, random(i), 0.0)).fold(error, f64::max);
        }
        if error <= here {
            // Over each face, as far as the reach of a place allows that lies so deep below it.
            let over_a_face = |i: usize| {
                let (mut from, depth) = (random(i), 0.5 / CELLS as f64 - MARGIN);
                from[i / 8] = if i >> (i / 8) & 1 == 0 { 1.0 - depth } else { depth };
                probe(i, from, MARGIN)
            };
            let over_the_faces = (0..PROBES).map(over_a_face).fold(0.0, f64::max);
            // Between the points where it is given, the field has no peaks.
            let errors = |margin: f64, mut most: f64| {
                let (low, high) = (to_point([-margin; 3]), to_point([1.0 + margin; 3]));
                field.points_in_box(low, high, |point, exact| {
                    if (0..3).all(|axis| flat[axis] || low[axis] <= point[axis] && point[axis] <= high[axis])
                    {
                        let share = [0, 1, 2].map(|axis| (point[axis] - place.corner[axis]) / place.size);
                        let found = values.continued(share.map(|share| share.clamp(0.0, 1.0)), share);
                        most = most.max(difference(&air_numbers(*exact), &found));
                    }
                });
                most
            };
            if errors(0.0, error) <= here {
                values.margin = if errors(MARGIN, over_the_faces) <= here { MARGIN } else { 0.0 };
                return Brick::Whole(Box::new(values));
            }
        }
        if place.divisions == DEEPEST {
            return Brick::Rough;
        }
        Brick::Divided(Box::new(Parts { parts: Default::default(), allowed }))
    }
}

/// Steps of an evenly spread sequence of points along x, y and z (Roberts' R₃).
const RATIOS: [f64; 3] = [0.819_172_513_396_164_5, 0.671_043_606_703_789_2, 0.549_700_477_901_967_3];

/// The points of a lattice of so many, x first.
fn indices([nx, ny, nz]: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    (0..nx * ny * nz).map(move |i| [i % nx, i / nx % ny, i / (nx * ny)])
}

fn air_numbers([u, v, w, k, _]: Quantities) -> AirNumbers {
    [u, v, w, k.max(0.0).sqrt()]
}

fn difference(a: &AirNumbers, b: &AirNumbers) -> f64 {
    a.iter().zip(b).fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

impl Values {
    fn around(&self, place: &PlaceInBrick) -> AirAround {
        let (value, gradients) = self.between(place.share);
        let spacing = place.size / CELLS as f64;
        AirAround {
            value,
            gradients: gradients.map(|changes| changes.map(|change| change / spacing)),
            reach: 0.5 * spacing,
            inside: self.inside,
        }
    }

    /// The values at a place of the brick, continued linearly from another one.
    fn continued(&self, from: [f64; 3], to: [f64; 3]) -> AirNumbers {
        let (mut value, gradients) = self.between(from);
        for (axis, gradient) in gradients.iter().enumerate() {
            let cells = (to[axis] - from[axis]) * CELLS as f64;
            value.iter_mut().zip(gradient).for_each(|(value, change)| *value += cells * change);
        }
        value
    }

    /// The values linear in each coordinate, and their changes over a cell along x, y and z.
    #[inline]
    fn between(&self, share: [f64; 3]) -> (AirNumbers, [AirNumbers; 3]) {
        let along = share.map(|share| share * CELLS as f64);
        let before = along.map(|along| (along as usize).min(CELLS - 1));
        let [sx, sy, sz] = [0, 1, 2].map(|axis| along[axis] - before[axis] as f64);
        let [next_x, next_y, next_z] = self.stride;
        let first = before[0] * next_x + before[1] * next_y + before[2] * next_z;
        let corner = |y: usize, z: usize| {
            let row = first + y * next_y + z * next_z;
            (&self.at[row], &self.at[row + next_x])
        };
        let (mut value, mut gradients) = ([0.0; 4], [[0.0; 4]; 3]);
        let [ll, hl, lh, hh] = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
        for i in 0..4 {
            let [dll, dhl, dlh, dhh] = [ll, hl, lh, hh].map(|(low, high)| high[i] - low[i]);
            let [ll, hl, lh, hh] = [(ll.0[i], dll), (hl.0[i], dhl), (lh.0[i], dlh), (hh.0[i], dhh)]
                .map(|(low, rise)| low + sx * rise);
            let (low, high) = (ll + sy * (hl - ll), lh + sy * (hh - lh));
            value[i] = low + sz * (high - low);
            let (dx_low, dx_high) = (dll + sy * (dhl - dll), dlh + sy * (dhh - dlh));
            gradients[0][i] = dx_low + sz * (dx_high - dx_low);
            gradients[1][i] = (hl - ll) + sz * ((hh - lh) - (hl - ll));
            gradients[2][i] = high - low;
        }
        (value, gradients)
    }

    /// A quarter of the largest error that the lattice would have with every second point only: about its own error
    /// where the field is smooth.
    fn error_of_every_second(&self) -> f64 {
        let mut worst = 0.0_f64;
        for (index, value) in indices(self.stride.map(|next| if next == 0 { 1 } else { SIDE })).zip(&self.at)
        {
            let ends = |axis: usize| (index[axis] - index[axis] % 2, index[axis] + index[axis] % 2);
            let [x, y, z] = [ends(0), ends(1), ends(2)];
            let mut mean = [0.0; 4];
            for corner in 0..8 {
                let pick =
                    |(low, high): (usize, usize), bit: usize| if corner >> bit & 1 == 0 { low } else { high };
                let [next_x, next_y, next_z] = self.stride;
                let node = &self.at[pick(x, 0) * next_x + pick(y, 1) * next_y + pick(z, 2) * next_z];
                mean.iter_mut().zip(node).for_each(|(mean, value)| *mean += 0.125 * value);
            }
            worst = worst.max(difference(&mean, value));
        }
        0.25 * worst
    }
}
