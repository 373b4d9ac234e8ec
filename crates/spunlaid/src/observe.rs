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

/// Running mean and spread of every node of eight fibres, taken at the recorded instants.
#[derive(Clone, Debug)]
pub struct SpreadObserver {
    count: f64,
    nodes: Vec<(Vec3<Lanes>, [Lanes; 2])>,
}

/// Motion of a node over time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NodeSpread {
    /// Mean position [m].
    pub mean: Vec3<f64>,
    /// Standard deviation of y [m].
    pub amplitude_y: f64,
    /// Standard deviation of z [m].
    pub amplitude_z: f64,
}

impl SpreadObserver {
    /// For chains of so many nodes.
    pub fn new(nodes: usize) -> Self {
        Self { count: 0.0, nodes: vec![Default::default(); nodes] }
    }

    /// Takes in the positions of all nodes at one more instant.
    pub fn see(&mut self, position: &[Vec3<Lanes>]) {
        self.count += 1.0;
        let share = Lanes::splat(1.0 / self.count);
        for ((mean, squares), &p) in self.nodes.iter_mut().zip(position) {
            let off = p - *mean;
            *mean = off.mul_add(share, *mean);
            let rest = p - *mean;
            squares[0] = off.y.mul_add(rest.y, squares[0]);
            squares[1] = off.z.mul_add(rest.z, squares[1]);
        }
    }

    /// The nodes' motion in one lane.
    pub fn nodes(&self, lane: usize) -> Vec<NodeSpread> {
        let deviation = |squares: Lanes| (squares.0[lane] / self.count).sqrt();
        self.nodes
            .iter()
            .map(|&(mean, squares)| NodeSpread {
                mean: mean.lane(lane),
                amplitude_y: deviation(squares[0]),
                amplitude_z: deviation(squares[1]),
            })
            .collect()
    }
}
