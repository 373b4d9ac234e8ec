//! Writes a velocity record as a hot wire would make it in the simulated air of Table 1 of the paper:
//!
//! ```text
//! cargo run --release -p spunlaid --example probe -- cases/records/probe.csv
//! ```
//!
//! One eddy of 10 m/s, 10 % turbulence and 100 Hz for 10 s at 1 kHz, u and v to a millimetre a second. What
//! `spunlaid analyse` finds in it is known beforehand: these values, and by the first zero of the
//! autocorrelation an integral time of Si(π)/(2π f) = 2.95 ms.
#![allow(clippy::expect_used, clippy::print_stderr)]

use spunlaid::air::{Air, StreamKey, Wind};
use spunlaid::ground::Isa;
use std::fmt::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    let Some(path) = std::env::args_os().nth(1) else {
        eprintln!("usage: probe FILE.csv");
        return ExitCode::FAILURE;
    };
    match std::fs::write(&path, record()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}: {error}", path.display());
            ExitCode::FAILURE
        }
    }
}

fn record() -> String {
    let (rate, samples) = (1000.0, 10_000);
    let air = Air { harmonics: 1 << 12, ..Air::uniform(10.0, 0.1, 0.05, 100.0) };
    let stream = [(air.clone(), StreamKey { seed: 1, replicate: 0 })];
    let mut wind =
        Wind::uniform(Isa::detect(), &stream, 1, f64::from(samples) / rate).expect("fibres that agree");
    let mut text = String::from(
        "# The simulated air of Table 1 at a point: 10 m/s, 10 % turbulence, flat to 100 Hz; seed 1.\n\
         # Made by: cargo run --release -p spunlaid --example probe -- cases/records/probe.csv\n\
         time_s,u_m_s,v_m_s\n",
    );
    for i in 0..samples {
        let time = f64::from(i) / rate;
        let v = wind.at(time)[0].lane(0);
        // Writing to a text cannot fail.
        let _ = writeln!(text, "{time:.3},{:.3},{:.3}", v.x, v.y);
    }
    text
}
