//! `spunlaid keys` and the page it makes.

use crate::desk::{Desk, success};
use std::path::Path;

#[test]
fn the_page_of_keys_is_up_to_date() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/keys.md");
    let written = std::fs::read_to_string(path).unwrap_or_default();
    let made = success(&mut Desk::new().spunlaid("keys --markdown"));
    assert!(
        made == written,
        "docs/keys.md is out of date; renew it: cargo run --release -- keys --markdown > docs/keys.md"
    );
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/web_keys.md");
    let of_webs = success(&mut Desk::new().spunlaid("keys --web --markdown"));
    assert!(
        of_webs == std::fs::read_to_string(path).unwrap_or_default(),
        "docs/web_keys.md is out of date; renew it: cargo run --release -- keys --web --markdown > docs/web_keys.md"
    );
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/study_keys.md");
    let of_studies = success(&mut Desk::new().spunlaid("keys --study --markdown"));
    assert!(
        of_studies == std::fs::read_to_string(path).unwrap_or_default(),
        "docs/study_keys.md is out of date; renew it: cargo run --release -- keys --study --markdown > \
        docs/study_keys.md"
    );
    assert!(
        of_webs.contains("| `rows.pitch` | 1 µm to 1 m |")
            && of_webs.contains("| a length | m, cm, mm, µm or nm |"),
        "{of_webs}"
    );
    for key in ["field_root", "field_axis", "field_unit", "spin_up", "error_tolerance"] {
        assert!(written.contains(&format!("| `{key}`")), "{key}");
    }
}

#[test]
fn keys_are_explained_by_a_word_in_their_name_or_meaning() {
    let desk = Desk::new();
    let one = success(&mut desk.spunlaid("keys run.spin_up"));
    assert!(
        one.starts_with("run.spin_up\n    Time at the start that the statistics of the motion leave out;"),
        "{one}"
    );
    assert!(
        one.contains("    takes      a time, zero or above; in s, ms, µs, ns, min or h; usually 1 ns to"),
        "{one}"
    );
    assert!(one.contains("    default    0 s\n"), "{one}");
    let by_meaning = success(&mut desk.spunlaid("keys SPINNERET"));
    assert!(by_meaning.starts_with("spinline.hole_diameter\n") && by_meaning.contains("\nair.field_root\n"));
    assert_eq!(by_meaning.matches("takes").count(), 2, "{by_meaning}");
    let all = success(&mut desk.spunlaid("keys"));
    assert!(all.matches("\n    takes").count() > 35 && all.lines().all(|line| line.chars().count() <= 100));
}

/// Those who buy fabric find a key, or what there is in place of one.
#[test]
fn words_of_buyers_are_answered() {
    let desk = Desk::new();
    for word in [
        "tensile",
        "caliper",
        "thickness",
        "permeability",
        "porosity",
        "opacity",
        "formation",
        "cloudiness",
        "pinholes",
        "\"thin spot\"",
        "hydrohead",
        "trim",
        "saleable",
        "softness",
    ] {
        let output =
            success(&mut desk.spunlaid(&format!("keys {}", word.replace('"', "").replace(' ', "-"))));
        assert!(
            output.contains("fabric") && output.lines().all(|line| line.chars().count() <= 100),
            "{output}"
        );
    }
}
