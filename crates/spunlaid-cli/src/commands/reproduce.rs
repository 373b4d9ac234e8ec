//! `spunlaid reproduce`: draws the paper's figures again and tests its claims.

use super::counted;
use crate::args::{Invocation, Reproduce};
use crate::control::control;
use crate::delivery::Delivery;
use crate::failure::Failure;
use crate::progress;
use spunlaid::ground::Fault;
use spunlaid::input::paper::table1;
use spunlaid_results::files::pictures::Format;
use spunlaid_results::reports::paper::{FIGURES, PaperFlights, PaperFolder};
use std::sync::atomic::AtomicU64;

pub(crate) fn reproduce(arguments: &Reproduce, invocation: &Invocation) -> Result<(), Failure> {
    let formats: Vec<&Format> =
        arguments.figures.iter().filter_map(|name| Format::named(name).ok()).collect();
    let wanted = chosen(arguments.figures.iter().filter(|name| Format::named(name).is_err()).collect())?;
    let mut base = table1(arguments.scheme)?;
    base.run.replicates = arguments.replicates;
    let figures = arguments.width.files(&formats);
    let delivery = Delivery::open::<PaperFolder<'_>>(invocation, [], "paper", &arguments.output, figures)?;
    let flying = PaperFlights::new(&base, &wanted)?;

    let fibre_steps = AtomicU64::new(0);
    let computing = control(arguments.threads, &fibre_steps);
    let label = format!("simulating {}", counted(flying.fibres(), "fibre"));
    let (steps, quiet) = (flying.steps(), arguments.output.quiet);
    let simulated = progress::follow(&fibre_steps, steps, &label, quiet, || flying.fly(computing))?;
    let contents = PaperFolder {
        claims: &simulated.claims(),
        figures: &simulated.figures(&base),
        choices: &simulated.choices(),
        how: &simulated.how(),
        case: &base,
    };
    delivery.deliver(&contents, arguments.threads, &[])
}

/// The requested figures, or all if none are named. `8`, `9` and `11` mean all their parts.
fn chosen(names: Vec<&String>) -> Result<Vec<&'static str>, Failure> {
    if names.is_empty() {
        return Ok(FIGURES.to_vec());
    }
    let mut figures = Vec::new();
    for name in names {
        // 9a and 9b come from the same flights.
        let plain = match name.as_str() {
            "9a" | "9b" => "9",
            "10a" | "10b" => "10",
            other => other,
        };
        let part = |figure: &str| figure.trim_end_matches(char::is_alphabetic) == plain;
        let found: Vec<_> = FIGURES.into_iter().filter(|&figure| figure == plain || part(figure)).collect();
        if found.is_empty() {
            let message = format!("--figures {name}: there is no such result figure");
            let remedy = format!("write some of {}, or svg, png, pdf", FIGURES.join(", "));
            return Err(Fault::new(message, remedy).into());
        }
        figures.extend(found);
    }
    Ok(FIGURES.into_iter().filter(|figure| figures.contains(figure)).collect())
}
