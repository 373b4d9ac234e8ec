//! What is measured while the fibres fly.

use crate::lanes::Lanes;
use crate::vec3::Vec3;

/// Running statistics of the end nodes of eight fibres, taken every step.
#[derive(Clone, Copy, Debug, Default)]
pub struct EndNodeObserver {
    count: f64,
    mean: Vec3<Lanes>,
    /// Sums of squared deviations from the mean, of y and z.
    squares: [Lanes; 2],
    crossings: [Lanes; 2],
    /// Side of the x-z and of the x-y plane last seen: −1, +1, or 0 before the node left the plane.
    side: [Lanes; 2],
}

/// Motion of one fibre's end node over the observed time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EndNodeMotion {
    /// Standard deviation of y over time [m].
    pub amplitude_y: f64,
    /// Standard deviation of z over time [m].
    pub amplitude_z: f64,
    /// Half the sign changes of y, by the observed time [Hz].
    pub frequency_y: f64,
    /// Half the sign changes of z, by the observed time [Hz].
    pub frequency_z: f64,
    /// Mean position [m].
    pub mean: Vec3<f64>,
}

impl EndNodeObserver {
    /// Takes in one more position (Welford's running mean and variance).
    #[inline(always)]
    pub fn see(&mut self, position: Vec3<Lanes>) {
        self.count += 1.0;
        let share = Lanes::splat(1.0 / self.count);
        let off = position - self.mean;
        self.mean = off.mul_add(share, self.mean);
        let rest = position - self.mean;
        self.squares[0] = off.y.mul_add(rest.y, self.squares[0]);
        self.squares[1] = off.z.mul_add(rest.z, self.squares[1]);
        for (i, y) in [position.y, position.z].into_iter().enumerate() {
            let (zero, one) = (Lanes::ZERO, Lanes::splat(1.0));
            let on_plane = self.side[i];
            let side = Lanes::select_less(zero, y, one, Lanes::select_less(y, zero, -one, on_plane));
            self.crossings[i] += Lanes::select_less(side * self.side[i], zero, one, zero);
            self.side[i] = side;
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
