//! The program `spunlaid`; all of it is in `lib.rs`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(spunlaid_cli::main(std::env::args_os()))
}
