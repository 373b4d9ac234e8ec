//! What a flight costs, counted instead of timed: steps, samples of the turbulence, records, memory.
//!
//! Counts called frozen are no physics: one that changes says that a run has become dearer or cheaper. Change
//! the number here when that is meant, and `docs/validation.md` with it. Other bounds follow from what is kept.

// An allocator that counts is unsafe to write.
#![allow(clippy::expect_used, unsafe_code)]

mod common;
#[path = "../../spunlaid-field/tests/field/vtk.rs"]
mod vtk;

use common::*;
use spunlaid_air::{Air, Eddies, EddyField, EddyModel, Extent, Field, Lateral, StreamKey, Wind};
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Case, FibreParameters, Flight};
use spunlaid_ground::{Isa, RunContext, WIDTH};
use spunlaid_input::read_case;
use spunlaid_simulation::ensemble::fly_together;
use spunlaid_simulation::{Job, MEASURES, Recorded, Results, Trajectory};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::f64::consts::PI;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// The system's allocator, which counts what each thread asks of it.
struct Counting;

thread_local! {
    /// Blocks taken so far; bytes held now, and at most.
    static TAKEN: Cell<u64> = const { Cell::new(0) };
    static HELD: Cell<i64> = const { Cell::new(0) };
    static PEAK: Cell<i64> = const { Cell::new(0) };
}

fn count(bytes: i64) {
    TAKEN.set(TAKEN.get() + u64::from(bytes > 0));
    HELD.set(HELD.get() + bytes);
    PEAK.set(PEAK.get().max(HELD.get()));
}

