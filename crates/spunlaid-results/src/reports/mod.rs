//! What results are of. The `mod.rs` of a product has its folder: what is known, and what is made of it; its figures,
//! files and report stand beside it. A product imports only from those above it.
//!
//! ```text
//! spinline, load        what comes from the die, and what filaments do to their air: reports, and parts of others
//! run                   a case that was simulated; its checks, tables and moving fibre
//! air, record, sources  the air of a case, a measured one, the force on the cells of a field
//! web, scan             a web that was laid, and one that was scanned
//! fit, study, paper     many webs or runs
//! comparison            folders of finished runs or webs side by side
//! ```

pub mod spinline;

pub mod load;

pub mod run;

pub mod air;
pub mod record;
pub mod sources;

pub mod web;

pub mod finished;
pub mod scan;

pub mod fit;

pub mod study;

pub mod paper;

pub mod comparison;

#[cfg(test)]
mod declared;
