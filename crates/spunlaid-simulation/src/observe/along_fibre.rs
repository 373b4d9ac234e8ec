//! Amplitude of each node of the fibre.

use super::{Declaration, FIBRE, FibreMeasure, Observation, Observer, fixed, number_of_each};
use spunlaid_fibre::Flight;
use spunlaid_fibre::chain::forces::Element;
use spunlaid_ground::measure::figure;
use spunlaid_ground::{
    Figure, Isa, Lanes, MILLIMETRES, Measure, MeasureKind, PER_METRE, Register, Task, Value, Vec3, WIDTH,
    Wide,
};

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[
        AMPLITUDE
            .observed(
                "amplitude_y_along_fibre",
                "amplitude_y_along_fibre_m",
                "Amplitude in y along the fibre",
            )
            .series("*y*"),
        AMPLITUDE
            .observed(
                "amplitude_z_along_fibre",
                "amplitude_z_along_fibre_m",
                "Amplitude in z along the fibre",
            )
            .series("*z*"),
    ],
    applies: fixed,
    observer: |flight| Box::new(Spread::new(flight)),
};

const AMPLITUDE: FibreMeasure = Measure {
    meaning: "standard deviation over time of each node’s position",
    unit: MILLIMETRES,
    kind: MeasureKind::Profile,
    group: FIBRE,
    figure: &Figure {
        caption: "Amplitude of each node: the standard deviation of its y and z over time.",
        ..figure("amplitude_along_fibre", "Amplitude along the fibre", "amplitude along the fibre")
    },
    ..Measure::NUMBER
};

/// Running mean and variance of every node at the recorded instants (Welford).
#[derive(Debug)]
struct Spread {
    rest_length: [f64; WIDTH],
    count: f64,
    /// Mean of y and z, and the sums of the squared deviations from it.
    nodes: Vec<([Lanes; 2], [Lanes; 2])>,
}

impl Spread {
    fn new(flight: &Flight) -> Self {
        let nodes = vec![Default::default(); flight.chain().elements() + 1];
        Self { rest_length: number_of_each(flight, |case| case.fibre.rest_length()), count: 0.0, nodes }
    }
}

impl Observer for Spread {
    fn see(&mut self, observation: &Observation<'_>) {
        if !observation.settled {
            return;
        }
        self.count += 1.0;
        let share = Lanes::splat(1.0 / self.count);
        for ((mean, squares), &Vec3 { y, z, .. }) in self.nodes.iter_mut().zip(&observation.snapshot.position)
        {
            for ((mean, squares), p) in mean.iter_mut().zip(squares).zip([y, z]) {
                let off = p - *mean;
                *mean = *mean + off * share;
                *squares = *squares + off * (p - *mean);
            }
        }
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        let distance: Vec<f64> = (0..self.nodes.len()).map(|i| i as f64 * self.rest_length[lane]).collect();
        let deviation = |squares: &Lanes| (squares.0[lane] / self.count).sqrt();
        let deviations =
            |axis: usize| self.nodes.iter().map(|(_, squares)| deviation(&squares[axis])).collect();
        vec![Value::Curve(distance.clone(), deviations(0)), Value::Curve(distance, deviations(1))]
    }
}

pub(super) const CURVATURE: Declaration = Declaration {
    measures: &[Measure {
        name: "curvature",
        column: "curvature_per_m",
        label: "Curvature along the fibre",
        meaning: "root mean square over time of the curvature 2 sin(θ/2)/l at each node, with the angle θ \
            between its two elements",
        unit: PER_METRE,
        kind: MeasureKind::Profile,
        group: FIBRE,
        figure: &Figure {
            caption: "Curvature at each node: the root mean square over time of one over the bending radius. \
                Bends that are shorter than an element are not resolved.",
            ..figure("curvature_along_fibre", "Curvature along the fibre", "curvature along the fibre")
        },
        series: "rms",
        ..Measure::NUMBER
    }],
    applies: fixed,
    observer: |flight| Box::new(Curvature::new(flight)),
};

/// Sums of squares at the nodes between two elements.
#[derive(Debug)]
struct Curvature {
    isa: Isa,
    rest_length: [f64; WIDTH],
    count: f64,
    /// Sums of `|t₁ − t₀|²` with the tangents `t` of the two elements [-].
    squares: Vec<Lanes>,
}

impl Curvature {
    fn new(flight: &Flight) -> Self {
        let squares = vec![Lanes::ZERO; flight.chain().elements().saturating_sub(1)];
        let rest_length = number_of_each(flight, |case| case.fibre.rest_length());
        Self { isa: flight.isa(), rest_length, count: 0.0, squares }
    }
}

impl Observer for Curvature {
    fn see(&mut self, observation: &Observation<'_>) {
        if observation.settled {
            self.count += 1.0;
            self.isa.run(Turns { position: &observation.snapshot.position, squares: &mut self.squares });
        }
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        let rest_length = self.rest_length[lane];
        let distance = (0..self.squares.len()).map(|i| (i + 1) as f64 * rest_length).collect();
        let rms = |squares: &Lanes| (squares.0[lane] / self.count).sqrt() / rest_length;
        vec![Value::Curve(distance, self.squares.iter().map(rms).collect())]
    }
}

/// Adds the squared change of the tangent from each element to the next.
struct Turns<'a> {
    position: &'a [Vec3<Lanes>],
    squares: &'a mut [Lanes],
}

impl Task for Turns<'_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        let mut above: Option<Vec3<Wide<S>>> = None;
        let mut squares = self.squares.iter_mut();
        for pair in self.position.windows(2) {
            let below = Element::<S>::between(Vec3::load(&pair[0]), Vec3::load(&pair[1])).tangent;
            if let Some(above) = above
                && let Some(sum) = squares.next()
            {
                let turn = below - above;
                *sum = (Wide::load(sum) + turn.dot(turn)).store();
            }
            above = Some(below);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_curvature_of_a_circle() {
        // For a regular polygon with 60 corners and radius R = 0.2 m, 2 sin(θ/2)/l is exactly 1/R.
        let corner = |i: usize| {
            let angle = std::f64::consts::TAU * i as f64 / 60.0;
            Vec3::splat(Vec3::new(0.2 * angle.cos(), 0.2 * angle.sin(), 0.0))
        };
        let position: Vec<Vec3<Lanes>> = (0..20).map(corner).collect();
        let length = (position[1].lane(0) - position[0].lane(0)).norm();
        let mut squares = vec![Lanes::ZERO; 18];
        Isa::detect().run(Turns { position: &position, squares: &mut squares });
        for sum in squares {
            assert!((sum.0[5].sqrt() / length - 1.0 / 0.2).abs() < 1e-10);
        }
    }
}
