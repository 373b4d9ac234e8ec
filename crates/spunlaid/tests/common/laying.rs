//! Fed fibres for the tests: a spunbond line from its case file, and a heavy thread that coils on a plane.
#![allow(dead_code, clippy::unwrap_used)]

use spunlaid_air::Air;
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Case, Contact, Fibre, Flight, Job, LaidPoint, Line, Root, Run};
use spunlaid_ground::Isa;
use spunlaid_input::read_case;
use std::f64::consts::PI;
use std::ops::Range;
use std::path::Path;

pub const GRAVITY: f64 = 9.81;

/// `cases/spunbond.toml` with other values.
pub fn spunbond(set: &[(&str, &str)]) -> Case {
    let set: Vec<_> = set.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    read_case(Path::new("../../cases/spunbond.toml"), &set).unwrap().0
}

/// Replicates of a case at their start, side by side.
pub fn flight(case: &Case, replicates: Range<u64>) -> Flight {
    let jobs: Vec<Job> = replicates.map(|replicate| Job::new(case, replicate)).collect();
    Flight::new(&jobs, Isa::detect()).unwrap()
}

/// What the fibres of a flight have laid until a time [s].
pub fn laid_until(flight: &mut Flight, time: f64) -> Vec<Vec<LaidPoint>> {
    flight.step_to(time).unwrap();
    (0..flight.fibres()).map(|lane| flight.take_laid(lane)).collect()
}

/// A heavy thread that is fed slowly from a clamp on to a plane below it, in vacuum.
#[derive(Clone, Copy, Debug)]
pub struct Thread {
    /// `G = wH³/EI`
    pub g: f64,
    /// Height of the clamp above the plane [m].
    pub height: f64,
    /// The thicker it is, the softer is its material, and the longer is the step of an explicit scheme [m].
    pub diameter: f64,
    /// Length of an element [H].
    pub element: f64,
    /// Time of the bending viscosity [√(H/g)].
    pub viscosity: f64,
    /// Speed of the plane over that of the feed.
    pub belt: f64,
    pub scheme: Scheme,
    /// Part of half the longest stable step that is used.
    pub step: f64,
}

impl Thread {
    /// Feed speed [√(gH)].
    pub const SPEED: f64 = 0.05;
    /// Damping [√(g/H)].
    pub const DAMPING: f64 = 0.1;

    pub fn new(g: f64) -> Self {
        let scheme = Scheme::ImplicitTension;
        Self { g, height: 0.1, diameter: 3e-4, element: 0.05, viscosity: 1e-3, belt: 0.0, scheme, step: 1.0 }
    }

    pub fn feed_speed(&self) -> f64 {
        Self::SPEED * (GRAVITY * self.height).sqrt()
    }

    /// Time in which the fibre is fed that lies in so many circles of the radius of 0.4 H [s].
    pub fn time_of_turns(&self, turns: f64) -> f64 {
        turns * 2.0 * PI * 0.4 * self.height / self.feed_speed()
    }

    /// Weight per length [N/m].
    pub fn weight(&self) -> f64 {
        self.fibre().density * self.fibre().cross_section() * GRAVITY
    }

    fn fibre(&self) -> Fibre {
        let (diameter, density) = (self.diameter, 1000.0);
        Fibre {
            length: self.height,
            diameter,
            density,
            youngs_modulus: 16.0 * density * GRAVITY * self.height.powi(3) / (self.g * diameter * diameter),
            bending_viscosity_time: self.viscosity * (self.height / GRAVITY).sqrt(),
            elements: (1.0 / self.element).round() as usize,
            root: Root::Clamped,
            ..Fibre::UNKNOWN
        }
    }

    /// A case of so many seconds.
    pub fn case(&self, duration: f64) -> Case {
        let fibre = self.fibre();
        let (feed_speed, length) = (self.feed_speed(), fibre.rest_length());
        let air = Air { density: 0.0, harmonics: 16, ..Air::uniform(0.0, 0.0, 0.5 * self.height, 10.0) };
        let run = Run {
            time_step: 1.0,
            steps: 1,
            output_steps: 100,
            seed: 1,
            scheme: self.scheme,
            gravity: GRAVITY,
            damping: Self::DAMPING * (GRAVITY / self.height).sqrt(),
            ..Run::UNKNOWN
        };
        let line = Line {
            feed_speed,
            distance: self.height,
            belt_speed: self.belt * feed_speed,
            contact: Contact::Stick,
            kept_length: 5.0 * length,
            steps_per_element: 1,
        };
        let mut case = Case { fibre, air, drag: super::paper_drag(), line: Some(line), spinline: None, run };
        let limits = case.stable_step_limits();
        let limit = limits.into_iter().map(|limit| limit.limit).fold(f64::INFINITY, f64::min);
        // As many steps as a whole number of births takes, so that a share of the step has a share of the steps.
        let steps = (length / feed_speed / (0.5 * limit)).ceil().max(2.0) / self.step;
        case.line.as_mut().unwrap().steps_per_element = steps.round() as u64;
        case.run.time_step = length / feed_speed / steps.round();
        case.run.steps = (duration / case.run.time_step).round().max(1.0) as u64;
        case
    }

    /// What it lays in a time [s].
    pub fn laid(&self, duration: f64) -> Vec<LaidPoint> {
        laid_until(&mut flight(&self.case(duration), 0..1), duration).remove(0)
    }
}

/// A circle through points on the belt.
#[derive(Clone, Copy, Debug)]
pub struct Circle {
    pub centre: [f64; 2],
    pub radius: f64,
    /// Root mean square distance of the points from it.
    pub apart: f64,
}

/// The circle whose squared distances from the points, `|p − c|² − R²`, are smallest on average square.
pub fn circle_through(points: &[LaidPoint]) -> Circle {
    let count = points.len() as f64;
    let mean = |quantity: &dyn Fn(&LaidPoint) -> f64| points.iter().map(quantity).sum::<f64>() / count;
    let (my, mz) = (mean(&|p| p.md), mean(&|p| p.cd));
    let centred = |p: &LaidPoint| (p.md - my, p.cd - mz);
    let sum = |product: &dyn Fn(f64, f64) -> f64| {
        mean(&|p| {
            let (y, z) = centred(p);
            product(y, z)
        })
    };
    let yy = sum(&|y, _| y * y);
    let zz = sum(&|_, z| z * z);
    let yz = sum(&|y, z| y * z);
    let (ry, rz) = (sum(&|y, z| y * (y * y + z * z)), sum(&|y, z| z * (y * y + z * z)));
    let determinant = 2.0 * (yy * zz - yz * yz);
    let cy = (ry * zz - rz * yz) / determinant;
    let cz = (rz * yy - ry * yz) / determinant;
    let radius = (cy * cy + cz * cz + yy + zz).sqrt();
    let apart = sum(&|y, z| ((y - cy).hypot(z - cz) - radius).powi(2)).sqrt();
    Circle { centre: [my + cy, mz + cz], radius, apart }
}

/// Angles by which a laid fibre turns at its points [turns], positive to the cross direction.
pub fn turning(points: &[LaidPoint]) -> Vec<f64> {
    let chord = |pair: &[LaidPoint]| (pair[1].md - pair[0].md, pair[1].cd - pair[0].cd);
    points
        .windows(3)
        .map(|three| {
            let (a, b) = (chord(&three[..2]), chord(&three[1..]));
            (a.0 * b.1 - a.1 * b.0).atan2(a.0 * b.0 + a.1 * b.1) / (2.0 * PI)
        })
        .collect()
}
