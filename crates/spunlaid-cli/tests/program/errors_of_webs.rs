//! The reported errors of a web, against the scatter of webs that differ by their seed.

#[allow(dead_code)]
#[path = "../../examples/web_errors/draw.rs"]
mod draw;
#[allow(dead_code)]
#[path = "../../examples/prove/numbers.rs"]
mod numbers;
#[allow(dead_code)]
#[path = "../../examples/web_errors/scatter.rs"]
mod scatter;
#[path = "../../examples/web_errors/webs.rs"]
mod webs;

use draw::{Family, line};
use numbers::Numbers;
use scatter::{BOUNDS, scatter};
use spunlaid_ground::threads::par_map;
use spunlaid_input::read_web;

/// All numbers of `summary.json` that have an error. Sampling moves the scatter of twelve webs by as much as a
/// chi-square distribution says: three and a half standard deviations of it are allowed beyond the bounds of the bench.
#[test]
fn stat_every_error_of_a_web_is_as_large_as_its_number_scatters() {
    let web = line(Family::Known, 1, 6);
    let webs: Vec<Numbers> = par_map(2, 12, |seed| webs::numbers_of(&web, 1 + seed as u64, "auto").unwrap());
    let found = scatter(6, &webs);
    assert!(found.len() > 50, "{}", found.len());
    let wrong = found.iter().filter(|(_, found)| {
        let [low, high] = found.by_chance(3.5);
        !(BOUNDS[0] * low..BOUNDS[1] * high).contains(&found.ratio)
    });
    let wrong: Vec<String> = wrong.map(|(name, of)| format!("{name} {}: {:.2}", of.of, of.ratio)).collect();
    assert!(wrong.is_empty(), "scatter over error: {}", wrong.join(", "));
}

/// Where filaments are filled in between the simulated ones, the variance of the clouds may be off beyond what two
/// fillings differ by: over patches of the same size the simulated ones say so without them. Against all filaments
/// in the same air.
#[test]
#[ignore = "slow: a web of all filaments"]
fn stat_the_errors_of_clouds_of_few_filaments_hold_those_of_all() {
    let text = include_str!("../../examples/prove/simulated.toml").replace("simulated = 800\n", "");
    let web = read_web((&*text, "web.toml"), &[][..]).unwrap();
    let [few, all] = ["800", "all"].map(|simulated| webs::numbers_of(&web, 1, simulated).unwrap());
    let clouds: Vec<_> = few.iter().filter(|(name, _)| name.0 == "web.clouds.variance").collect();
    assert!(clouds.len() > 3);
    for (name, few) in clouds {
        let off = (few.value - all[name].value) / few.error.hypot(all[name].error);
        assert!(off.abs() < 3.0, "{name:?}: {few:?} against {:?}", all[name]);
    }
}

/// Of a heavy web with streaks its thin spots alone are bare: its bare area scattered by ten of the errors that were
/// reported. The other errors of the bare area are those that `release/prove` finds at its first draws.
#[test]
#[ignore = "slow: twelve webs"]
fn stat_the_bare_area_has_the_errors_of_its_clouds() {
    let text = include_str!("../../examples/prove/web.toml");
    let heavy = [("line.basis_weight", "107 g/m²"), ("laydown.sigma_cd", "946 µm")];
    let values = heavy.map(|(key, value)| (key.to_string(), value.to_string()));
    let web = read_web((text, "web.toml"), &values[..]).unwrap();
    let webs: Vec<Numbers> = par_map(2, 12, |seed| webs::numbers_of(&web, 1 + seed as u64, "auto").unwrap());
    let found = scatter(1, &webs);
    let (_, bare) = found.iter().find(|(name, _)| name == "fabric.bare_area").expect("a bare area");
    let [low, high] = bare.by_chance(3.5);
    assert!((BOUNDS[0] * low..BOUNDS[1] * high).contains(&bare.ratio), "{:.2}", bare.ratio);
}
