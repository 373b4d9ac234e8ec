//! Sources of flights in fields whose air every mesh gives exactly.

use super::watch::see;
use super::*;
use spunlaid_air::{Air, Axis, Cells, Field, FileContent, Flow, PlacedField, Shape, Values};
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{End, Fibre, Flight, Line, Melt, Polymer, Root, SolidFilament, Spinline};
use spunlaid_ground::{Isa, Vec3};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64};

const WAY: f64 = 0.3;
const HALF: f64 = 0.15;
/// Air that pulls filaments straight [m/s].
const FAST: f64 = 80.0;

/// Air that slows from 40 to 10 m/s and widens as much, which every mesh of its points gives exactly.
fn velocity(at: Vec3<f64>) -> Vec3<f64> {
    Vec3::new(40.0 - 100.0 * at.x, 100.0 * at.y, 0.0)
}

fn values(points: &[Vec3<f64>]) -> Values {
    values_of(points, velocity)
}

fn values_of(points: &[Vec3<f64>], velocity: impl Fn(Vec3<f64>) -> Vec3<f64>) -> Values {
    Values { velocity: points.iter().map(|at| velocity(*at)).collect(), ..Values::default() }
}

fn row(cells: usize, from: f64, to: f64) -> Vec<f64> {
    (0..=cells).map(|i| from + (to - from) * i as f64 / cells as f64).collect()
}

/// A lattice of so many cells; of one point along z if there are none.
fn lattice(cells: [usize; 3]) -> PlacedField {
    placed(field_of(cells, velocity))
}

fn field_of([nx, ny, nz]: [usize; 3], velocity: impl Fn(Vec3<f64>) -> Vec3<f64>) -> Field {
    let z = if nz == 0 { vec![0.0] } else { row(nz, 0.0, 0.4) };
    let axes = [row(nx, 0.0, WAY), row(ny, -HALF, HALF), z];
    let points: Vec<Vec3<f64>> = axes[2]
        .iter()
        .flat_map(|z| axes[1].iter().map(move |y| (*y, *z)))
        .flat_map(|(y, z)| axes[0].iter().map(move |x| Vec3::new(*x, y, z)))
        .collect();
    Field::lattice(axes, &values_of(&points, velocity)).unwrap()
}

/// Hexahedra, in rows along x, one cell thick.
fn mesh(nx: u32, ny: u32) -> PlacedField {
    let (xs, ys) = (row(nx as usize, 0.0, WAY), row(ny as usize, -HALF, HALF));
    let points: Vec<Vec3<f64>> = [0.0, 0.02]
        .iter()
        .flat_map(|z| ys.iter().map(move |y| (*y, *z)))
        .flat_map(|(y, z)| xs.iter().map(move |x| Vec3::new(*x, y, z)))
        .collect();
    let mut cells = Cells::new();
    let (up, layer) = (nx + 1, (nx + 1) * (ny + 1));
    for first in (0..ny).flat_map(|j| (0..nx).map(move |i| i + up * j)) {
        let face = [first, first + 1, first + 1 + up, first + up];
        let all = [face, face.map(|point| point + layer)].concat();
        cells.push(Shape::Hexahedron, &all).unwrap();
    }
    placed(Field::mesh(&points, &cells, &values(&points)).unwrap().0)
}

fn placed(field: Field) -> PlacedField {
    placed_along(field, Axis::ALL[0])
}

fn placed_along(field: Field, axis: Axis) -> PlacedField {
    let unit = 1.0;
    let root = PlacedField::middle_of_inlet(&field, axis, unit);
    let machine_direction = PlacedField::usual_machine_direction(&field, axis);
    let field = FileContent::new(PathBuf::from("box.vtu"), 0, Arc::new(field));
    PlacedField { field, root, axis, machine_direction, unit, length_constant: 0.43, time_constant: 0.3 }
}

