//! Made-up results for the tests.

use spunlaid_air::Air;
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Case, Contact, Drag, Fibre, FrictionLaw, LaidPoint, Line, NormalLaw, Root, Run};
use spunlaid_ground::{MeasureKind, Value, Vec3};
use spunlaid_simulation::ensemble::Sample;
use spunlaid_simulation::{DECLARED, FibreMeasure, Results, Shape, SpectrumPoint, Trajectory};

/// The case of the paper's Table 1 with another mesh and so many recorded instants, 1 ms apart.
pub fn case(elements: usize, instants: usize, replicates: u64) -> Case {
    Case {
        fibre: Fibre {
            length: 1.0,
            diameter: 50e-6,
            density: 950.0,
            youngs_modulus: 2e9,
            elements,
            root: Root::Pinned,
            direction: Vec3::new(1.0, 0.0, 0.0),
            ..Fibre::UNKNOWN
        },
        air: Air::uniform(10.0, 0.1, 0.05, 100.0),
        drag: Drag { along: FrictionLaw::Matsui { factor: 0.9 }, across: NormalLaw::JuShambaugh },
        line: None,
        spinline: None,
        run: Run {
            time_step: 1e-3,
            steps: instants as u64 - 1,
            output_steps: 1,
            replicates,
            seed: 1,
            scheme: Scheme::SemiImplicitEuler,
            gravity: 9.81,
            damping: 0.0,
            ..Run::UNKNOWN
        },
    }
}

/// Results of swings of `amplitude` [m] at 17 Hz.
pub fn results(case: &Case, amplitude: f64) -> Results {
    let nodes = case.fibre.elements + 1;
    let mut collector = Results::collector(8);
    for replicate in 0..case.run.replicates {
        collector.take(trajectory(case, nodes, replicate, amplitude));
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
        let amplitude_of_node =
            |node: usize| share * amplitude * node as f64 / nodes as f64 * (1.0 + 0.01 * replicate as f64);
        Value::Curve(
            (0..nodes).map(|node| node as f64 / (nodes - 1) as f64).collect(),
            (0..nodes).map(amplitude_of_node).collect(),
        )
    };
    let spectrum = || {
        let frequencies: Vec<f64> = (1..100).map(f64::from).collect();
        let density = frequencies.iter().map(|f| amplitude * amplitude / (1.0 + f * f)).collect();
        Value::Curve(frequencies, density)
    };
    let over_time =
        |quantity: fn(&Sample) -> f64| Value::Curve(times.clone(), samples.iter().map(quantity).collect());
    let value = |measure: &FibreMeasure| match measure.name {
        "amplitude_y" => Value::Number(amplitude),
        "amplitude_z" => Value::Number(amplitude * (1.0 + 0.01 * replicate as f64)),
        "frequency_y" | "frequency_z" => Value::Number(frequency),
        "mean_x" => Value::Number(position(0.0, nodes - 1).x),
        "amplitude_y_along_fibre" => along(1.0),
        "amplitude_z_along_fibre" => along(0.9),
        "work_error_over_time" => over_time(Sample::work_error_percent),
        "balance_error_over_time" => over_time(Sample::balance_error_percent),
        _ => match measure.kind {
            MeasureKind::Number => Value::Number(1e-4),
            MeasureKind::Profile | MeasureKind::Way | MeasureKind::Lag | MeasureKind::Direction => along(0.5),
            MeasureKind::Series => over_time(|sample| sample.time),
            MeasureKind::Spectrum => spectrum(),
        },
    };
    let applied = DECLARED.iter().filter(|declared| (declared.applies)(case));
    let values = applied.flat_map(|declared| declared.measures).map(|measure| (measure, value(measure)));
    Trajectory {
        replicate,
        values: values.collect(),
        shapes: times.iter().map(shape).collect(),
        path: samples.iter().collect(),
        ..Trajectory::default()
    }
}

