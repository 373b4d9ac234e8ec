//! A CFD field, and where the fibre hangs in it.

use super::FileContent;
use crate::field::{AirAround, Field, Hint, Local};
use spunlaid_ground::{Dimension, Fault, Vec3};

/// A direction along an axis of a field, forwards or backwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    /// 0, 1, 2 for x, y, z.
    pub index: usize,
    /// Whether the direction is against the axis.
    pub backwards: bool,
}

impl Axis {
    /// All six directions. The first is that of a field whose flow is along x.
    pub const ALL: [Self; 6] = [
        Self { index: 0, backwards: false },
        Self { index: 1, backwards: false },
        Self { index: 2, backwards: false },
        Self { index: 0, backwards: true },
        Self { index: 1, backwards: true },
        Self { index: 2, backwards: true },
    ];

    /// Name in the case file.
    pub const fn name(self) -> &'static str {
        match (self.index, self.backwards) {
            (0, false) => "x",
            (1, false) => "y",
            (_, false) => "z",
            (0, true) => "-x",
            (1, true) => "-y",
            (_, true) => "-z",
        }
    }

    /// The axis that makes a right-handed frame of this one, another one across it, and itself.
    pub const fn cross(self, other: Self) -> Self {
        let is_next = (self.index + 1) % 3 == other.index;
        let backwards = self.backwards ^ other.backwards ^ !is_next;
        Self { index: (6 - self.index - other.index) % 3, backwards }
    }

    /// The part of a vector along the axis.
    pub fn part_of(self, v: Vec3<f64>) -> f64 {
        let part = [v.x, v.y, v.z][self.index];
        if self.backwards { -part } else { part }
    }
}

/// Turns a vector from the fibre's frame, whose x, y and z are along these axes, into the frame of the field.
fn to_field(axes: [Axis; 3], v: Vec3<f64>) -> Vec3<f64> {
    let mut turned = [0.0; 3];
    for (axis, part) in axes.into_iter().zip([v.x, v.y, v.z]) {
        turned[axis.index] = if axis.backwards { -part } else { part };
    }
    Vec3::new(turned[0], turned[1], turned[2])
}

/// Turns a vector from the frame of the field into the fibre's frame.
fn to_fibre([along, machine, cross]: [Axis; 3], v: Vec3<f64>) -> Vec3<f64> {
    Vec3::new(along.part_of(v), machine.part_of(v), cross.part_of(v))
}

/// A CFD field around a fibre.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedField {
    /// The field.
    pub field: FileContent<Field>,
    /// Position of the fibre's root in the field [m].
    pub root: Vec3<f64>,
    /// The direction of the field that is the fibre's x, along gravity.
    pub axis: Axis,
    /// The direction of the field that is the fibre's y, in which the belt runs; across [`PlacedField::axis`].
    pub machine_direction: Axis,
    /// Length of a unit of its coordinates [m].
    pub unit: f64,
    /// `C_L` of the length scale `C_L k^1.5/ε` [-].                           theory.md (48)
    pub length_constant: f64,
    /// `C_T` of the lifetime `C_T k/ε` of an eddy [-].                        theory.md (49)
    pub time_constant: f64,
}

/// `C_L` if the case does not give it: for the longitudinal integral scale at high Reynolds numbers
/// (Pope 2000, section 6.5.7).
pub const LENGTH_CONSTANT: f64 = 0.43;
/// `C_T` if the case does not give it: the lifetime of an eddy in the discrete random walk model
/// (Gosman & Ioannides 1983, twice the Lagrangian time 0.15 k/ε).
pub const TIME_CONSTANT: f64 = 0.30;

impl PlacedField {
    /// A place in words, `[0 m, 25 mm, 0 m]`.
    pub fn in_words(at: Vec3<f64>) -> String {
        // Without the sign of a zero.
        let shown = |x: f64| Dimension::Length.pretty_to(x + 0.0, 4);
        format!("[{}, {}, {}]", shown(at.x), shown(at.y), shown(at.z))
    }

    /// A place as a case has it, `["0 m", "25 mm", "0 m"]`.
    pub fn in_case(at: Vec3<f64>) -> String {
        Self::in_words(at).replace('[', "[\"").replace(", ", "\", \"").replace(']', "\"]")
    }

    /// The velocity at a place of the fibre's frame [m/s]. The origin is the root.
    pub fn velocity(&self, at: Vec3<f64>, hint: &mut Hint) -> Vec3<f64> {
        self.at(at, hint).velocity
    }

    /// `k` [m²/s²] and `ε` [m²/s³] at a place of the fibre, as the field has them.
    pub fn turbulence(&self, at: Vec3<f64>, hint: &mut Hint) -> (f64, f64) {
        let local = self.at(at, hint);
        (local.k, local.epsilon)
    }

    /// A place of the fibre's frame [m] in the coordinates of the field.
    pub fn in_field(&self, at: Vec3<f64>) -> Vec3<f64> {
        (self.root + self.turned(at)) * (1.0 / self.unit)
    }

    /// A vector of the fibre's frame in that of the field.
    pub fn turned(&self, vector: Vec3<f64>) -> Vec3<f64> {
        to_field(self.axes(), vector)
    }

    /// A vector of the frame of the field in the fibre's.
    pub(crate) fn turned_back(&self, vector: Vec3<f64>) -> Vec3<f64> {
        to_fibre(self.axes(), vector)
    }