// SAFETY: the system's allocator does all of it; counting touches none of its memory.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as i64);
        // SAFETY: the caller's promise, passed on.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        count(-(layout.size() as i64));
        // SAFETY: as above.
        unsafe { System.dealloc(block, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// What some work asked of memory.
struct Memory {
    blocks: u64,
    /// Bytes that its result holds, and most bytes held at once on the way, over what was held before.
    kept: i64,
    peak: i64,
}

fn memory_of<T>(work: impl FnOnce() -> T) -> (T, Memory) {
    let (blocks, held) = (TAKEN.get(), HELD.get());
    PEAK.set(held);
    let result = work();
    let memory = Memory { blocks: TAKEN.get() - blocks, kept: HELD.get() - held, peak: PEAK.get() - held };
    (result, memory)
}

fn flights(case: &Case) -> (Vec<Trajectory>, u64) {
    let (stop, fibre_steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let computing = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &fibre_steps };
    let jobs: Vec<Job<'_>> = (0..case.run.replicates).map(|replicate| Job::new(case, replicate)).collect();
    let flights = fly_together(&jobs, Recorded::SAMPLES, computing).expect("the case flies");
    (flights, fibre_steps.into_inner())
}

#[test]
fn frozen_steps_and_records_of_a_flight() {
    for (scheme, h, steps) in [
        (Scheme::SemiImplicitEuler, 1e-6, 20_000),
        (Scheme::Leapfrog, 2e-5, 1_000),
        (Scheme::ImplicitTension, 2e-4, 100),
    ] {
        let (flights, fibre_steps) = flights(&table1(scheme, h, 0.02, WIDTH as u64));
        assert_eq!(fibre_steps, steps * WIDTH as u64, "{}", scheme.name());
        for flight in &flights {
            // Every millisecond, the start included.
            assert_eq!(flight.samples.len(), 21);
            assert!(flight.shapes.is_empty());
        }
    }
}

#[test]
fn analytic_longest_steps_of_each_scheme() {
    // What a study may use at most: a tighter limit makes it dearer by as much.
    for (scheme, diameter, element) in [
        (Scheme::SemiImplicitEuler, 50e-6, 0.05),
        (Scheme::Leapfrog, 50e-6, 0.05),
        (Scheme::ImplicitTension, 50e-6, 0.05),
        (Scheme::Leapfrog, 18e-6, 0.001),
        (Scheme::ImplicitTension, 18e-6, 0.001),
    ] {
        let mut case = table1(scheme, 1e-6, 1.0, 1);
        case.fibre.diameter = diameter;
        case.fibre.elements = (1.0_f64 / element).round() as usize;
        let limits = case.step_limits();
        let found = limits.iter().map(|l| l.limit).fold(f64::INFINITY, f64::min);
        // Table 1: 2 GPa, 950 kg/m³, 1 m, air of 1.204 kg/m³ and 1.51e-5 m²/s at 10 m/s, β = 0.9. An axial wave
        // passes an element in l/√(E/ρ). Implicit tension is bound by 1.5 times the time of a wave of the taut
        // string, l/√(T/ρA), with the weight and the friction ½ρ_a U² πdL β Re^−0.61 as tension.
        let speed = if scheme == Scheme::ImplicitTension {
            let friction =
                0.5 * 1.204 * 100.0 * PI * diameter * 0.9 * (10.0 * diameter / 1.51e-5).powf(-0.61);
            (9.81 + friction / (950.0 * 0.25 * PI * diameter * diameter)).sqrt() / 1.5
        } else {
            (2e9_f64 / 950.0).sqrt()
        };
        assert!((found * speed / element - 1.0).abs() < 1e-6, "{} {found} s", scheme.name());
    }
}

#[test]
fn frozen_harmonics_and_samples_of_the_turbulence() {
    // Harmonics of Table 1, by its duration; samples per second: four per harmonic in N_h/f.
    for (duration, harmonics) in [(0.1, 128), (1.0, 256), (10.0, 1_024), (100.0, 1_024)] {
        assert_eq!(table1_air().default_harmonics(duration), harmonics);
    }
    let columns = 20.0 * 3.0 * 8.0 * 8.0;
    // No more than a repeat time and what the interpolation looks ahead.
    for (duration, samples) in [(0.1, 49.0), (1.0, 409.0), (10.0, 4_104.0), (1e6, 4_104.0)] {
        let air = Air { harmonics: table1_air().default_harmonics(duration), ..table1_air() };
        assert_eq!(Wind::memory(&air, 20, duration), samples * columns, "{duration} s");
    }
}

#[test]
fn frozen_memory_of_a_flight() {
    for (scheme, bytes_per_node) in
        [(Scheme::SemiImplicitEuler, 964), (Scheme::Leapfrog, 964), (Scheme::ImplicitTension, 2180)]
    {
        let kept = |elements: usize| {
            let fibre = spunlaid_fibre::Fibre { elements, ..table1_fibre() };
            let (eddies, turbulence) = steady_air(10.0, elements, 1e-3);
            let strand = in_vacuum(fibre, 9.81);
            let new = || {
                Flight::assembled(Isa::detect(), &[strand], (&eddies, &turbulence), scheme, 1e-9)
                    .expect("fibres that agree")
            };
            memory_of(new).1.kept
        };
        // Linear in the number of nodes, whatever their number.
        let a = kept(20);
        let b = kept(2_000);
        let c = kept(20_000);
        assert_eq!((b - a) / 1_980, bytes_per_node, "{}", scheme.name());
        assert_eq!((c - b) / 18_000, bytes_per_node, "{}", scheme.name());
    }
}

#[test]
fn steps_ask_for_no_memory() {
    for (scheme, h) in
        [(Scheme::SemiImplicitEuler, 1e-5), (Scheme::Leapfrog, 1e-5), (Scheme::ImplicitTension, 2e-4)]
    {
        let case = table1(scheme, h, 0.1, WIDTH as u64);
        let eddies = Eddies::along(1.0, 20, 0.05);
        let stream = [(case.air.clone(), StreamKey { seed: 1, replicate: 0 })];
        let turbulence = Wind::uniform(Isa::detect(), &stream, 20, 0.1).expect("fibres that agree");
        let strands: [FibreParameters; 1] = [case.strand()];
        let mut flight = Flight::assembled(Isa::detect(), &strands, (&eddies, &turbulence), scheme, h)
            .expect("fibres that agree");
        // As much for one step as for a hundred: none for a step itself.
        flight.advance(1);
        let [one, hundred] = [1, 100].map(|steps| memory_of(|| flight.advance(steps)).1);
        assert_eq!((one.blocks, one.kept), (hundred.blocks, hundred.kept), "{}", scheme.name());
    }
}

/// Bytes of what a trajectory keeps: records, node spreads, no shapes.
fn bytes_of(flight: &Trajectory) -> i64 {
    (size_of_val(&flight.samples[..]) + size_of_val(&flight.values[..])) as i64
}

#[test]
fn memory_of_flights_is_what_they_keep_and_their_turbulence() {
    let (scheme, h) = (Scheme::ImplicitTension, 2e-4);
    let simulated = |duration| {
        let case = table1(scheme, h, duration, WIDTH as u64);
        let ((flights, _), memory) = memory_of(|| flights(&case));
        let turbulence = Wind::memory(&case.air, 20, duration);
        (flights, memory, turbulence as i64)
    };
    let (short, short_memory, short_turbulence) = simulated(0.2);
    let (long, long_memory, long_turbulence) = simulated(2.0);
    let [short_bytes, long_bytes] = [&short, &long].map(|flights| flights.iter().map(bytes_of).sum::<i64>());
    // Ten times the records; the nodes stay.
    assert!(long_bytes > 8 * short_bytes, "{short_bytes} and {long_bytes} bytes");
    // A list that grows takes at most twice what is in it, and three times while it moves.
    let list = (WIDTH * size_of::<Trajectory>()) as i64;
    for (memory, bytes) in [(&short_memory, short_bytes), (&long_memory, long_bytes)] {
        assert!((bytes..=2 * bytes + list).contains(&memory.kept), "{} kept of {bytes} bytes", memory.kept);
    }
    let grown = long_memory.peak - short_memory.peak;
    let most = 3 * (long_bytes - short_bytes) + long_turbulence - short_turbulence;
    assert!(grown <= most, "{grown} bytes more for ten times the duration, {most} expected at most");
}

/// Recorders take the instants, and observers keep some of them at most.
#[test]
fn memory_of_a_flight_does_not_grow_with_its_recorded_instants() {
    let peak = |instants: u64| {
        let mut case = table1(Scheme::ImplicitTension, 2e-4, 1.0, 2);
        (case.run.steps, case.run.output_steps) = (instants, 1);
        let (stop, fibre_steps) = (AtomicBool::new(false), AtomicU64::new(0));
        let computing = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &fibre_steps };
        let jobs = [0, 1].map(|replicate| Job::new(&case, replicate));
        let (simulated, memory) =
            memory_of(|| fly_together(&jobs, Recorded::CURVES, computing).expect("the case flies"));
        assert!(simulated.iter().all(|flight| flight.samples.is_empty()));
        memory.peak
    };
    // Beyond what is kept whole. If every instant were kept, these would be 40 000 more, of 1 kB of two fibres.
    let [short, long] = [40_000, 80_000].map(peak);
    assert!(long < short + 100_000, "{short} bytes for 40,000 instants, {long} for 80,000");
}

#[test]
fn statistics_keep_a_few_numbers_of_each_flight_however_long() {
    let [short, long] = [0.2, 2.0].map(|duration| {
        let case = table1(Scheme::ImplicitTension, 2e-4, duration, WIDTH as u64);
        let (flights, _) = flights(&case);
        let mut collector = Results::collector(0);
        collector.take(flights[0].clone());
        let rest = flights[1..].iter().cloned();
        let taken = memory_of(|| rest.for_each(|flight| collector.take(flight))).1;
        (taken, bytes_of(&flights[0]))
    });
    // Each of the measures of every flight, in lists that may be half empty.
    let most = (2 * WIDTH * MEASURES.len() * size_of::<f64>()) as i64;
    // One flight at a time is worked on, in no more than twice its own size.
    for (taken, bytes) in [short, long] {
        assert!(taken.kept <= most, "{} bytes kept of {bytes} in each flight", taken.kept);
        assert!(taken.peak <= 2 * bytes + most, "{} bytes at once of {bytes}", taken.peak);
    }
}

#[test]
fn memory_of_a_flight_does_not_grow_with_its_time() {
    let case = table1(Scheme::ImplicitTension, 5e-4, 1.0, WIDTH as u64);
    let jobs: Vec<Job<'_>> = (0..WIDTH as u64).map(|replicate| Job::new(&case, replicate)).collect();
    let mut flight = Flight::new(&jobs, Isa::detect()).expect("the case flies");
    // 256 harmonics of 100 Hz: windows follow one another every 1.92 s.
    flight.step_to(4.0).expect("the case flies");
    let seconds = |flight: &mut Flight, to: f64| memory_of(|| flight.step_to(to).expect("the case flies")).1;
    let (ten, hundred) = (seconds(&mut flight, 14.0), seconds(&mut flight, 114.0));
    assert_eq!((ten.kept, hundred.kept), (0, 0));
    assert_eq!(ten.peak, hundred.peak);
}

/// Points of a lattice of so many along each side of a unit cube, each with velocity, k and ε.
fn cube(side: usize) -> (Vec<[f64; 3]>, [vtk::Data; 3]) {
    let along = |i: usize| i as f64 / (side - 1) as f64;
    let points: Vec<[f64; 3]> =
        (0..side.pow(3)).map(|i| [along(i % side), along(i / side % side), along(i / side.pow(2))]).collect();
    let velocity = points.iter().flat_map(|[x, y, z]| [1.0 + x, y * z, x * y]).collect();
    let ones = || vec![1.0; points.len()];
    let data = [("U", 3, velocity), ("k", 1, ones()), ("epsilon", 1, ones())];
    (points, data)
}

const RAW: vtk::Style = vtk::Style { place: vtk::DataPlace::AppendedRaw, ..vtk::ASCII };

/// Bytes of a field when it is ready, and at most while it is made, without those of its file.
fn memory_of_field(file: &[u8], name: &str) -> (f64, f64, usize) {
    let (field, memory) = memory_of(|| Field::parse(file, name).expect("a field").0);
    // What the field says it takes is what it holds.
    let (estimated, kept) = (field.memory() as f64, memory.kept as f64);
    assert!((kept / estimated - 1.0).abs() < 0.1, "{name}: {kept} bytes held, {estimated} estimated");
    (kept, memory.peak as f64, field.memory_while_made())
}

#[test]
fn a_field_takes_as_much_memory_as_the_guide_says() {
    let side = 41;
    let (points, data) = cube(side);
    let first = |i: usize| i % 40 + side * (i / 40 % 40) + side * side * (i / 1600);
    let corners = [0, 1, side + 1, side].map(|i| [i, i + side * side]);
    let corners: Vec<usize> = [0, 1].into_iter().flat_map(|top| corners.map(|pair| pair[top])).collect();
    let hexahedra = 40_usize.pow(3);
    let cell = |i: usize| (12, corners.iter().map(|corner| first(i) + corner).collect(), Vec::new());
    let mesh = vtk::Mesh {
        points: points.clone(),
        cells: (0..hexahedra).map(cell).collect(),
        point_data: data.to_vec(),
        cell_data: Vec::new(),
    };
    let image = vtk::vti([side; 3], [0.0; 3], [1.0 / 40.0; 3], [&data, &[]], RAW);
    // Moved a little, so that they are no lattice.
    let row = |(i, [x, y, z]): (usize, &[f64; 3])| {
        let x = x + 1e-3 * scatter(i);
        format!("{x},{y},{z},{},{},{},1,1\n", 1.0 + x, y * z, x * y)
    };
    let table: String = points.iter().enumerate().map(row).collect();
    let table = format!("x_m,y_m,z_m,u_m_s,v_m_s,w_m_s,k,epsilon\n{table}");
    // docs/air.md: 0.4 GB for a million hexahedra, and 1.2 GB while they are made, of which 0.1 GB are the file, which
    // is not counted here. 40 bytes for a point of a lattice, 225 for one of a table.
    for (file, name, each, kept_each, made_each) in [
        (vtk::vtu(&[mesh], RAW), "a.vtu", hexahedra, 400.0, 1250.0),
        (image, "a.vti", points.len(), 41.0, 90.0),
        (table.into_bytes(), "a.csv", points.len(), 226.0, 500.0),
    ] {
        let (kept, peak, estimated) = memory_of_field(&file, name);
        let (kept, made) = (kept / each as f64, peak / each as f64);
        println!(
            "{name}: {kept:.0} and {made:.0} bytes each, {:.0} estimated, {} file",
            estimated as f64 / each as f64,
            file.len() / each
        );
        assert!(kept <= kept_each && made <= made_each, "{name}: {kept:.0} and {made:.0} bytes for each");
        let share = estimated as f64 / peak;
        assert!((0.67..1.5).contains(&share), "{name}: {estimated} bytes estimated of {peak}");
    }
}

#[test]
fn a_file_that_unpacks_to_more_than_is_read_is_refused_before_it_is_unpacked() {
    // 24 blocks of 128 MiB of zeros, 0.13 MB each: 3 GiB, and as much again in numbers.
    const BLOCK: usize = 128 << 20;
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::new(6));
    std::io::Write::write_all(&mut encoder, &vec![0; BLOCK]).expect("memory");
    let packed = encoder.finish().expect("memory");
    let points = 24 * BLOCK / 24;
    let extent = format!("0 {} 0 0 0 0", points - 1);
    let mut file = format!(
        "<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\" header_type=\"UInt64\" \
        compressor=\"vtkZLibDataCompressor\">\n<ImageData WholeExtent=\"{extent}\">\n\
        <Piece Extent=\"{extent}\">\n<PointData>\n\
        <DataArray type=\"Float64\" Name=\"U\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/>\n\
        </PointData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">_"
    )
    .into_bytes();
    let header = [24, BLOCK as u64, 0].into_iter().chain([packed.len() as u64; 24]);
    header.for_each(|number| file.extend(number.to_le_bytes()));
    (0..24).for_each(|_| file.extend(&packed));
    let (said, memory) = memory_of(|| Field::parse(&file, "bomb.vti").err().map(|error| error.to_string()));
    let said = said.expect("it is refused");
    assert!(said.starts_with("bomb.vti:5: U: contains more than 4 GiB"), "{said}");
    assert!(memory.peak < 1 << 20, "{} bytes at once", memory.peak);
}

