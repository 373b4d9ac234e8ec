//! The reported errors of a web, against the scatter of webs that differ by their seed.

#[allow(dead_code)]
#[path = "../../examples/web_errors/draw.rs"]
mod draw;
#[allow(dead_code)]
#[path = "../../examples/web_errors/numbers.rs"]
mod numbers;
#[path = "../../examples/web_errors/webs.rs"]
mod webs;

use draw::{Family, line};
use numbers::{BOUNDS, Numbers, scatter};
use spunlaid::ground::threads::each;

/// All numbers of `summary.json` that have an error. Sampling moves the scatter of twelve webs by as much as a
/// chi-square distribution says: three and a half standard deviations of it are allowed beyond the bounds of the bench.
#[test]
fn stat_every_error_of_a_web_is_as_large_as_its_number_scatters() {
    let web = line(Family::Known, 1, 6);
    let webs: Vec<Numbers> = each(2, 12, |seed| webs::numbers_of(&web, 1 + seed as u64, "auto").unwrap());
    let found = scatter(6, &webs);
    assert!(found.len() > 50, "{}", found.len());
    let wrong = found.iter().filter(|(_, found)| {
        let [low, high] = found.by_chance(3.5);
        !(BOUNDS[0] * low..BOUNDS[1] * high).contains(&found.ratio)
    });
    let wrong: Vec<String> = wrong.map(|(name, of)| format!("{name} {}: {:.2}", of.of, of.ratio)).collect();
    assert!(wrong.is_empty(), "scatter over error: {}", wrong.join(", "));
}
