//! Statistics of the free ends, taken at every step.

use crate::lanes::{Lanes, Register, Wide};
use crate::vec3::Vec3;

/// Running statistics of the end nodes of eight fibres, taken every step.
#[derive(Clone, Copy, Debug, Default)]
pub struct EndNodeStatistics {
    count: f64,
    mean: Vec3<Lanes>,
    /// Sums of squared deviations from the mean, of y and z.
    squares: [Lanes; 2],
    crossings: [Lanes; 2],
    /// Last side of the x-z plane and of the x-y plane: −1, +1, or 0 before the node left the plane.
    side: [Lanes; 2],
}

/// Motion of one fibre's end node over the observed time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EndNodeMotion {
    /// Standard deviation of y over time [m].
    pub amplitude_y: f64,
    /// Standard deviation of z over time [m].
    pub amplitude_z: f64,
    /// Half the number of sign changes of y, divided by the observed time [Hz].
    pub frequency_y: f64,
    /// Half the number of sign changes of z, divided by the observed time [Hz].
    pub frequency_z: f64,
    /// Mean position [m].
    pub mean: Vec3<f64>,
}

impl EndNodeStatistics {
    /// Adds one more position (Welford's running mean and variance).
    #[inline(always)]
    pub(crate) fn see<S: Register>(&mut self, position: &Vec3<Lanes>) {
        self.count += 1.0;
        let share = Wide::<S>::splat(1.0 / self.count);
        let position = Vec3::load(position);
        let off = position - Vec3::load(&self.mean);
        let mean = off.mul_add(share, Vec3::load(&self.mean));
        self.mean = mean.store();
        let rest = position - mean;
        let (zero, one) = (Wide::zero(), Wide::splat(1.0));
        for (i, (y, off, rest)) in
            [(position.y, off.y, rest.y), (position.z, off.z, rest.z)].into_iter().enumerate()
        {
            self.squares[i] = off.mul_add(rest, Wide::load(&self.squares[i])).store();
            let last = Wide::load(&self.side[i]);
            let side = Wide::select_less(zero, y, one, Wide::select_less(y, zero, -one, last));
            let crossing = Wide::select_less(side * last, zero, one, zero);
            self.crossings[i] = (Wide::load(&self.crossings[i]) + crossing).store();
            self.side[i] = side.store();
        }
    }

    /// The motion in one lane, observed over `time` [s].
    pub fn motion(&self, lane: usize, time: f64) -> EndNodeMotion {
        let deviation = |squares: Lanes| (squares.0[lane] / self.count).sqrt();
        let frequency = |crossings: Lanes| crossings.0[lane] / 2.0 / time;
        EndNodeMotion {
            amplitude_y: deviation(self.squares[0]),
            amplitude_z: deviation(self.squares[1]),
            frequency_y: frequency(self.crossings[0]),
            frequency_z: frequency(self.crossings[1]),
            mean: self.mean.lane(lane),
        }
    }
}
