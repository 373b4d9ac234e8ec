//! What a web means: the numbers of its line, its air, and its load on it.

use crate::numbers::{THIN, in_sentence, signed, significant};
use crate::reports::load::{load_of, load_words};
use crate::reports::run::checked::duration;
use crate::reports::spinline::files::SpinResults;
use spunlaid_air::{Air, Axis, Cabin, Lateral, PlacedField};
use spunlaid_charts::label::plain;
use spunlaid_experiment::Change;
use spunlaid_experiment::advice::{are_short, steps};
use spunlaid_fibre::{BREAKDOWN, ChargeEstimate, Load};
use spunlaid_ground::error::counted;
use spunlaid_ground::threads::try_par_map;
use spunlaid_ground::{Dimension, Error, Isa, WIDTH};
use spunlaid_input::{Influence, LaydownSource, LayerSpec, OfFilament, WebSpec};
use spunlaid_simulation::PlannedFlight;
use spunlaid_simulation::ensemble::pace;
use spunlaid_web::map::Filaments;

/// What a web means, in lines.
pub fn about_web(spec: &WebSpec) -> Vec<String> {
    [line(spec), spinlines(spec), sheet(spec).to_vec(), air(spec), load(spec), assumed_values(spec)].concat()
}

/// The numbers by which a line is known: `20 g/m² on a belt of 2.083 m/s`, `150 kg/h`.
pub fn numbers_of_line(spec: &WebSpec) -> [String; 3] {
    [
        format!("{} g/m²", significant(spec.weight() * 1e3, 4)),
        Dimension::Velocity.pretty(spec.belt_speed),
        format!("{} kg/h", significant(spec.mass_flow() * 3600.0, 4)),
    ]
}

/// The numbers of the line, and those of each layer.
fn line(spec: &WebSpec) -> Vec<String> {
    let [weight, belt, flow] = numbers_of_line(spec);
    let whole = format!("  {weight} on a belt of {belt}: {flow} from each metre of width");
    let several = spec.layers.len() > 1;
    let layer = |(number, layer): (usize, &LayerSpec)| {
        let name = layer.name.as_ref().map_or_else(|| (number + 1).to_string(), |name| format!("\"{name}\""));
        let filaments = layer.filaments.count(&spec.sheet);
        let alone = spec.alone(number).weight();
        let filament = layer.fed_filament();
        format!(
            "  {}{} holes per metre of width, each with {} g/min: filaments of {} dtex, {}, fed at {}; {} of \
            filament on each metre of belt{}",
            if several { format!("layer {name}: ") } else { String::new() },
            significant(filaments as f64 / spec.sheet.width, 4),
            significant(filament.throughput() * 6e4, 4),
            significant(filament.linear_density() * 1e7, 4),
            Dimension::Length.pretty(filament.diameter()),
            Dimension::Velocity.pretty(filament.feed_speed()),
            Dimension::Length.pretty_to(filament.feed_speed() / spec.belt_speed, 3),
            if several { format!("; {} g/m²", significant(alone * 1e3, 4)) } else { String::new() },
        )
    };
    let layers = spec.layers.iter().enumerate();
    let layers = layers.flat_map(|(number, of)| [layer((number, of))].into_iter().chain(charge(spec, of)));
    ["line".to_owned(), whole].into_iter().chain(layers).collect()
}

/// Most numbers of a spinline whose influence on the titre is shown.
const INFLUENCES: usize = 6;

/// What 1 % or 10 K more of a number does to the titre [%], and in words.
fn on_titre(influence: &Influence) -> Option<(f64, String)> {
    // The titre is throughput over speed.
    let of_throughput = if influence.change.setting.name == "spinline.throughput" { 1.0 } else { 0.0 };
    let change = of_throughput - influence.on(OfFilament::Speed)?.difference.value;
    let (more, percent) = match influence.change.keys[0].by_kelvin {
        true => ("10 K", 100.0 * change),
        false => ("1 %", change),
    };
    let words = influence.change.setting.words;
    // Without its symbol.
    let label = in_sentence(&plain(words.split(" *").next().unwrap_or(words)));
    (percent.abs() > 0.005).then(|| (percent, format!("{label}, {more} more: {} %", signed(percent, 2))))
}

