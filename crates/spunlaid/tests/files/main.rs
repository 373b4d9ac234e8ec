//! Files of cases, studies and webs: what is read, what is remarked and what is refused, with its message.
#![allow(clippy::expect_used, clippy::panic, clippy::print_stdout, clippy::unwrap_used)]

#[path = "../common/cases.rs"]
mod cases;
#[path = "../../../../fuzz/checks.rs"]
mod checks;
#[path = "../messages/mod.rs"]
mod messages;

mod bad_spinlines;
mod bad_studies;
mod bad_webs;
mod case_files;
mod case_files_at_random;
mod case_notes;
mod fuzz_findings;
mod keys;
mod knobs;
mod one_file;
mod rejects;
mod relations;
mod slips;
mod web_files;
mod web_lines;