/// A fed fibre with so many recorded instants, 1 ms apart. An element of 5 mm is fed in a tenth of that.
pub fn fed_case(instants: usize, replicates: u64) -> Case {
    let case = case(100, instants, replicates);
    Case {
        fibre: Fibre { length: 0.5, ..case.fibre },
        line: Some(Line {
            feed_speed: 50.0,
            distance: 0.5,
            belt_speed: 3.0,
            contact: Contact::Stick,
            kept_length: 0.03,
            steps_per_element: 1,
        }),
        run: Run { time_step: 1e-4, steps: 10 * (instants as u64 - 1), output_steps: 10, ..case.run },
        ..case
    }
}

/// Results of a fed fibre that lays circles of 20 mm, with six nodes on the belt that have not left the chain.
pub fn fed_results(case: &Case, keep: usize) -> Results {
    let mut collector = Results::collector(keep);
    (0..case.run.replicates).for_each(|replicate| collector.take(fed_trajectory(case, replicate)));
    collector.finish()
}

/// Where node `number` of a fed fibre is at a time, counted from the first that was fed.
fn fed_node(case: &Case, replicate: u64, number: u64, time: f64) -> Vec3<f64> {
    let line = case.line.unwrap();
    let fed = number as f64 * case.fibre.rest_length();
    let fallen = line.feed_speed * time - fed;
    let phase = fed / 0.02 + replicate as f64;
    let landed = (fallen - line.distance).max(0.0) / line.feed_speed;
    let share = (fallen / line.distance).min(1.0);
    let (y, z) = (0.02 * share * phase.cos(), 0.02 * share * phase.sin());
    Vec3::new(fallen.min(line.distance), y + line.belt_speed * landed, z)
}

fn fed_trajectory(case: &Case, replicate: u64) -> Trajectory {
    const KEPT: u64 = 6;
    let (line, length) = (case.line.unwrap(), case.fibre.rest_length());
    let in_air = (line.distance / length).round() as u64;
    let root = |time: f64| 2 + (time * line.feed_speed / length).round() as u64;
    let oldest = |time: f64| root(time).saturating_sub(in_air + KEPT);
    let instants = case.run.steps / case.run.output_steps;
    let times: Vec<f64> = (0..=instants).map(|i| i as f64 * 1e-3).collect();
    let position = |time: f64| {
        let nodes = (oldest(time)..=root(time)).rev();
        nodes.map(|number| fed_node(case, replicate, number, time)).collect()
    };
    let end = times.last().copied().unwrap_or(0.0);
    let laid = (0..oldest(end)).map(|number| {
        let fed = number as f64 * length;
        let time = (fed + line.distance) / line.feed_speed;
        let at = fed_node(case, replicate, number, time);
        LaidPoint { fed, time, md: at.y - line.belt_speed * time, cd: at.z }
    });
    let curve = |from: f64| {
        let at = |i: i32| f64::from(i) * 10.0;
        Value::Curve((0..36).map(at).collect(), (0..36).map(|i| from / (1.0 + at(i) / 100.0)).collect())
    };
    let value = |measure: &FibreMeasure| match measure.kind {
        MeasureKind::Number => Value::Number(0.014 + 1e-4 * replicate as f64),
        MeasureKind::Series => Value::Curve(times.clone(), times.clone()),
        _ => curve(1.0 + 0.01 * replicate as f64),
    };
    let applied = DECLARED.iter().filter(|declared| (declared.applies)(case));
    let values = applied.flat_map(|declared| declared.measures).map(|measure| (measure, value(measure)));
    Trajectory {
        replicate,
        values: values.collect(),
        shapes: times.iter().map(|&time| Shape { time, position: position(time) }).collect(),
        laid: laid.collect(),
        ..Trajectory::default()
    }
}

/// A spectrum of turbulence.
pub fn turbulence() -> Vec<SpectrumPoint> {
    let point = |i: i32| {
        let frequency = f64::from(i) * 4.0;
        SpectrumPoint { frequency, synthesised: 0.01, wanted: 0.01 }
    };
    (1..100).map(point).collect()
}