/// What decides titre and speed of the filaments that come from a die.
fn spinlines(spec: &WebSpec) -> Vec<String> {
    let of_layer = |layer: &LayerSpec| {
        let case = layer.source.case()?;
        let line = case.spinline.as_deref()?;
        let results = SpinResults::from_case(case)?;
        let filament = results.rows.first()?;
        let mut influences: Vec<(f64, String)> = results
            .influences
            .iter()
            .filter(|influence| !influence.change.setting.name.starts_with("spinline.material."))
            .filter_map(on_titre)
            .collect();
        influences.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
        let shown: Vec<String> = influences.into_iter().take(INFLUENCES).map(|(_, words)| words).collect();
        let follows = format!(
            "  {} dtex at {} follow from throughput, melt and air, with {} times the drag of its law \
            (spinline.drag_factor)",
            significant(filament.linear_density * 1e7, 4),
            Dimension::Velocity.pretty(filament.final_speed),
            significant(line.drag_factor, 4),
        );
        Some([follows, format!("  what moves the titre: {}", shown.join("; "))])
    };
    let mut lines = vec!["from the die".to_owned()];
    for line in spec.layers.iter().filter_map(of_layer).flatten() {
        if !lines.contains(&line) {
            lines.push(line);
        }
    }
    if lines.len() > 1 { lines } else { Vec::new() }
}

/// What the charge of a layer does; None of filaments without charge.
fn charge(spec: &WebSpec, layer: &LayerSpec) -> Option<String> {
    let ChargeEstimate { edge_field, over_weight } = layer.charge_estimate(&spec.sheet)?;
    Some(format!(
        "  charged with {}: about {} at the edge of the curtain, which pulls at a filament with {} times its \
        weight; air breaks down at {}",
        Dimension::SpecificCharge.pretty(layer.charge?),
        Dimension::ElectricField.pretty_to(edge_field, 2),
        significant(over_weight, 2),
        Dimension::ElectricField.pretty(BREAKDOWN),
    ))
}

fn sheet(spec: &WebSpec) -> [String; 2] {
    let size = |size: f64| Dimension::Length.pretty(size);
    let [columns, rows] = spec.sheet.cells();
    let filaments: u64 = spec.layers.iter().map(|layer| layer.filaments.count(&spec.sheet)).sum();
    let whole = format!(
        "  {} wide and {} long, {columns} × {rows} cells of {}; {} cross it",
        size(spec.sheet.width),
        size(spec.sheet.length),
        size(spec.sheet.cell),
        counted(filaments, "filament"),
    );
    ["sheet".to_owned(), whole]
}

/// In which air the filaments hang, and what that means for the CV.
fn air(spec: &WebSpec) -> Vec<String> {
    let simulated = |layer: &LayerSpec| {
        let path = layer.source.path().display();
        match &layer.source {
            LaydownSource::Surrogate(_) => {
                vec!["  nothing is simulated: the standard deviations and the noise are given".to_owned()]
            }
            LaydownSource::Case { case, .. } => {
                let eddies = format!("  {path}: its eddies lie in space (air.lateral = \"von-karman\")");
                let field = case.air.flow.field().map(|placed| place_in_field(placed, &layer.filaments));
                [Some(eddies), field, cabin(&case.air)].into_iter().flatten().collect()
            }
        }
    };
    let mut lines = vec!["air".to_owned()];
    for line in spec.layers.iter().flat_map(simulated) {
        if !lines.contains(&line) {
            lines.push(line);
        }
    }
    lines.extend(if spec.flies() { in_one_air(spec) } else { independent() });
    lines
}

