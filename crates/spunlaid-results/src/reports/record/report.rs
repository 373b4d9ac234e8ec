//! The report of the analysis of a velocity record.

use super::files::with_interval;
use crate::numbers::{THIN, significant};
use crate::page::document::{Report, Section};
use crate::page::methods::methods;
use crate::page::table::{Content, Layout, Row, Table};
use crate::page::words::{count, time};
use spunlaid_air::{Analysis, COMPONENT_MEASURES, Component, RECORD_MEASURES, Record};
use spunlaid_charts::Figure;
use spunlaid_ground::{Dimension, Interval, Measure, Measured, measure};

/// What was found in a velocity record.
///
/// * `remarks` – about the reading of the record
/// * `air` – the [air] of a case
pub fn analysis_report<'a>(
    record: &Record,
    analysis: &Analysis,
    figures: &'a [Figure],
    remarks: &[String],
    air: &str,
) -> Report<'a> {
    let (headline, summary) = (headline(analysis), summary(record, analysis));
    let steps = steps(analysis);
    let remarks: String = remarks.iter().map(|remark| format!(" {remark}.")).collect();
    let [of_air, components] = numbers(analysis);
    let computed = Section::new("methods", "How it was computed").descriptions(steps).caption(
        "The curves are in spectrum.csv and autocorrelation.csv, all numbers in analysis.json, next to this page.",
    );
    Report::new("analyse", headline)
        .lead(summary + &remarks)
        .with(of_air.file("air-toml", air).printed())
        .with(Section::of_figures(figures))
        .with(components.printed())
        .with(computed)
        .with(methods("analyse", Vec::new(), ""))
}

/// The numbers for the air of a case, then those of each component.
fn numbers(analysis: &Analysis) -> [Section<'static>; 2] {
    let air = table(RECORD_MEASURES, analysis);
    let air = Section::new("air", "The air of a case").table(air).caption(durations(analysis));
    let of_each = Section::new("components", "Each component");
    let add = |section: Section<'static>, component: &Component| {
        section.heading(&component.name).table(table(COMPONENT_MEASURES, component))
    };
    [air, analysis.components.iter().fold(of_each, add)]
}

/// The measures that have a label.
fn table<T>(measures: &'static [Measure<T>], found: &T) -> Table {
    let columns = [
        ("Result", Content::Words),
        ("Value", Content::Numbers),
        ("from", Content::Asides),
        ("to", Content::Asides),
        ("Unit", Content::Words),
        ("How", Content::Sentences),
    ];
    let row = |row: Measured<T>| {
        let about = [row.measure.unit.shown, row.meaning()].map(str::to_owned);
        Row::new(row.measure.label, with_interval(&row, found).into_iter().chain(about))
    };
    let labelled = measure::measured(measures, found).filter(|row| !row.measure.label.is_empty());
    Table::of(columns).laid_out(Layout::Results).rows(labelled.map(row))
}

/// With the numbers of the table below it, and their intervals.
fn headline(analysis: &Analysis) -> String {
    let shown_of = |name: &str| {
        let row = measure::measured(RECORD_MEASURES, analysis).find(|row| row.measure.label == name);
        row.map_or_else(String::new, |row| {
            let [value, low, high] = with_interval(&row, analysis);
            format!("{value}{THIN}{} ({low} to {high})", row.measure.unit.shown)
        })
    };
    let [velocity, intensity, length] =
        ["Mean velocity", "Turbulence intensity", "Length scale"].map(shown_of);
    format!(
        "The air flows at {velocity} with a turbulence intensity of {intensity} and a length scale of {length}."
    )
}

fn summary(record: &Record, analysis: &Analysis) -> String {
    let names: Vec<&str> = analysis.components.iter().map(|c| c.name.as_str()).collect();
    format!(
        "From {}: {} of {} at {} over {}, {} integral times. The ranges here and in the tables are \
         95{THIN}% confidence intervals.",
        record.file,
        count(analysis.samples as u64, "sample"),
        names.join(", "),
        Dimension::Frequency.pretty(1.0 / analysis.interval),
        time(analysis.duration),
        significant((analysis.duration / analysis.integral_time.value).round(), 3),
    )
}

