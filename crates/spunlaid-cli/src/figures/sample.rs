//! Made-up results for the tests.

use spunlaid::air::Air;
use spunlaid::case::{Case, Run};
use spunlaid::chain::schemes::Scheme;
use spunlaid::drag::{Drag, FrictionLaw, NormalLaw};
use spunlaid::ensemble::{Results, Sample, Shape, SpectrumPoint, Trajectory};
use spunlaid::fibre::{Fibre, Root};
use spunlaid::observe::{DECLARED, Kind, Measure, Value};
use spunlaid::vec3::Vec3;

/// The case of the paper's Table 1 with another mesh and so many recorded instants, 1 ms apart.
pub(crate) fn case(elements: usize, instants: usize, replicates: u64) -> Case {
    Case {
        fibre: Fibre {
            length: 1.0,
            diameter: 50e-6,
            density: 950.0,
            youngs_modulus: 2e9,
            bending_viscosity_time: 0.0,
            elements,
            root: Root::Pinned,
            direction: Vec3::new(1.0, 0.0, 0.0),
        },
        air: Air::uniform(10.0, 0.1, 0.05, 100.0),
        drag: Drag { along: FrictionLaw::Matsui { factor: 0.9 }, across: NormalLaw::JuShambaugh },
        line: None,
        run: Run {
            time_step: 1e-3,
            steps: instants as u64 - 1,
            spin_up_steps: 0,
            output_steps: 1,
            replicates,
            seed: 1,
            scheme: Scheme::SemiImplicitEuler,
            gravity: 9.81,
            damping: 0.0,
            shapes: None,
        },
    }
}

/// Results of swings of `amplitude` [m] at 17 Hz.
pub(crate) fn results(case: &Case, amplitude: f64) -> Results {
    let nodes = case.fibre.elements + 1;
    let mut collector = Results::collector(8);
    for replicate in 0..case.run.replicates {
        collector.take(&trajectory(case, nodes, replicate, amplitude));
    }
    collector.finish()
}

fn trajectory(case: &Case, nodes: usize, replicate: u64, amplitude: f64) -> Trajectory {
    let position = |time: f64, node: usize| {
        let along = node as f64 / (nodes - 1) as f64;
        let phase = 107.0 * time + replicate as f64;
        Vec3::new(along, amplitude * along * phase.sin(), amplitude * along * (1.1 * phase).cos())
    };
    let instants = 0..=case.run.steps;
    let times: Vec<f64> = instants.map(|i| i as f64 * case.run.time_step).collect();
    let sample = |&time: &f64| Sample {
        time,
        end: position(time, nodes - 1),
        kinetic: amplitude * time,
        work: amplitude * time * (1.0 + 1e-4 * (time * 50.0).sin()),
        air_work: amplitude * time,
        imbalance: amplitude * 1e-6 * time,
        ..Sample::default()
    };
    let shape = |&time: &f64| Shape { time, position: (0..nodes).map(|node| position(time, node)).collect() };
    let samples: Vec<Sample> = times.iter().map(sample).collect();
    let frequency = if amplitude == 0.0 { 0.0 } else { 17.0 + 0.1 * replicate as f64 };
    let along = |share: f64| {
        let of =
            |node: usize| share * amplitude * node as f64 / nodes as f64 * (1.0 + 0.01 * replicate as f64);
        Value::Curve(
            (0..nodes).map(|node| node as f64 / (nodes - 1) as f64).collect(),
            (0..nodes).map(of).collect(),
        )
    };
    let spectrum = || {
        let frequencies: Vec<f64> = (1..100).map(f64::from).collect();
        let density = frequencies.iter().map(|f| amplitude * amplitude / (1.0 + f * f)).collect();
        Value::Curve(frequencies, density)
    };
    let over_time = |of: fn(&Sample) -> f64| Value::Curve(times.clone(), samples.iter().map(of).collect());
    let value = |measure: &Measure| match measure.name {
        "amplitude_y" => Value::Number(amplitude),
        "amplitude_z" => Value::Number(amplitude * (1.0 + 0.01 * replicate as f64)),
        "frequency_y" | "frequency_z" => Value::Number(frequency),
        "mean_x" => Value::Number(position(0.0, nodes - 1).x),
        "amplitude_y_along_fibre" => along(1.0),
        "amplitude_z_along_fibre" => along(0.9),
        "work_error_over_time" => over_time(Sample::work_error_percent),
        "balance_error_over_time" => over_time(Sample::balance_error_percent),
        _ => match measure.kind {
            Kind::Number => Value::Number(1e-4),
            Kind::Profile | Kind::Way | Kind::Lag | Kind::Direction => along(0.5),
            Kind::Series => over_time(|sample| sample.time),
            Kind::Spectrum => spectrum(),
        },
    };
    let applied = DECLARED.iter().filter(|declared| (declared.applies)(case));
    let values = applied.flat_map(|declared| declared.measures).map(|measure| (measure, value(measure)));
    Trajectory { replicate, values: values.collect(), shapes: times.iter().map(shape).collect(), samples, ..Trajectory::default() }
}

/// A spectrum of turbulence.
pub(crate) fn turbulence() -> Vec<SpectrumPoint> {
    let point = |i: i32| {
        let frequency = f64::from(i) * 4.0;
        SpectrumPoint { frequency, realised: 0.01, wanted: 0.01 }
    };
    (1..100).map(point).collect()
}