/// A field is made block by block, and forgotten likewise.
#[test]
fn limit_a_field_of_eddies_takes_the_memory_that_is_reported_before() {
    const LENGTH: f64 = 16e-3;
    const BLOCKS: u32 = 36;
    let (spunbond, _) = read_case(Path::new("../../cases/spunbond.toml"), &[]).expect("the case is read");
    let uniform = |decay_time: f64| Air {
        eddies: EddyModel::Convected { decay_time },
        ..Air::uniform(25.0, 0.1, LENGTH, 25.0 / 4.0 / LENGTH)
    };
    let independent = Air::uniform(25.0, 0.1, LENGTH, 25.0 / 4.0 / LENGTH);
    let key = StreamKey { seed: 1, replicate: 0 };
    for (what, air) in [
        ("a line", spunbond.air),
        ("a pattern that ages", uniform(5e-3)),
        ("a pattern that lasts", uniform(f64::INFINITY)),
        ("independent eddies", independent),
    ] {
        for (y, cutoff) in [(6.0 * LENGTH, 10.3), (12.0 * LENGTH, 6.0)] {
            let extent = Extent { y, z: 10.0 * LENGTH };
            let ((), memory) = memory_of(|| {
                let mut field = EddyField::new(&air, 0.5, extent, cutoff, key);
                for number in 0..BLOCKS {
                    let from = f64::from(number) * field.block();
                    field.make(from..from + field.block(), 1);
                }
            });
            let found = memory.peak as f64;
            let estimated = EddyField::memory(1, &air, 0.5, extent, cutoff);
            assert!((0.75 * estimated..estimated).contains(&found), "{what}: {found} of {estimated}");
        }
    }
}

/// A field is made near its fibre only.
#[test]
fn limit_fibres_in_eddies_take_the_part_of_their_fields_that_is_reported_before() {
    let mut case = table1(Scheme::ImplicitTension, 2e-4, 0.4, WIDTH as u64);
    case.air.lateral = Lateral::VonKarman { cutoff: 10.0 };
    let (_, memory) = memory_of(|| flights(&case));
    let (found, estimated) = (memory.peak as f64, case.flight_memory().total());
    assert!((0.5 * estimated..2.0 * estimated).contains(&found), "{found} of {estimated}");
    let whole = EddyField::memory(WIDTH as u64, &case.air, case.way_of_air(), case.extent_of_air(), 10.0);
    assert!(found < whole / 6.0, "{found} of {whole} for the whole fields");
}
