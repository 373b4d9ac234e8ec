//! Many flights: ensembles, studies, their effects, and fibres that are simulated together.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/studies.rs"]
mod short;

mod company;
mod company_cases;
mod effects;
mod ensembles;
mod finer_checks;
mod flown_tension;
mod paper;
mod starters;
mod studies;
mod turbulence_of_case;
mod web_keys;
mod web_studies;