fn line(placed: PlacedField, replicates: u64) -> Case {
    let mut case = Case::unset();
    case.fibre =
        Fibre { diameter: 18e-6, density: 910.0, youngs_modulus: 2e9, root: Root::Clamped, ..Fibre::UNKNOWN };
    case.fibre.span(WAY, 4e-3);
    let feed_speed = 50.0;
    let belt_speed = 3.0;
    let kept_length = 0.03;
    case.line = Some(Line {
        feed_speed,
        distance: WAY,
        belt_speed,
        kept_length,
        steps_per_element: 2,
        ..Line::UNKNOWN
    });
    case.air = Air { flow: Flow::Field(Box::new(placed)), ..Air::uniform(40.0, 0.1, 0.016, 500.0) };
    case.run.time_step = 4e-5;
    (case.run.steps, case.run.output_steps, case.run.replicates) = (3000, 5, replicates);
    case.run.spin_up_steps = 1500;
    (case.run.scheme, case.run.gravity, case.run.damping) = (Scheme::ImplicitTension, 9.81, 0.0);
    case
}

fn control<'a>(threads: usize, stop: &'a AtomicBool, fibre_steps: &'a AtomicU64) -> RunContext<'a> {
    RunContext { threads, isa: Isa::detect(), stop, done: fibre_steps }
}

fn fly(case: &Case, inlets: &[f64], threads: usize) -> Sources {
    let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
    let curtain = LineFilaments { filaments_per_metre: 5000.0, inlets: inlets.to_vec() };
    let sources = Sources::fly(case, &curtain, control(threads, &stop, &done)).unwrap();
    assert_eq!(done.into_inner(), case.run.steps * case.run.replicates);
    sources
}

/// What a CFD program makes of the cells: the force per metre of width.
fn summed(sources: &Sources, depth: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| sources.cells.iter().map(|cell| cell.force()[i] * cell.volume / depth).sum())
}

#[test]
fn invariant_the_cells_have_the_force_of_the_balance_of_momentum() {
    let mut case = line(lattice([100, 10, 0]), 8);
    case.run.steps = 14000;
    let force = |cell: &CellSource| cell.force()[0] * cell.volume;
    let sources = fly(&case, &[], 1);
    let [x, y, z] = summed(&sources, 1.0);
    let [force_x, force_y, force_z] = sources.force.each_ref().map(|force| force.mean);
    assert!((x - force_x).abs() < 1e-9 * x.abs() && (y - force_y).abs() < 1e-9 * x.abs());
    assert!(z.abs() > 0.0 && (z - force_z).abs() < 1e-9 * x.abs());
    assert_eq!(sources.along.mean, force_x);
    assert_eq!(sources.outside.mean, 0.0);
    let [drag, balance] = &sources.above_belt;
    let above: f64 =
        (0..95).flat_map(|i| (0..10).map(move |j| i + 100 * j)).map(|i| force(&sources.cells[i])).sum();
    assert!((above - drag.mean).abs() < 5e-3 * drag.mean.abs());
    assert!((drag.mean - balance.mean).abs() < 0.01 * balance.mean.abs(), "{drag:?} {balance:?}");
    let met: Vec<_> = sources.cells.iter().filter(|cell| cell.hits > 0).collect();
    assert!(met.len() > 30 && met.len() < sources.cells.len());
    assert!(met.iter().all(|cell| cell.sp < 0.0 && cell.sp_error >= 0.0 && cell.su_error[0] > 0.0));
    let unmet = sources.cells.iter().filter(|cell| cell.hits == 0);
    assert!(unmet.clone().count() > 0 && unmet.clone().all(|cell| cell.sp == 0.0 && cell.su == [0.0; 3]));
}

