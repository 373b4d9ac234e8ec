//! `spunlaid web`: what it refuses, and how.
#![allow(clippy::unwrap_used)]

mod desk;

use desk::{Desk, FED, refusal};
use std::fs;

const WEB: &str = "[laydown]\ncase = \"brief.toml\"\n[line]\nfilaments_per_metre = 500\n[web]\nwidth = \"1 m\"\nlength = \"1 m\"\n";

fn desk() -> Desk {
    // So long elements show too little of the autocorrelation to see a surrogate in it.
    let desk = Desk::of(&FED.replace("element_length = \"4 mm\"", "element_length = \"25 mm\""));
    fs::write(desk.path("web.toml"), WEB).unwrap();
    desk
}

#[test]
fn rejects_bad_webs_with_the_command_that_helps() {
    let desk = desk();
    for (arguments, message) in [
        (
            "web nowhere.toml",
            "error: nowhere.toml: there is no such file; name the file of a web (`spunlaid help web` shows one)\n",
        ),
        ("web brief.toml", "case = \"spunbond.toml\" (`spunlaid run`)\n"),
        ("run web.toml", "belongs to the file of a web, not to a case; read it as a web (`spunlaid web`)\n"),
        (
            "web web.toml --set line.belt_speed=6m/s",
            "error: --set line.belt_speed = \"6m/s\" differs from belt.speed = 3 m/s of brief.toml",
        ),
        ("web web.toml --set web.width", "write a key and a value"),
        ("web web.toml --threads 0", "--threads"),
    ] {
        let said = refusal(&mut desk.spunlaid(arguments), 1);
        assert!(said.contains(message), "{arguments}: {said}");
    }
    // Nothing is left behind.
    assert_eq!(desk.entries("."), desk::names(&["brief.toml", "web.toml"]));
}

#[test]
fn rejects_a_flight_in_which_no_surrogate_is_found() {
    let desk = desk();
    let said = refusal(&mut desk.spunlaid("web web.toml --out w"), 1);
    let error = "\nerror: brief.toml: no surrogate was identified in what its fibres lay: the autocorrelation of the position";
    assert!(said.contains(error), "{said}");
    assert_eq!(desk.entries("."), desk::names(&["brief.toml", "web.toml"]));
}
