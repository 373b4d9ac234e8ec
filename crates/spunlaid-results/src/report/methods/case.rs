//! What a case, a web or a spinline adds to the methods: model, numbers, and what they were taken from.

use super::reference::{CHAIN, Reference, SURROGATE};
use crate::numbers::{THIN, number, number_to, significant};
use crate::report::words::{self, count, length, quantity};
use spunlaid::air::{EddyModel, Flow, Lateral, SpectrumShape};
use spunlaid::case::Case;
use spunlaid::layers::{LaydownSource, LayerSpec, Method, WebSpec};
use spunlaid::web::LayerFew;

/// Sentences, and the works that they cite.
pub(in crate::report) type Account = (Vec<String>, Vec<Reference>);

/// The model of a fibre in flight, and all its numbers.
pub(in crate::report) fn case_account(case: &Case) -> Account {
    let (fibre, air, run) = (&case.fibre, &case.air, &case.run);
    let [along, across] = [case.drag.along.source(), case.drag.across.source()];
    let factor =
        case.drag.along.factor().map_or(String::new(), |factor| format!(" with β = {}", number(factor)));
    let mut sentences = vec![
        format!(
            "The fibre is a chain of beads joined by elastic elements, under tension, bending, gravity and \
            the drag of the air ({}).",
            CHAIN.short
        ),
        words::case(case),
        format!(
            "The fibre has a density of {} and a Young’s modulus of {}.",
            quantity(fibre.density, "kg/m³"),
            quantity(fibre.youngs_modulus * 1e-9, "GPa")
        ),
    ];
    let mut references = vec![CHAIN];
    if air.density > 0.0 {
        sentences.push(format!(
            "Its drag follows {}{factor} along the fibre and {} across it, in air of {} and a kinematic \
            viscosity of {}.",
            along.short,
            across.short,
            format_args!("{}{THIN}kg/m³", number_to(air.density, 4)),
            quantity(air.kinematic_viscosity * 1e6, "mm²/s")
        ));
        references.extend([along, across]);
        sentences.extend(flow(case));
    }
    if air.rms() > 0.0 && air.density > 0.0 {
        sentences.push(turbulence(case));
    }
    let left_out = match run.spin_up_steps {
        0 => String::new(),
        _ => format!(
            "; the first {} of each replicate are left out of all results",
            words::time(run.spin_up())
        ),
    };
    sentences.push(format!("The random numbers have the seed {}{left_out}.", run.seed));
    (sentences, references)
}

/// Where a mean flow that is not the same everywhere comes from.
fn flow(case: &Case) -> Option<String> {
    match &case.air.flow {
        Flow::Uniform => None,
        Flow::Profile(_) => Some("The mean flow is a table of values along the way of the fibre.".to_owned()),
        Flow::Field(placed) => Some(format!("The mean flow is a CFD solution, {}.", placed.field.describe())),
    }
}

/// How the turbulence is made.
fn turbulence(case: &Case) -> String {
    let air = &case.air;
    if let Some(record) = air.records.first() {
        let file = record.path().file_name().unwrap_or_default().to_string_lossy();
        return format!("The turbulence consists of stretches of a measured record, {file}.");
    }
    let shape = match air.spectrum {
        SpectrumShape::Flat => "a flat spectrum",
        SpectrumShape::VonKarman => "von Kármán’s spectrum",
        SpectrumShape::Measured(_) => "a measured spectrum",
    };
    let eddies = match air.eddies {
        EddyModel::Independent => "independent from eddy to eddy",
        EddyModel::Convected { .. } => "carried along by the mean flow",
    };
    let lateral = match air.lateral {
        Lateral::Uniform => "",
        _ => ", and it differs across the flow as isotropic turbulence does",
    };
    format!(
        "The turbulence has {shape} up to {}, a length scale of {}, and {} of random phase for each of its \
        three components, {eddies}{lateral}.",
        quantity(air.cutoff_frequency, "Hz"),
        length(air.length_scale),
        count(air.harmonics as u64, "harmonic")
    )
}

/// How a web is laid, and of what.
///
/// * `flown` – the few filaments of a web in one air; None before it is laid
pub(in crate::report) fn web_account(spec: &WebSpec, flown: Option<&[LayerFew]>) -> Account {
    let sheet = &spec.sheet;
    let how = match spec.method {
        Method::Surrogate => {
            format!("paths of a stochastic surrogate of the laid fibre ({})", SURROGATE.short)
        }
        Method::Dynamics => "the curves of the flown fibres".to_owned(),
        Method::SharedAir => in_one_air(spec, flown),
    };
    let mut sentences = vec![format!(
        "A sheet of {} across by {} along the belt was laid of {how}, on a map with cells of {} (seed {}).",
        length(sheet.width),
        length(sheet.length),
        length(sheet.cell),
        spec.seed
    )];
    let mut references = if spec.method == Method::Surrogate { vec![SURROGATE] } else { Vec::new() };
    let mut described: Vec<&Case> = Vec::new();
    for (number, layer) in spec.layers.iter().enumerate() {
        sentences.push(describe_layer(spec, layer, number));
        let Some(case) = layer.source.case().filter(|case| !described.contains(case)) else { continue };
        let (case_account, cited) = case_account(case);
        sentences.extend(case_account);
        references.extend(cited);
        described.push(case);
    }
    (sentences, references)
}

/// What is laid of a web in one air.
fn in_one_air(spec: &WebSpec, flown: Option<&[LayerFew]>) -> String {
    let flights = spec.planned_flights();
    let few: Vec<_> = flights.iter().filter(|flight| flight.is_few).collect();
    let Some(first) = few.first() else {
        return "the curves of all filaments of the sheet, which fly in one air".to_owned();
    };
    let all_few = few.len() == flights.len();
    // More may have been flown than were planned.
    let filaments = match flown {
        Some(flown) => flown.iter().map(|few| few.filaments + few.lost).sum(),
        None => few.iter().map(|flight| flight.filaments).sum(),
    };
    format!(
        "the curves of {}, which fly in one air on a sheet of {} by {}, {}and of the filaments between them, \
        which follow by simple kriging{}",
        count(filaments, "filament"),
        length(first.sheet[0]),
        length(first.sheet[1]),
        if all_few { "" } else { "of all filaments of the other layers, " },
        if first.sheet == [spec.sheet.width, spec.sheet.length] {
            ""
        } else {
            ", in pieces that are drawn at random"
        },
    )
}

fn describe_layer(spec: &WebSpec, layer: &LayerSpec, number: usize) -> String {
    let name = match (&layer.name, spec.layers.len()) {
        (Some(name), _) => format!("Layer {name}"),
        (None, 1) => "The web".to_owned(),
        (None, _) => format!("Layer {}", number + 1),
    };
    let known = match &layer.source {
        LaydownSource::Surrogate(surrogate) => format!(
            "; a filament spreads by {} in machine and {} in cross direction, and its direction has a noise of {}",
            length(surrogate.sigma_md),
            length(surrogate.sigma_cd),
            quantity(surrogate.noise, "m^-½")
        ),
        _ => String::new(),
    };
    format!(
        "{name} consists of {} of {} and {}{THIN}dtex, fed at {} onto a belt of {}{known}.",
        count(layer.filaments.count(&spec.sheet), "filament"),
        length(layer.diameter),
        significant(layer.linear_density() * 1e7, 3),
        quantity(layer.feed_speed, "m/s"),
        quantity(layer.belt_speed, "m/s")
    )
}
