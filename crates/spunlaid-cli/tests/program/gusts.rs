//! `spunlaid air`: the turbulent air of a case, looked at.

use crate::desk::{Desk, entries, names, success};
use spunlaid_air::AirAtPlaces;
use spunlaid_ground::Vec3;
use spunlaid_input::read_case;

/// Small and quick to make.
const SMALL: [&str; 3] = ["air.lateral=von-karman", "air.lateral_cutoff=5", "run.duration=20 ms"];
const FRAMES: usize = 4;

/// The numbers of the two blocks behind the text of a VTK file: velocities and points, each x, y, z.
fn blocks(file: &[u8]) -> [Vec<[f32; 3]>; 2] {
    let start = file.windows(2).position(|two| two == b"\n_").unwrap() + 2;
    let mut rest = &file[start..];
    [(); 2].map(|()| {
        let (length, after) = rest.split_first_chunk().unwrap();
        let (block, after) = after.split_at(usize::try_from(u64::from_le_bytes(*length)).unwrap());
        rest = after;
        let numbers: Vec<f32> = block.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
        numbers.as_chunks().0.to_vec()
    })
}

#[test]
fn slices_are_the_air_of_the_replicate() {
    let desk = Desk::new();
    let arguments = format!("air brief.toml --frames {FRAMES} --duration 40ms --replicate 3 --out a");
    let said = success(&mut desk.with(&arguments, &SMALL));
    assert!(said.contains("Turbulence of") && said.contains("open a/report.html"), "{said}");
    // The same numbers without a folder.
    let json = success(&mut desk.with(&arguments.replace("--out a", "--json"), &SMALL));
    assert!(
        json == String::from_utf8(desk.read("a/summary.json")).unwrap() && !desk.path("results").exists()
    );
    let all = "across.pvd along.pvd case.toml figures origin.toml report.html slices summary.json";
    assert_eq!(desk.entries("a"), names(&all.split(' ').collect::<Vec<_>>()));
    let set = SMALL.map(|change| change.split_once('=').map(|(a, b)| (a.to_owned(), b.to_owned())).unwrap());
    let (case, _) = read_case(&desk.path("brief.toml"), &set).unwrap();
    let mut air: AirAtPlaces = case.air_at_places(2, 1).unwrap();
    for (plane, across) in [("along", false), ("across", true)] {
        for (number, time) in [0.0, 40e-3 / 3.0, 80e-3 / 3.0, 40e-3].into_iter().enumerate() {
            let [velocities, points] = blocks(&desk.read(&format!("a/slices/{plane}_{number}.vts")));
            assert_eq!(velocities.len(), points.len());
            assert!(points.iter().all(|[x, _, z]| if across {
                *x == points[0][0] && *x > 0.0
            } else {
                *z == 0.0
            }));
            let places: Vec<Vec3<f64>> = points
                .iter()
                .map(|[x, y, z]| Vec3::new(f64::from(*x), f64::from(*y), f64::from(*z)))
                .collect();
            for (found, expected) in velocities.iter().zip(air.velocities(time, &places).unwrap()) {
                let off = [expected.x, expected.y, expected.z].map(|x| x as f32);
                // The places were rounded.
                assert!(found.iter().zip(off).all(|(a, b)| (a - b).abs() < 1e-3), "{found:?} {expected:?}");
            }
        }
        let collection = String::from_utf8(desk.read(&format!("a/{plane}.pvd"))).unwrap();
        assert_eq!(collection.matches("<DataSet").count(), FRAMES);
    }
    let summary = desk.summary("a");
    assert_eq!(summary["replicate"], 3);
    let rms = summary["planes"]["along"]["expected_rms_m_s"].as_f64().unwrap();
    assert!((rms - 1.0).abs() < 1e-9, "a tenth of 10 m/s: {rms}");
    // The resolved case gives the same air, by any number of threads.
    success(&mut desk.spunlaid(&format!(
        "air a/case.toml --frames {FRAMES} --duration 40ms --replicate 3 --out b --threads 1 -q"
    )));
    for name in entries(&desk.path("a/slices")) {
        assert!(desk.read(&format!("a/slices/{name}")) == desk.read(&format!("b/slices/{name}")), "{name}");
    }
    assert!(desk.read("a/figures/along.svg") == desk.read("b/figures/along.svg"));
}

#[test]
fn air_that_is_the_same_across_is_shown_as_neighbours_share_it() {
    let desk = Desk::new();
    let mut command = desk.spunlaid("air brief.toml --frames 1 --out a --set air.length_scale=100mm");
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("air.lateral = \"uniform\""), "{said}");
    let page = String::from_utf8(desk.read("a/report.html")).unwrap();
    assert!(page.contains("as neighbours share it") && page.contains("Eddies across the end of the path"));
}