    /// A place of the field [m] in the fibre's frame.
    pub(super) fn in_fibre_frame(&self, at: Vec3<f64>) -> Vec3<f64> {
        self.turned_back(at - self.root)
    }

    /// The directions of the field that are the fibre's x, y and z: along gravity, machine and cross direction.
    pub const fn axes(&self) -> [Axis; 3] {
        [self.axis, self.machine_direction, self.axis.cross(self.machine_direction)]
    }

    /// The machine direction if the case does not give it. The cross direction is then an axis of the field in its
    /// positive sense: that along which the air is the same, if there is one across the fibre, so that the machine
    /// direction lies in the plane of a plane flow; else z, x or y for a fibre along x, y or z.
    pub fn usual_machine_direction(field: &Field, axis: Axis) -> Axis {
        let even = field.even_axis().filter(|even| *even != axis.index);
        Axis { index: even.unwrap_or((axis.index + 2) % 3), backwards: false }.cross(axis)
    }

    pub(super) fn at(&self, at: Vec3<f64>, hint: &mut Hint) -> Local {
        let local = self.field.sample(self.in_field(at), hint);
        Local { velocity: self.turned_back(local.velocity), ..local }
    }

    /// Why there is no air at a place of the fibre, if the file has no numbers there.
    pub fn why_no_air(&self, at: Vec3<f64>) -> Option<Fault> {
        self.field.why_no_air(self.in_field(at))
    }

    /// The air around a place of the fibre's frame [m], linear in space, in that frame.
    pub(super) fn around(&self, at: Vec3<f64>, hint: &mut Hint) -> AirAround {
        let AirAround { value, gradients, reach, inside } = self.field.around(self.in_field(at), hint);
        let axes = self.axes();
        let turned = |[u, v, w, root_k]: [f64; 4]| {
            let v = to_fibre(axes, Vec3::new(u, v, w));
            [v.x, v.y, v.z, root_k]
        };
        let along = |axis: Axis| {
            let per_metre = if axis.backwards { -1.0 / self.unit } else { 1.0 / self.unit };
            turned(gradients[axis.index].map(|change| per_metre * change))
        };
        AirAround { value: turned(value), gradients: axes.map(along), reach: reach * self.unit, inside }
    }

    /// Upper limit for the length of an eddy: the diagonal of the field's box [m].
    pub(super) fn size(&self) -> f64 {
        let (low, high) = self.field.bounds();
        (high - low).norm() * self.unit
    }

    /// The lowest and the highest coordinates of the field in the fibre's frame [m].
    pub fn extent(&self) -> (Vec3<f64>, Vec3<f64>) {
        let (low, high) = self.field.bounds();
        let [a, b] = [low, high].map(|corner| self.in_fibre_frame(corner * self.unit));
        let least = |a: f64, b: f64| (a.min(b), a.max(b));
        let (x0, x1) = least(a.x, b.x);
        let (y0, y1) = least(a.y, b.y);
        let (z0, z1) = least(a.z, b.z);
        (Vec3::new(x0, y0, z0), Vec3::new(x1, y1, z1))
    }

    /// The direction of the field along which most of the air flows, and the share of the mean velocity that
    /// goes there.
    pub fn main_direction(&self) -> (Axis, f64) {
        let mean = self.field.overview().velocity;
        let along = |axis: Axis| axis.part_of(mean) / mean.norm();
        let [first, others @ ..] = Axis::ALL.map(|axis| (axis, along(axis)));
        others.into_iter().fold(first, |a, b| if b.1 > a.1 { b } else { a })
    }

    /// The middle of the side where x enters the field's box [m]. This is the default place of the root.
    pub fn middle_of_inlet(field: &Field, axis: Axis, unit: f64) -> Vec3<f64> {
        let (low, high) = field.bounds();
        let middle = (low + high) * 0.5;
        let inlet = if axis.backwards { high } else { low };
        let mut root = middle;
        match axis.index {
            0 => root.x = inlet.x,
            1 => root.y = inlet.y,
            _ => root.z = inlet.z,
        }
        root * unit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identical_after_turning_there_and_back_and_right_handed() {
        let x = Vec3::new(1.0, 0.0, 0.0);
        let y = Vec3::new(0.0, 1.0, 0.0);
        let z = Vec3::new(0.0, 0.0, 1.0);
        let names = ["x", "y", "z", "-x", "-y", "-z"];
        assert_eq!(Axis::ALL.map(Axis::name), names);
        let across = |axis: Axis| Axis::ALL.into_iter().filter(move |other| other.index != axis.index);
        for (axis, machine) in Axis::ALL.into_iter().flat_map(|axis| across(axis).map(move |m| (axis, m))) {
            let axes = [axis, machine, axis.cross(machine)];
            let turned = [x, y, z].map(|unit| to_field(axes, unit));
            for (axis, turned) in axes.into_iter().zip(turned) {
                assert_eq!(
                    [turned.x, turned.y, turned.z][axis.index],
                    if axis.backwards { -1.0 } else { 1.0 }
                );
            }
            assert_eq!(turned[1].cross(turned[2]), turned[0]);
            let v = Vec3::new(1.0, 2.0, 3.0);
            assert_eq!(to_fibre(axes, to_field(axes, v)), v);
        }
    }
}
