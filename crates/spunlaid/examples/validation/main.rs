//! Measures the "found" column of `docs/validation.md` on this machine, with the tests' own reference models.
//!
//!     cargo run --release --example validation

// The tests' shared models come with the licences of tests.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

mod advice;
#[path = "../../tests/common/closed_loops.rs"]
mod closed_loops;
#[path = "../../tests/common/mod.rs"]
mod common;
mod fits;
mod flights;
mod levels;
mod looks;
mod mechanics;
#[path = "../../tests/common/scans.rs"]
mod pictures;
mod scans;
mod turbulence;
mod webs;

fn main() {
    let asked = |what: &str| std::env::args().any(|word| word == what);
    if asked("webs") {
        return webs::intervals();
    }
    if asked("levels") {
        return levels::savings();
    }
    if asked("looks") {
        return looks::shares();
    }
    if asked("advice") {
        return advice::changes();
    }
    if asked("fits") {
        return fits::intervals();
    }
    if asked("scans") {
        scans::intervals();
        return scans::spots();
    }
    println!("kernel: {}", spunlaid::ground::Isa::detect().name());
    mechanics::forces();
    mechanics::terminal_velocity();
    mechanics::cantilevers();
    mechanics::pure_moment();
    mechanics::hanging_chain();
    mechanics::beam();
    mechanics::axial_chain();
    mechanics::taut_string();
    turbulence::sum_of_cosines();
    turbulence::statistics();
    turbulence::spectrum();
    flights::orders();
    flights::work_identity();
    flights::errors_by_step();
    flights::table1();
    flights::trends();
}

fn title(text: &str) {
    println!("\n{text}");
}
