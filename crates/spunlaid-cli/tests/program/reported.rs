//! A number is reported once: what a terminal shows is on the page in the same words, and each value with an error on
//! the page is one of the file of numbers, with the same error, unit and rounding. So it is for every command.

use crate::desk::{Desk, FED, success};
use crate::{fit, scan, sources, sweep};
use serde_json::Value;
use spunlaid_results::numbers::plus_minus;
use std::collections::BTreeSet;
use std::fs;

/// With spaces of one kind.
fn plain(text: &str) -> String {
    text.replace(['\u{a0}', '\u{202f}'], " ").split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The text between tags.
fn untagged(html: &str) -> String {
    let parts = html.split('<').map(|part| part.split_once('>').map_or(part, |(_, text)| text));
    let text: String = parts.collect::<Vec<_>>().join(" ");
    let marks =
        [("&#38;", "&"), ("&amp;", "&"), ("&#60;", "<"), ("&#62;", ">"), ("&#39;", "'"), ("&#34;", "\"")];
    plain(&marks.iter().fold(text, |text, (from, to)| text.replace(from, to)))
}

/// The rows of all tables of a page, cell by cell.
fn rows(page: &str) -> Vec<Vec<String>> {
    let cells = |row: &str| {
        let row = row.split("</tr>").next().unwrap();
        let cells =
            row.split("<t").skip(1).filter(|cell| cell.starts_with(['d', 'h']) && !cell.starts_with("head"));
        cells.map(|cell| untagged(&format!("<t{cell}"))).collect()
    };
    // What explains a row may be a row of its own below it.
    page.replace("</tr><tr class=\"detail\">", "").split("<tr").skip(1).map(cells).collect()
}

/// Every row of a table that a terminal shows is a row of the page.
fn terminal_says_what_the_page_says(said: &str, page: &[Vec<String>]) -> usize {
    let is_row = |line: &&str| {
        line.starts_with("  ") && !line.trim().starts_with("spunlaid ") && line.trim().contains("  ")
    };
    let lines = said.lines().filter(is_row);
    let cells =
        |line: &str| line.trim().split("  ").map(plain).filter(|cell| !cell.is_empty()).collect::<Vec<_>>();
    let mut count = 0;
    for reported in lines.map(cells) {
        // What explains a row stands beside it on a terminal, and below its name on the page.
        let is_on = |row: &Vec<String>| {
            let all = row.join(" ");
            reported.iter().all(|cell| all.contains(cell.trim_matches(['(', ')'])))
        };
        assert!(
            page.iter().any(is_on),
            "not on the page: {reported:?}\n{:?}",
            page.iter()
                .filter(|row| row.iter().any(|cell| cell.starts_with(&reported[0])))
                .collect::<Vec<_>>()
        );
        count += 1;
    }
    count
}

/// The numbers that stand beside each other: those of each object of a file, and of each row of a table.
fn beside_each_other(json: &Value, into: &mut Vec<Vec<f64>>) {
    let parts: Vec<&Value> = match json {
        Value::Array(parts) => parts.iter().collect(),
        Value::Object(parts) => parts.values().collect(),
        _ => return,
    };
    into.push(parts.iter().filter_map(|part| part.as_f64()).collect());
    parts.into_iter().for_each(|part| beside_each_other(part, into));
}

/// Factors from SI units to those that are shown: %, mm, µm, 1/cm², dtex, and so on.
const FACTORS: [f64; 12] = [1.0, 1e2, 1e3, 1e6, 1e-3, 1e-4, 1e-6, 1e-9, 1e9, 1e7, 1e4, 6e4];

/// The value and the error in front of and behind each ± of a text.
fn values_with_errors(text: &str) -> Vec<[String; 2]> {
    let parts: Vec<&str> = text.split(" ± ").collect();
    let ends = parts.windows(2).map(|beside| {
        let value = beside[0].rsplit(' ').next().unwrap();
        let error = beside[1].split(' ').next().unwrap();
        [value, error].map(|number| number.trim_matches(['(', ')', ',', ';', '%', '+']).to_owned())
    });
    // Those with powers of ten are left out.
    ends.filter(|[_, error]| !error.is_empty()).filter(|_| !text.contains('×')).collect()
}

/// Every value with an error on the page is one of the numbers of its files.
fn page_says_what_the_files_say(page: &[Vec<String>], numbers: &[Vec<f64>]) -> usize {
    let reported: BTreeSet<_> = page.iter().flatten().flat_map(|cell| values_with_errors(cell)).collect();
    for [value, error] in &reported {
        let [v, e] = [value, error].map(|text| text.replace('−', "-").parse::<f64>().unwrap());
        let text = format!("{value} ± {error}");
        let is_it = |(number, own): (f64, f64)| {
            FACTORS.iter().any(|factor| {
                let (number, own) = (number * factor, own * factor);
                (own / e - 1.0).abs() < 0.06
                    && (number.abs() - v.abs()).abs() <= e
                    && plain(&plus_minus(number.copysign(v), Some(own))).trim_start_matches('+') == text
            })
        };
        let pairs = |row: &Vec<f64>| row.iter().any(|number| row.iter().any(|own| is_it((*number, *own))));
        assert!(numbers.iter().any(pairs), "not in the files: {text}");
    }
    reported.len()
}

/// Terminal, page and files of a command, and how many rows and numbers with errors there are at least.
fn assert_numbers_agree(desk: &Desk, command: &str, folder: &str, least: [usize; 2]) {
    let said = success(&mut desk.spunlaid(&format!("{command} --out {folder}")));
    let page = rows(&String::from_utf8(desk.read(&format!("{folder}/report.html"))).unwrap());
    let mut numbers = Vec::new();
    for name in desk.entries(folder) {
        let text = || String::from_utf8(desk.read(&format!("{folder}/{name}"))).unwrap();
        if name.ends_with(".json") {
            beside_each_other(&serde_json::from_str(&text()).unwrap(), &mut numbers);
        } else if name == "results.csv" {
            let numbers_of = |line: &str| line.split(',').filter_map(|cell| cell.parse().ok()).collect();
            numbers.extend(text().lines().skip(1).map(numbers_of));
        }
    }
    let errors = if least[1] > 0 { page_says_what_the_files_say(&page, &numbers) } else { 0 };
    let found = [terminal_says_what_the_page_says(&said, &page), errors];
    assert!(found[0] >= least[0] && found[1] >= least[1], "{command}: {found:?}");
}

#[test]
#[ignore = "slow: the results of every command"]
fn identical_numbers_in_terminal_page_and_files_of_every_command() {
    let desk = scan::desk();
    fs::write(desk.path("fed.toml"), FED).unwrap();
    fs::write(desk.path("study.toml"), sweep::STUDY.replace("case.toml", "brief.toml")).unwrap();
    let spinline = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/melt_spinning.toml");
    let record = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/records/probe.csv");
    for (command, folder, least) in [
        ("run brief.toml --set run.replicates=4", "r", [10, 10]),
        ("run brief.toml --set run.replicates=4 --set air.density=1.5kg/m³", "other", [10, 10]),
        ("run fed.toml", "fed", [10, 10]),
        (&format!("spin {spinline}"), "s", [10, 0]),
        (&format!("analyse {record}"), "record", [20, 0]),
        ("web web.toml --no-advice", "w", [10, 10]),
        ("analyse w/map.png", "scan", [5, 5]),
        ("compare r other", "runs", [10, 10]),
        ("compare w scan", "webs", [5, 5]),
        ("sweep study.toml", "study", [6, 10]),
    ] {
        assert_numbers_agree(&desk, command, folder, least);
    }
    let case = FED.replace("speed = \"3 m/s\"", "speed = \"10 m/s\"");
    fs::write(desk.path("fed.toml"), case.replace("duration", "spin_up = \"10 ms\"\nduration")).unwrap();
    let web = "[laydown]\ncase = 'fed.toml'\n[line]\nfilaments_per_metre = 2000\n[web]\nwidth = '0.4 m'\nlength = \
        '0.15 m'\npatches = ['5 mm', '10 mm', '20 mm']\nsimulated = 250\n";
    fs::write(desk.path("few.toml"), web).unwrap();
    assert_numbers_agree(&desk, "web few.toml --advice", "few", [15, 10]);
    let line = sources::desk();
    assert_numbers_agree(&line, "air line.toml --sources", "sources", [5, 5]);
    let fitted = fit::desk();
    assert_numbers_agree(&fitted, "analyse truth/map.png", "scan", [5, 5]);
    let fit = "fit web.toml --to scan --vary line.filaments_per_metre --webs 10";
    // The file has the scatter of a web as a share.
    assert_numbers_agree(&fitted, fit, "fit", [1, 0]);
}