/// The same flights in cells of other sizes, shapes and depths.
#[test]
fn invariant_the_whole_force_does_not_depend_on_the_cells() {
    let case = line(lattice([30, 10, 0]), 2);
    let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
    let jobs = [Job::new(&case, 0), Job::new(&case, 1)];
    let in_cells = |placed: PlacedField, depth: f64| {
        let of_cells = line(placed, 2);
        let fitting = fitting(&of_cells).unwrap();
        let mut merged = Merged::new(&of_cells, &fitting);
        let simulated = fly_each(&jobs, &fitting, control(1, &stop, &done)).unwrap();
        simulated.iter().flatten().for_each(|sums| merged.add(sums, 5000.0));
        let sources = merged.finish(5000.0);
        let [x, y, z] = summed(&sources, depth);
        let drag: f64 = sources.cells.iter().map(|cell| cell.sp * cell.volume / depth).sum();
        [x, y, z, drag]
    };
    let first = in_cells(lattice([30, 10, 0]), 1.0);
    for (placed, depth) in [(lattice([7, 3, 0]), 1.0), (mesh(20, 6), 0.02), (lattice([12, 4, 5]), 0.4)] {
        let again = in_cells(placed, depth);
        for (a, b) in first.iter().zip(again) {
            assert!((a - b).abs() < 1e-9 * first[0].abs().max(first[3].abs()), "{first:?} {again:?}");
        }
    }
}

/// The same flow around fibres along other axes of the field. The air is linear in space, so only rounding differs.
#[test]
#[ignore = "slow: a flight in each of eight orientations"]
fn invariant_the_sources_lie_along_the_axes_of_the_field() {
    let turned = |(along, normal): (usize, usize)| {
        let axis = Axis::ALL[along];
        let cross = Axis { index: normal, backwards: false };
        let axes = [axis, cross.cross(axis), cross];
        let rows = [row(30, 0.0, WAY), row(10, -HALF, HALF), vec![0.0]];
        let mut of_field = [vec![], vec![], vec![]];
        for (axis, row) in axes.into_iter().zip(rows) {
            let sign = if axis.backwards { -1.0 } else { 1.0 };
            of_field[axis.index] = row.iter().map(|at| sign * at).collect();
            of_field[axis.index].sort_unstable_by(f64::total_cmp);
        }
        let velocity = |at: Vec3<f64>| {
            let v = velocity(Vec3::new(axes[0].part_of(at), axes[1].part_of(at), 0.0));
            let mut turned = [0.0; 3];
            for (axis, part) in axes.into_iter().zip([v.x, v.y, v.z]) {
                turned[axis.index] = if axis.backwards { -part } else { part };
            }
            Vec3::new(turned[0], turned[1], turned[2])
        };
        let points: Vec<Vec3<f64>> = of_field[2]
            .iter()
            .flat_map(|z| of_field[1].iter().map(move |y| (*y, *z)))
            .flat_map(|(y, z)| of_field[0].iter().map(move |x| Vec3::new(*x, y, z)))
            .collect();
        let field = Field::lattice(of_field, &values_of(&points, velocity)).unwrap();
        let placed = placed_along(field, axis);
        assert_eq!(placed.axes(), axes);
        let sources = fly(&line(placed, 2), &[], 1);
        let force = sources.force.each_ref().map(|force| force.mean);
        let in_cells = summed(&sources, 1.0);
        let along = |force: [f64; 3]| axes.map(|axis| axis.part_of(Vec3::new(force[0], force[1], force[2])));
        (along(force), along(in_cells), sources.along.mean)
    };
    let first = turned((0, 2));
    assert_eq!(first.0[0], first.2);
    // Planes of x and z, of x and y and of y and z; forwards and backwards.
    for axes in [(5, 1), (4, 2), (4, 0), (5, 0), (2, 1), (1, 2), (3, 1)] {
        let other = turned(axes);
        let all = |(force, cells, along): ([f64; 3], [f64; 3], f64)| [&force[..], &cells, &[along]].concat();
        for (a, b) in all(first).into_iter().zip(all(other)) {
            assert!((a - b).abs() < 1e-6 * first.2.abs(), "{axes:?}: {first:?} {other:?}");
        }
    }
}

