//! What a flight costs on this machine, in nanoseconds per element and step of a fibre.
//!
//!     cargo bench -p spunlaid                       # all of it, two minutes
//!     cargo bench -p spunlaid -- kernel threads     # parts: kernel, growth, fed, web, spinline, wind, field,
//!                                                   # eddies, ensemble, threads, accuracy
//!
//! Processor time, the least of many short repetitions taken in turn; absolute figures wander with the
//! machine's clock, ratios within a run hold. What the figures were, and the least they could be, is in
//! `docs/validation.md`, “Speed and memory”.

// The tests' shared models come with the licences of tests.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

mod accuracy;
#[path = "../../tests/common/mod.rs"]
mod common;
mod eddies;
mod ensemble;
mod fed;
mod field;
mod flights;
mod kernel;
mod measure;
mod spinline;
mod web;
mod wind;

fn main() {
    let asked: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let parts: [(&str, fn()); 11] = [
        ("kernel", kernel::instruction_sets),
        ("growth", kernel::growth),
        ("fed", fed::against_fixed),
        ("web", web::costs),
        ("spinline", spinline::costs),
        ("wind", wind::costs),
        ("field", field::costs),
        ("eddies", eddies::looks),
        ("ensemble", ensemble::costs),
        ("threads", ensemble::threads),
        ("accuracy", accuracy::of_steps),
    ];
    for (name, part) in parts {
        if asked.is_empty() || asked.iter().any(|a| a == name) {
            part();
        }
    }
}

fn title(text: &str) {
    println!("\n{text}");
}
