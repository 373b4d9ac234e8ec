//! Writes `air.toml`, the [air] of a case with the results of a record.

use super::half_width;
use crate::numbers::decimals;
use spunlaid_air::Analysis;
use spunlaid_ground::{Dimension, Interval};

/// The block; a comment after each value gives its interval and its origin.
pub fn air_block(file: &str, analysis: &Analysis) -> String {
    let along = analysis.components.first().map_or("u", |c| c.name.as_str());
    let names: Vec<&str> = analysis.components.iter().map(|c| c.name.as_str()).collect();
    let together = if names.len() == 1 { "" } else { " (mean of their energies)" };
    let lines = [
        (
            "velocity",
            &analysis.mean_velocity,
            Dimension::Velocity,
            if analysis.mean_velocity.low == analysis.mean_velocity.high {
                "as given with --mean-velocity".to_owned()
            } else {
                format!("mean of {along}")
            },
        ),
        (
            "turbulence_intensity",
            &analysis.turbulence_intensity,
            Dimension::Ratio,
            format!("rms of {}{together} over the mean velocity", names.join(", ")),
        ),
        (
            "length_scale",
            &analysis.length_scale,
            Dimension::Length,
            format!(
                "mean velocity times integral time {} (autocorrelation of {along}, {}): Taylor's hypothesis",
                Dimension::Time.pretty_to(analysis.integral_time.value, 3),
                analysis.integral.words()
            ),
        ),
        (
            "cutoff_frequency",
            &analysis.cutoff_frequency,
            Dimension::Frequency,
            format!(
                "variance of {along} over the plateau of its spectrum: here a flat spectrum with this \
                variance and this plateau would end"
            ),
        ),
    ];
    let values: Vec<String> = lines.iter().map(|(_, interval, d, _)| value(interval, *d)).collect();
    let sets =
        lines.iter().zip(&values).map(|((key, ..), v)| format!(" --set air.{key}={v}")).collect::<String>();
    let mut text = format!(
        "# The air of {}, computed by spunlaid analyse (version {}), with the 95 % confidence interval of each value.\n\
         # It replaces the [air] of a case. The same on the command line:\n\
         #   spunlaid run my.toml{sets} --out results/my-air\n\n[air]\n",
        one_line(file),
        env!("CARGO_PKG_VERSION"),
    );
    for ((key, interval, dimension, origin), value) in lines.iter().zip(&values) {
        let low = pretty(*dimension, interval, interval.low);
        let high = pretty(*dimension, interval, interval.high);
        let ends = if low == high { String::new() } else { format!("{low} to {high}; ") };
        text.push_str(&format!("{:<34} # {ends}{}\n", format!("{key} = {value}"), one_line(origin)));
    }
    text
}

/// The value in TOML.
fn value(interval: &Interval, dimension: Dimension) -> String {
    let text = pretty(dimension, interval, interval.value);
    if dimension == Dimension::Ratio { text } else { format!("\"{text}\"") }
}

/// Rounds to one digit more than the interval justifies.
fn pretty(dimension: Dimension, interval: &Interval, value: f64) -> String {
    let leading = interval.value.abs().log10().floor();
    let digits = decimals(half_width(interval)).map_or(6.0, |decimals| f64::from(decimals) + leading + 2.0);
    let digits = if digits.is_finite() { digits.clamp(3.0, 9.0) as usize } else { 4 };
    dimension.pretty_to(value, digits)
}

/// A comment ends with its line.
fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reports::record::sample as record_sample;
    use spunlaid_input::read_case;

    #[test]
    fn the_block_is_the_air_of_a_case() {
        let (_, analysis) = record_sample::autoregression(3, 20_000);
        let block = air_block("a\nb.csv", &analysis);
        let case = format!(
            "version = 1\n[fibre]\nlength = \"1 m\"\ndiameter = \"50 um\"\ndensity = \"950 kg/m3\"\n\
             youngs_modulus = \"2 GPa\"\n{block}[run]\nduration = \"1 s\"\ntime_step = \"1 us\"\n"
        );
        let (case, _) = read_case((&case, "made.toml"), &[]).unwrap_or_else(|e| panic!("{e}\n{block}"));
        for (written, interval) in [
            (case.air.velocity, analysis.mean_velocity),
            (case.air.turbulence_intensity, analysis.turbulence_intensity),
            (case.air.length_scale, analysis.length_scale),
            (case.air.cutoff_frequency, analysis.cutoff_frequency),
        ] {
            // Rounded to a hundredth of the interval's half width, or better.
            assert!(
                (written - interval.value).abs() <= 0.01 * (interval.high - interval.low),
                "{written} {interval:?}"
            );
        }
        // The same by way of the command line.
        let command = block.lines().find_map(|line| line.split_once("my.toml")).expect("the command").1;
        let (sets, _) = command.split_once(" --out ").expect("a folder of its own");
        for pair in sets.split(" --set ").skip(1) {
            let (key, value) = pair.split_once('=').expect("a key and a value");
            let set = [(key.to_owned(), value.trim_matches('"').to_owned())];
            read_case((spunlaid_input::starter_case(), "starter.toml"), &set)
                .unwrap_or_else(|e| panic!("{pair}: {e}"));
        }
    }
}