/// The drag of the elements, taken apart from that of the nodes, is that of the laws at the velocities of the air
/// that the step has felt.
#[test]
fn identical_drag_of_the_elements_and_of_the_laws() {
    let case = line(lattice([30, 10, 0]), 1);
    let law = case.strand().drag;
    let mut flight = Flight::new(&[Job::new(&case, 0)], Isa::detect()).unwrap();
    flight.advance(1500);
    let mut births = 0;
    let mut off = 0.0;
    let mut sum = 0.0;
    for step in 1500..1530 {
        let fed = flight.chain().fed();
        let (snapshot, relative) = see(&mut flight, step);
        births += flight.chain().fed() - fed;
        for j in 0..snapshot.in_air[0] - 4 {
            let edge = snapshot.position[j + 1].lane(0) - snapshot.position[j].lane(0);
            let (tangent, relative) = (edge * (1.0 / edge.norm()), relative[j].lane(0));
            let along = relative.dot(tangent);
            let across = relative - tangent * along;
            let force = tangent * (law.along.force(along.abs(), 1.0) * along.signum())
                + across * (law.across.force(across.norm(), 1.0) / across.norm());
            off += (force - snapshot.drag[j].lane(0)).norm();
            sum += force.norm();
        }
    }
    assert!(births > 5 && sum > 0.0 && off < 5e-3 * sum, "{births} {off:e} {sum:e}");
}

/// A case whose filament comes hot from a spinline, of a polymer with the same heat capacity at all temperatures.
fn hot(placed: PlacedField, replicates: u64) -> Case {
    let mut case = line(placed, replicates);
    let mut spinline = Spinline {
        material: Polymer::Pp.material(false),
        melt: Melt::FlowRate(35.0),
        die_temperature: 503.15,
        hole_diameter: 0.6e-3,
        throughput: 0.7e-3 / 60.0,
        length: 0.3,
        end: End::TakeUp(50.0),
        ..Spinline::UNKNOWN
    };
    spinline.material.heat_capacity_slope = 0.0;
    let solution = spinline.solve(case.drag.along).unwrap();
    case.spinline = Some(Box::new(spinline));
    case.take_filament(&solution);
    case
}

#[test]
fn invariant_the_cells_have_the_heat_that_the_filaments_lose() {
    // The field ends above the belt.
    let mut short = lattice([30, 10, 0]);
    short.unit = 0.8;
    for (placed, depth) in [(lattice([30, 10, 0]), 1.0), (short, 0.8)] {
        let case = hot(placed, 3);
        let sources = fly(&case, &[], 1);
        let heat = sources.heat.as_ref().unwrap();
        let spinline = case.spinline.as_deref().unwrap();
        let in_cells: f64 = sources.cells.iter().map(|cell| cell.heat * cell.volume / depth).sum();
        assert!((in_cells / heat.in_cells.mean - 1.0).abs() < 1e-9, "{in_cells} {heat:?}");
        let fallen = heat.at_inlet - heat.at_belt.mean;
        let lost = 5000.0 * spinline.throughput * spinline.material.heat_capacity * fallen;
        let given = heat.in_cells.mean + heat.outside.mean;
        assert!((given / lost - 1.0).abs() < 1e-9 && lost > 100.0, "{given} {lost}");
        assert!(heat.at_belt.mean > heat.of_air && heat.at_belt.standard_error.unwrap() > 0.0);
        for cell in sources.cells.iter().filter(|cell| cell.hits > 0) {
            assert!(cell.heat > 0.0 && cell.sh_per_kelvin < 0.0 && cell.heat_error >= 0.0);
            assert!((cell.sh + cell.sh_per_kelvin * heat.of_air - cell.heat).abs() < 1e-9 * cell.sh);
        }
    }
}

/// In calm air that is as fast everywhere filaments hang straight until the belt folds them.
#[test]
fn analytic_heat_of_straight_filaments_in_uniform_air() {
    let mut case = hot(placed(field_of([30, 10, 0], |_| Vec3::new(FAST, 0.0, 0.0))), 2);
    case.air.turbulence_intensity = 1e-3;
    case.run.gravity = 0.0;
    let sources = fly(&case, &[], 1);
    let heat = sources.heat.as_ref().unwrap();
    let spinline = case.spinline.as_deref().unwrap();
    let solution = spinline.solve(case.drag.along).unwrap();
    let filament = SolidFilament::new(spinline, &solution, heat.of_air);
    let expected: f64 = (0..500)
        .fold((filament.at_start, 0.0), |(temperature, heat), _| {
            let cooled = filament.cool(temperature, 0.5 * WAY / 500.0, [FAST - solution.final_speed, 0.0]);
            (cooled.temperature, heat + 5000.0 * cooled.heat)
        })
        .1;
    let above = sources.cells.iter().enumerate().filter(|(i, _)| i % 30 < 15);
    let found: f64 = above.map(|(_, cell)| cell.heat * cell.volume).sum();
    assert!(expected > 100.0 && (found / expected - 1.0).abs() < 0.01, "{found} {expected}");
}