fn durations(analysis: &Analysis) -> String {
    let long = |interval: &Interval| time(analysis.duration_for(interval, 0.05));
    format!(
        "Intervals shrink with the square root of the length of the record. An interval of ±{THIN}5{THIN}% \
        needs a record of {} for the turbulence intensity, {} for the integral time and the length scale, \
        and {} for the cut-off.",
        long(&analysis.turbulence_intensity),
        long(&analysis.integral_time),
        long(&analysis.cutoff_frequency),
    )
}

/// How each number was computed.
fn steps(analysis: &Analysis) -> Vec<(&'static str, String)> {
    let Some(along) = analysis.components.first() else { return Vec::new() };
    let (spectrum, flat) = (&along.spectrum, &along.flat);
    let hertz = |f: f64| Dimension::Frequency.pretty_to(f, 3);
    vec![
        (
            "Intervals",
            format!(
                "The record is cut into {} blocks, each many integral times long, and every result is \
                computed again with each block left out; the scatter of these gives the interval, by \
                Student’s distribution (block jackknife). For plateau and cut-off the number of independent \
                values averaged, here {}, gives it.",
                analysis.blocks,
                flat.independent.round()
            ),
        ),
        (
            "Autocorrelation",
            "The mean product of two fluctuations one lag apart, over the variance. The sum is divided by \
            the number of pairs at that lag (the unbiased estimate)."
                .to_owned(),
        ),
        (
            "Integral time",
            format!(
                "The autocorrelation of {} is integrated by the trapezoidal rule {}, here a lag of {}. The \
                option --integral chooses the first zero, 1/e or a fixed lag. An integral to the first zero \
                leaves out negative values after it: for a flat spectrum it is 18{THIN}% too long.",
                along.name,
                analysis.integral.words(),
                time(along.autocorrelation.limit)
            ),
        ),
        (
            "Spectrum",
            format!(
                "Welch’s method: {} of {}, {} window, overlapping by {}{THIN}%, about the mean of the whole \
                record; one-sided, so that its integral over frequency is the variance.",
                count(spectrum.segments as u64, "segment"),
                count(spectrum.segment as u64, "sample"),
                spectrum.window.name(),
                (100.0 * spectrum.overlap).round()
            ),
        ),
        (
            "Plateau and cut-off",
            format!(
                "The mean density up to {}. The cut-off is the variance over this plateau: a flat spectrum \
                that ends at the cut-off has the same variance and the same plateau. {}",
                hertz(flat.until),
                if flat.from < spectrum.step {
                    "The record is too short for segments, so the mean is that of the Fourier components of the \
                     whole record, at least ten if they lie below a third of the cut-off. It is corrected by half of \
                     the decrease that the spectra of an exponential correlation and of von Kármán have there."
                } else {
                    "The mean ends at an eighth of the cut-off unless --flat-until gives another frequency. There most \
                     spectra have begun to fall, which makes the plateau one to two per cent too low and the cut-off \
                     too high by the same share."
                }
            ),
        ),
        (
            "Length scale",
            "Integral time times mean velocity, by Taylor’s hypothesis: the flow carries the turbulence past the probe \
             faster than the turbulence changes."
                .to_owned(),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reports::record::figures::record_figures;
    use crate::reports::record::sample as record_sample;

    fn page(name: &str, components: usize, samples: usize) -> String {
        let (record, analysis) = record_sample::autoregression(components, samples);
        let figures = record_figures(&record, &analysis);
        let remarks = [format!("{name} remark")];
        analysis_report(&record, &analysis, &figures, &remarks, "[air]\n").named(name).html()
    }

    #[test]
    fn holds_what_it_should_and_asks_nothing_of_the_network() {
        for (components, samples) in [(1, 64), (3, 20_000)] {
            let page = page("wire", components, samples);
            assert!(page.len() < 2_000_000 && !page.contains("NaN"), "{} bytes", page.len());
            assert_eq!(page.matches("<svg").count(), 4);
            for word in ["Mean velocity", "Cut-off frequency", "Flatness", "[air]", "Student"] {
                assert!(page.contains(word), "{word}");
            }
            for word in ["src=\"", "href=\"http", "@import", "url(http", "<script src"] {
                assert!(!page.contains(word), "{word}");
            }
        }
    }

    #[test]
    fn escapes_what_the_user_wrote() {
        let page = page("<script>alert('x')</script>", 1, 300);
        assert!(!page.contains("<script>alert"));
    }
}