/// The pressure of the cabin and the velocity at the slot, whichever is given; None where the slot may lie outside of a
/// field.
fn cabin(air: &Air) -> Option<String> {
    let velocity = air.velocity_at_slot()?;
    let cabin = air.cabin().unwrap_or_else(|| Cabin::of_speed(velocity, air.speed_coefficient, air.density));
    let pressure = Dimension::Pressure.pretty_to(cabin.pressure, 3);
    let velocity = Dimension::Velocity.pretty_to(velocity, 3);
    let pair = match air.cabin_pressure {
        Some(_) => format!("{pressure} in the cabin above that under the belt: {velocity} at the slot"),
        None => format!("{velocity} at the slot: about {pressure} in the cabin above that under the belt"),
    };
    Some(format!("  {pair}, with a coefficient of speed of {}", significant(cabin.coefficient, 4)))
}

/// Where the filaments are fed in a field.
fn place_in_field(placed: &PlacedField, filaments: &Filaments) -> String {
    let [from, to] = filaments.depths().map(|y| Dimension::Length.pretty_to(y + 0.0, 3));
    let fed = if from == to { format!("at {from}") } else { format!("from {from} to {to}") };
    let [_, machine, cross] = placed.axes().map(Axis::name);
    format!(
        "  the middle of the slot is at {} of the field (air.field_root); filaments are fed {fed} from there along the \
        machine direction, {machine}. They are side by side along the cross direction, {cross}, in the same \
        mean flow",
        PlacedField::in_words(placed.root)
    )
}

/// Whether the filaments come down at random places of one row.
fn is_at_random(spec: &WebSpec) -> bool {
    spec.layers.iter().any(|layer| matches!(layer.filaments, Filaments::AtRandom { .. }))
}

/// How many filaments of each layer are simulated on which sheet, and what memory their air takes.
fn in_one_air(spec: &WebSpec) -> Vec<String> {
    let flights = spec.planned_flights();
    let size = |size: f64| Dimension::Length.pretty(size);
    let flight = |(number, (flight, layer)): (usize, (&PlannedFlight, &LayerSpec))| {
        let all = layer.filaments.count(&spec.sheet);
        let [width, length] = flight.sheet.map(size);
        let of = if spec.layers.len() > 1 { format!(" of layer {}", number + 1) } else { String::new() };
        match flight.is_few {
            true => format!(
                "  {}{of} are simulated in shared turbulence, on a sheet of {width} × {length}; the web of {all} \
                is estimated from them (web.simulated){}",
                counted(flight.filaments, "filament"),
                match flight.coarse_sheets {
                    0 => String::new(),
                    sheets => format!(
                        "; about {} in other turbulence with a coarse mesh, to reach the error of the CV (web.error)",
                        counted(sheets, "more sheet")
                    ),
                }
            ),
            false => format!(
                "  all {}{of} are simulated in shared turbulence, so neighbours land together",
                counted(flight.filaments, "filament")
            ),
        }
    };
    let mut lines: Vec<String> = flights.iter().zip(&spec.layers).enumerate().map(flight).collect();
    // The layers are simulated one after the other.
    let memory = flights.iter().map(|flight| flight.memory).fold(0.0, f64::max);
    lines.push(format!("  the field takes {} of memory", Dimension::Memory.pretty_to(memory, 2)));
    if is_at_random(spec) {
        lines.push(
            "  they come in one row, at random positions; the slot of a line has a gap: --set line.slot_gap=\"20 \
            mm\""
                .to_owned(),
        );
    }
    lines
}

/// What is known of the load of the filaments of a layer on their air before a flight.
fn curtain(spec: &WebSpec, layer: &LayerSpec) -> Option<Load> {
    let filaments_per_metre = layer.filaments.count(&spec.sheet) as f64 / spec.sheet.width;
    load_of(layer.source.case()?, filaments_per_metre, layer.filaments.slot(), &[])
}

