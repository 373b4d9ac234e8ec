//! What a case means: its mesh, its limits, and what a run of it is expected to need.

use super::POSITIONS;
use super::report::frames::POSITIONS as POSITIONS_OF_PAGE;
use super::simulated::ROOM;
use crate::numbers::significant;
use crate::reports::spinline::files as spinline;
use spunlaid_air::{Air, Axis, Flow, PlacedField, Spread};
use spunlaid_fibre::{Case, Line};
use spunlaid_ground::error::counted;
use spunlaid_ground::{Dimension, Error, Isa, WIDTH};
use spunlaid_simulation::ensemble::pace;
use spunlaid_simulation::{FinerPlans, KeepShapes};
use std::fs;
use std::path::{Path, PathBuf};

/// What a case means, in lines.
///
/// * `threads` – on which it would run
/// * `reading` – time that it took to read the case and its files [s]
///
/// # Errors
/// If it cannot be simulated.
pub fn about_case(case: &Case, threads: usize, reading: f64) -> Result<Vec<String>, Error> {
    let expected = Needs::new(case, threads as u64, reading)?;
    let field = match &case.air.flow {
        Flow::Field(placed) => field(placed),
        Flow::Uniform | Flow::Profile(_) => Vec::new(),
    };
    let mut lines = [field, mesh(case), error_of_mesh(case), limits(case)].concat();
    lines.push(format!(
        "expected: {} on {} of {threads} threads, {:.0} MiB of memory",
        duration(expected.wall_s),
        expected.threads,
        expected.memory_bytes / f64::from(1 << 20)
    ));
    lines.extend(idle_threads(case, threads as u64));
    Ok(lines)
}

/// What was read from a CFD solution, and whether the fibre hangs along the air.
fn field(placed: &PlacedField) -> Vec<String> {
    let overview = placed.field.overview();
    let (low, high) = placed.extent();
    let spread = |Spread { least, mean, largest }: Spread, unit: &str| {
        let [least, mean, largest] = [least, mean, largest].map(|value| significant(value, 3));
        format!("{least} to {largest} {unit}, {mean} {unit} on average")
    };
    let mut lines = vec!["field".to_owned(), format!("  {}, around the root:", placed.field.describe())];
    for (name, low, high) in [("x", low.x, high.x), ("y", low.y, high.y), ("z", low.z, high.z)] {
        // Without the sign of a zero.
        let [low, high] = [low, high].map(|end| Dimension::Length.pretty_to(end + 0.0, 3));
        lines.push(format!("    {name} from {low} to {high}"));
    }
    if let Some(axis) = placed.field.plane_axis().and_then(|axis| ["x", "y", "z"].get(axis)) {
        lines.push(format!("  a plane flow: the air is the same everywhere along {axis} of the field"));
    }
    let [way, machine, cross] = placed.axes().map(Axis::name);
    lines.push(format!(
        "  the fibre's x is {way} of the field, its y, the machine direction (MD), {machine}, and its z, the cross \
         direction (CD), {cross}"
    ));
    let read = placed.field.sources().iter().map(|(quantity, arrays)| format!("{quantity} from {arrays}"));
    lines.push(format!("  read: {}", read.collect::<Vec<_>>().join("; ")));
    lines.push(format!("  velocity {}", spread(overview.speed, "m/s")));
    if placed.field.has_turbulence() {
        lines.push(format!("  k {}", spread(overview.k, "m²/s²")));
        lines.push(format!("  ε {}", spread(overview.epsilon, "m²/s³")));
    }
    let (axis, share) = placed.main_direction();
    let along = format!(
        "  the air flows along {} of the field ({} of its mean velocity)",
        axis.name(),
        significant(share, 2)
    );
    lines.push(match axis == placed.axis || share.is_nan() {
        true => format!("{along}, as the fibre hangs"),
        false => format!(
            "{along}, but the fibre hangs along {}; write air.field_axis = \"{}\" if it hangs along the air",
            placed.axis.name(),
            axis.name()
        ),
    });
    lines
}

fn mesh(case: &Case) -> Vec<String> {
    let fibre = &case.fibre;
    let mut lines = vec!["mesh".to_owned()];
    match case.line {
        None => lines.push(format!(
            "  {} of {}, {} of {} along the fibre",
            counted(fibre.elements as u64, "element"),
            Dimension::Length.pretty(fibre.rest_length()),
            match case.eddies().count() {
                1 => "1 eddy".to_owned(),
                eddies => format!("{eddies} eddies"),
            },
            Dimension::Length.pretty(case.air.length_scale)
        )),
        Some(line) => lines.extend(fed(case, line)),
    }
    if case.air.rms() > 0.0 {
        let source = match case.air.records.len() {
            0 => format!(
                "from {} harmonics, with new phases every {}",
                case.air.harmonics,
                Dimension::Time.pretty(0.75 * case.air.repeat_time())
            ),
            1 => "from the record".to_owned(),
            records => format!("from {records} records"),
        };
        let rms = Dimension::Velocity.pretty(case.air.rms());
        lines.push(format!("  turbulence of {rms} rms {source}"));
    }
    lines
}