#[test]
fn lost_filaments_are_counted_and_the_others_are_the_same_without_them() {
    // Air that rises at one side: filaments that are fed there never come down.
    let rising = |at: Vec3<f64>| Vec3::new(if at.y > 0.06 { -30.0 } else { 40.0 }, 0.0, 0.0);
    let case = line(placed(field_of([30, 10, 0], rising)), 4);
    let mut alone = case.clone();
    alone.run.replicates = 2;
    let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
    let curtain = |inlets: &[f64]| LineFilaments { filaments_per_metre: 5000.0, inlets: inlets.to_vec() };
    let all = Sources::fly(&case, &curtain(&[0.0, 0.12]), control(1, &stop, &done)).unwrap();
    assert_eq!((all.replicates, all.lost.len()), (2, 2), "{:?}", all.lost);
    assert!(all.lost.iter().map(|fibre| fibre.replicate).eq([2, 3]));
    let few = fly(&alone, &[0.0], 1);
    assert_eq!(format!("{:?}", all.cells), format!("{:?}", few.cells));
    let ended = Sources::fly(&alone, &curtain(&[0.12]), control(1, &stop, &done)).unwrap_err();
    assert!(ended.lost_fibre().is_some(), "{ended}");
}

#[test]
#[ignore = "slow: thirty flights on one and on two threads"]
fn identical_for_any_number_of_threads() {
    let case = line(mesh(20, 6), 10);
    let inlets = [-0.01, 0.0, 0.01];
    let [one, two] = [1, 2].map(|threads| fly(&case, &inlets, threads));
    assert_eq!(format!("{one:?}"), format!("{two:?}"));
    assert!(one.cells.iter().filter(|cell| cell.hits > 0).count() > 20);
}

#[test]
fn rejects_cases_without_cells_or_filaments() {
    let reject = |change: &dyn Fn(&mut Case), key: &str| {
        let mut case = line(lattice([5, 4, 0]), 1);
        change(&mut case);
        let fault = Sources::fault(&case).unwrap().to_string();
        assert!(fault.contains(key), "{fault}");
    };
    assert!(Sources::fault(&line(lattice([5, 4, 0]), 1)).is_none());
    reject(&|case| case.line = None, "[feed] and [belt]");
    reject(&|case| case.air.flow = Flow::Uniform, "air.field");
    reject(&|case| case.run.scheme = Scheme::Leapfrog, "run.scheme");
    let scattered: Vec<Vec3<f64>> =
        (0..40).map(f64::from).map(|i| Vec3::new(i, i * i % 7.0, i * i * i % 11.0)).collect();
    let scattered = Field::points(&scattered, &values(&scattered)).unwrap().0;
    let scattered = placed(scattered);
    reject(&|case| case.air.flow = Flow::Field(Box::new(scattered.clone())), "without cells");
    // The plane of the way and of the cross direction, which a key names against the usual one.
    let (x, z) = (row(4, 0.0, WAY), row(4, 0.0, 0.1));
    let points: Vec<Vec3<f64>> =
        z.iter().flat_map(|z| x.iter().map(move |x| Vec3::new(*x, 0.0, *z))).collect();
    let turned = PlacedField {
        machine_direction: Axis::ALL[1],
        ..placed(Field::lattice([x, vec![0.0], z], &values(&points)).unwrap())
    };
    reject(&|case| case.air.flow = Flow::Field(Box::new(turned.clone())), "air.field_machine_direction");
}