/// The load of the filaments on their air, as far as no flight is needed.
fn load(spec: &WebSpec) -> Vec<String> {
    let words = |layer: &LayerSpec| Some(load_words(&curtain(spec, layer)?).replace(THIN, " "));
    let mut lines = vec!["load on the air".to_owned()];
    for (number, words) in
        spec.layers.iter().enumerate().filter_map(|(i, layer)| Some((i + 1, words(layer)?)))
    {
        lines.push(match spec.layers.len() {
            1 => format!("  {words}"),
            _ => format!("  layer {number}: {words}"),
        });
    }
    if lines.len() > 1 { lines } else { Vec::new() }
}

/// What the web, other values of its assumed numbers and changes of its line are expected to take, in lines.
///
/// * `threads` – on which they would fly
/// * `changes` – the values and the changes
///
/// # Errors
/// If a case cannot be simulated.
pub fn expected_of_web(
    spec: &WebSpec,
    threads: usize,
    [assumed, of_line]: [&[Change]; 2],
) -> Result<Vec<String>, Error> {
    let (flights, concurrent) = (spec.planned_flights(), threads.max(1) as f64);
    let mut each = Vec::new();
    for case in spec.cases() {
        // All filaments share a field, whose time is in the factors.
        let mut alone = case.clone();
        alone.air.lateral = Lateral::Uniform;
        // On all threads together, because they may share a core. A thread flies eight filaments at once.
        let paces = try_par_map(threads, threads.max(1), |_| pace(&alone, Isa::detect()))?;
        let pace = paces.iter().sum::<f64>() / paces.len() as f64;
        each.push(pace / (WIDTH as f64 * concurrent));
    }
    let flying = flights
        .iter()
        .zip(&each)
        .map(|(flight, each)| (flight.steps + flight.coarse_steps) as f64 * each)
        .sum::<f64>();
    let laid = |layer: &LayerSpec| layer.filaments.count(&spec.sheet) as f64 * spec.fed_length(layer);
    let cells = spec.layers.iter().map(laid).sum::<f64>() / spec.sheet.cell;
    let web = format!("  the web: {}", duration(FIGURES + FINDING * flying + LAYING * cells / concurrent));
    let each = each.iter().sum::<f64>() / each.len().max(1) as f64;
    let trial = |changes: &[Change], noun: &str, words: &str| {
        let seconds = match spec.flies() {
            true => TRIAL * steps(spec, changes) as f64 * each,
            false => KNOWN * changes.len() as f64 / concurrent,
        };
        let is_few = flights.iter().all(|flight| flight.is_few);
        let asked = if is_few && are_short(spec, changes) { "" } else { "; only with --advice" };
        let count = counted(changes.len() as u64, noun);
        (!changes.is_empty()).then(|| format!("  {words}, {count}: {}{asked}", duration(seconds)))
    };
    let trials =
        [trial(assumed, "other value", "assumptions (web.assumed)"), trial(of_line, "change", "advice")];
    let head = format!("expected, on {}", counted(threads as u64, "thread"));
    Ok([head, web].into_iter().chain(trials.into_iter().flatten()).collect())
}

/// Time for figures and report, for a cell that a fibre crosses, and for a change of a web of known numbers [s]; time
/// of a web and of its changes over that of their flights.
const FIGURES: f64 = 1.5;
const LAYING: f64 = 1.2e-8;
const KNOWN: f64 = 0.2;
const FINDING: f64 = 5.0;
const TRIAL: f64 = 5.4;

/// Which numbers are assumed values, and what is done about them.
fn assumed_values(spec: &WebSpec) -> Vec<String> {
    if spec.assumed.is_empty() {
        return Vec::new();
    }
    let each = format!(
        "  {}: spunlaid web also gives the CV for half and twice of each, from a sample of filaments",
        spec.assumed.join(", ")
    );
    vec!["assumed values (web.assumed)".to_owned(), each]
}

/// That the web is a lower bound, and the way out of it.
fn independent() -> Vec<String> {
    vec![
        "  the filaments are independent of each other, which gives a lower bound of the CV".to_owned(),
        "  to simulate them in shared turbulence, as in a line: name a case in laydown.case".to_owned(),
    ]
}