/// What is known of the error of the mesh, and how to find out.
fn error_of_mesh(case: &Case) -> Vec<String> {
    let half = Dimension::Length.pretty_to(0.5 * case.fibre.rest_length(), 3);
    let mut lines = vec![match FinerPlans::for_case(case).mesh {
        Ok(plan) => format!(
            "  spunlaid run compares it with elements of {half} in the same turbulence, for {} % of the run's time",
            significant(100.0 * plan.share_of_run, 2)
        ),
        Err(why) => format!(
            "  a run does not check it: {why}; or run the case again with --set fibre.element_length=\"{half}\""
        ),
    }];
    if case.line.is_none() && case.air.rms() > 0.0 {
        let parts = case.air.length_scale / case.fibre.rest_length();
        let (_, cost) =
            OF_STARTER.iter().rev().find(|(least, _)| parts >= 0.9 * least).unwrap_or(&OF_STARTER[0]);
        let parts = significant(parts, 2);
        let elements = if parts == "1" { "element" } else { "elements" };
        lines.push(format!(
            "  {parts} {elements} per eddy; in the case of `spunlaid new`, about as many made {cost}"
        ));
    }
    lines
}

/// Elements to an eddy, and what they cost in the case of `spunlaid new`; validation.md has the measurement.
const OF_STARTER: [(f64, &str); 5] = [
    (1.0, "the amplitude 33 % too high and the frequency 23 % too low"),
    (2.0, "the amplitude 17 % and the frequency 14 % too high"),
    (4.0, "the frequency 26 % too high, and the amplitude less than 1 %"),
    (8.0, "the frequency 6 % too high, and the amplitude less than 1 %"),
    (16.0, "the frequency less than 2 % too high, and the amplitude less than 1 %"),
];

/// What comes out of the hole, feed, belt and stations of the air.
fn fed(case: &Case, line: Line) -> Vec<String> {
    let mut lines: Vec<String> =
        spinline::filament(case).iter().map(|sentence| format!("  {sentence}")).collect();
    let length = |metres: f64| Dimension::Length.pretty_to(metres, 3);
    let rest_length = case.fibre.rest_length();
    lines.push(format!(
        "  elements of {}, one fed every {} ({} step{}); {} from the inlet to the belt",
        length(rest_length),
        Dimension::Time.pretty_to(rest_length / line.feed_speed, 3),
        line.steps_per_element,
        if line.steps_per_element == 1 { "" } else { "s" },
        case.fibre.elements,
    ));
    let on_belt = match line.feed_speed / line.belt_speed {
        ratio if ratio.is_finite() => format!("{} of fibre on each metre of belt; ", length(ratio)),
        _ => String::new(),
    };
    lines.push(format!(
        "  {on_belt}{} are fed in the run, {} of them after the spin-up",
        length(line.feed_speed * case.run.duration()),
        length(line.feed_speed * (case.run.duration() - case.run.spin_up())),
    ));
    if let Some(stations) = case.stations() {
        lines.push(format!("  the air at {} stations, {} apart", stations.count, length(stations.spacing)));
    }
    lines
}

fn limits(case: &Case) -> Vec<String> {
    let h = case.run.time_step;
    let mut lines = vec![format!(
        "time step {}, {}; stable below",
        Dimension::Time.pretty(h),
        counted(case.run.steps, "step")
    )];
    let limits = case.stable_step_limits();
    for limit in &limits {
        lines.push(format!(
            "  {:<10} {} ({:.3} of it used)",
            Dimension::Time.pretty(limit.limit),
            limit.cause,
            h / limit.limit
        ));
    }
    if let Some(shortest) = limits.iter().min_by(|a, b| a.limit.total_cmp(&b.limit)) {
        lines.push(format!("  the shortest, {}: {}", shortest.cause, shortest.reason()));
    }
    if let Some(share) = case.air.place_of_cutoff(case.along()).filter(|_| case.line.is_none()) {
        lines.push(format!(
            "  the turbulence changes fastest {} from the root, where its cut-off frequency is {}; a step \
            that keeps run.error_tolerance follows it",
            Dimension::Length.pretty_to(share * case.fibre.length, 3),
            Dimension::Frequency.pretty_to(case.air.cutoff_frequency, 3)
        ));
    }
    lines
}

/// More replicates that take no longer: a flight takes eight, in one thread, and costs the same with fewer.
fn idle_threads(case: &Case, threads: u64) -> Option<String> {
    let each = WIDTH as u64;
    let full = each * threads;
    (case.run.replicates < full && case.flights() < threads).then(|| {
        format!(
            "  run.replicates = {full} take as long: a thread simulates {each} at a time, and {threads} are free"
        )
    })
}

/// What a run is expected to need.
struct Needs {
    wall_s: f64,
    threads: u64,
    memory_bytes: f64,
}

impl Needs {
    /// Measures the time of a few steps.
    ///
    /// * `reading` – time that it took to read the case and its files [s]
    fn new(case: &Case, threads: u64, reading: f64) -> Result<Self, Error> {
        /// Time for figures and report [s], and for writing the position of a node.
        const FIGURES: f64 = 0.4;
        const WRITING: f64 = 0.7e-6;
        let flights = case.flights();
        let busy = threads.min(flights);
        // A flight takes as long whether its lanes are full or not. The checks are some more, of their own length.
        let again = FinerPlans::for_case(case).share_of_run() * flights as f64;
        let rounds = (flights.div_ceil(busy) as f64).max((flights as f64 + again) / busy as f64);
        let flying = pace(case, Isa::detect())? * case.run.steps as f64 * rounds;
        Ok(Self {
            wall_s: reading + flying + FIGURES + WRITING * positions(case),
            threads: busy,
            memory_bytes: memory(case, busy),
        })
    }
}

/// Largest memory of a run on so many threads [bytes]: while its files are read, while it flies, or while
/// figures are drawn.
fn memory(case: &Case, threads: u64) -> f64 {
    /// The program itself, and the figures that it draws when the flights are over.
    const PROGRAM: f64 = 15.0 * (1u64 << 20) as f64;
    const FIGURES: f64 = 20.0 * (1u64 << 20) as f64;
    /// Bytes of a position that is read back from the file of the shapes, there and in the report.
    const POSITION: f64 = 2.0 * 24.0;
    /// Rows of the tables that wait to be written, of 18 numbers, in lists that may be half empty; and those of fibres
    /// whose turn has not come.
    const ROWS: f64 = (2 << 15) as f64;
    const ROW: f64 = 18.0 * 8.0;
    let air = &case.air;
    let reading = match &air.flow {
        Flow::Field(placed) => placed.field.memory_while_made() as f64 + largest_file(air),
        Flow::Uniform | Flow::Profile(_) => 0.0,
    };
    let rows = instants(case) * case.run.replicates as f64;
    let fibres = (WIDTH as u64 * threads).min(case.run.replicates) as f64;
    let flying = case.flight_memory().total() * threads as f64
        + ROW * rows.min(ROWS)
        + (2.0 * ROW * instants(case) * fibres).min(ROOM as f64);
    let drawing = FIGURES + POSITION * positions(case).min(POSITIONS_OF_PAGE as f64);
    PROGRAM + reading.max(air.field_memory() as f64 + flying.max(drawing))
}

/// Size of the largest of the files of the air [bytes]; they are read one after the other.
fn largest_file(air: &Air) -> f64 {
    let size = |file: &Path| fs::metadata(file).map_or(0, |about| about.len()) as f64;
    let bytes = |(file, parts): (&Path, &[PathBuf])| {
        let folder = file.parent().unwrap_or(Path::new(""));
        parts.iter().map(|part| size(&folder.join(part))).fold(size(file), f64::max)
    };
    air.files().into_iter().map(bytes).fold(0.0, f64::max)
}

/// Number of recorded instants of a fibre.
fn instants(case: &Case) -> f64 {
    (case.run.steps / case.run.output_steps + 1) as f64
}

/// Number of node positions that are kept for the report and ParaView.
fn positions(case: &Case) -> f64 {
    let shapes = KeepShapes::within(case, POSITIONS);
    instants(case) / shapes.every as f64 * shapes.replicates as f64 * (case.fibre.elements + 1) as f64
}

/// An expected time in words.
pub(crate) fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => "less than a second".to_owned(),
        s if s < 120.0 => format!("about {s:.0} s"),
        s if s < 7200.0 => format!("about {:.0} min", s / 60.0),
        s => format!("about {:.0} h", s / 3600.0),
    }
}
