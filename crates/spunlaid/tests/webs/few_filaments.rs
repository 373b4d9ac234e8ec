//! How many filaments of a web in shared turbulence are simulated for all of them.

use spunlaid_ground::threads::look_while;
use spunlaid_ground::{Error, Isa, Log, RunContext};
use spunlaid_input::read_web;
use spunlaid_simulation::{Flights, Flyer, WebSpec};
use spunlaid_web::map::{Findings, PatchFindings};
use spunlaid_web::{SubsampleEstimate, SubsampleWarning};
use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

/// A row on so short a way that neighbours hardly know of each other.
const WEB: &str = "
version = 1
[fibre]
diameter = \"18 µm\"
density = \"910 kg/m³\"
youngs_modulus = \"2 GPa\"
element_length = \"3 mm\"
root = \"clamped\"
[feed]
speed = \"50 m/s\"
[belt]
distance = \"30 mm\"
speed = \"3 m/s\"
[air]
velocity = \"45 m/s\"
turbulence_intensity = 0.1
length_scale = \"16 mm\"
cutoff_frequency = \"700 Hz\"
[drag]
across = \"marheineke-wegener\"
[run]
duration = \"40 ms\"
replicates = 3
[line]
rows = [{ pitch = \"0.16 mm\", filaments = 1000 }]
[web]
width = \"160 mm\"
length = \"20 mm\"
cell = \"1 mm\"
";

/// What the filaments say that are simulated for all.
fn estimate(simulated: &str) -> SubsampleEstimate {
    found(&format!("{WEB}simulated = {simulated}\n")).laid.simulated[0].few.clone().unwrap()
}

fn found(text: &str) -> Findings {
    let spec: WebSpec = read_web((text, "web.toml"), &[]).unwrap_or_else(|_| panic!("it is read")).spec;
    let (laid, stop) = (AtomicU64::new(0), AtomicBool::new(false));
    let by = RunContext { threads: 2, isa: Isa::detect(), stop: &stop, done: &laid };
    let mut web = Flyer::new(2, &stop, &|_, work| work()).web(&spec).unwrap();
    web.find(by).unwrap()
}

/// Eight filaments in a length scale of 16 mm do not give what those between them do, so that twice and then
/// four times as many are simulated, as a number would say; a number is simulated as it is.
#[test]
#[ignore = "slow: three webs of up to 320 filaments"]
fn identical_the_usual_web_flies_four_times_as_many_where_the_first_do_not_tell() {
    let [usual, fine, first] = ["\"auto\"", "2000", "500"].map(estimate);
    assert_eq!([&usual, &first].map(|few| few.filaments + few.lost), [320, 80]);
    assert!(matches!(first.warning(), Some(SubsampleWarning::Neighbours(_))), "{:?}", first.correlation);
    assert_eq!(format!("{usual:?}"), format!("{fine:?}"));
    assert!((usual.pitch - 0.5e-3).abs() < 1e-12 && (first.pitch - 2e-3).abs() < 1e-12);
}

/// The clouds of the map had errors where the CV had none, and twice the variance of those of all filaments.
#[test]
fn clouds_of_too_few_filaments_have_no_error() {
    let findings = found(&format!("{WEB}simulated = 500\n"));
    assert!(findings.patches.iter().all(|patch| patch.warning.is_some()));
    let clouds = findings.clouds.unwrap();
    let errors = clouds.octaves().into_iter().filter_map(|(_, variance)| variance.standard_error);
    assert_eq!(errors.collect::<Vec<_>>(), [0.0; 0]);
}

/// Its row in other words, on a longer way and a longer sheet.
fn line(line: &str, web: &str) -> String {
    let (before, after) = WEB.split_once("[line]").unwrap();
    let web = format!("{line}\n[web]\nwidth = \"160 mm\"\ncell = \"1 mm\"\nsimulated = 500\n{web}");
    assert!(after.contains("[web]"));
    before.replace("30 mm", "60 mm") + &web
}

const DEFECT: &str = "[line]\nrows = [{ pitch = \"0.16 mm\", filaments = 1000 }]\n\
    defects = [{ from = \"60 mm\", to = \"72 mm\" }]";

/// The few were taken to be as uniform as filaments at any random places, without defects, and in layers that have
/// nothing in common: up to two fifths off, and a note said that the map was wrong.
#[test]
fn identical_the_cv_of_few_is_that_of_their_map_with_its_places_defects_and_layers() {
    let layers = "[[layer]]\n[layer.line]\nrows = [{ pitch = \"0.16 mm\", filaments = 1000 }]\n[[layer]]\n\
        [layer.line]\nrows = [{ pitch = \"0.16 mm\", filaments = 1000 }]";
    for line in ["[line]\nfilaments_per_metre = 2000", DEFECT, layers]
        .map(|words| line(words, "length = \"60 mm\"\npatches = [\"5 mm\", \"10 mm\", \"20 mm\"]\n"))
    {
        let patches = found(&line).patches;
        assert_eq!(patches.len(), 3);
        for patch in patches {
            let few = patch.few.unwrap();
            println!("{:.4} {:.4} {:.4}", few.patch, few.cv, patch.of_map);
            assert!((few.cv / patch.of_map - 1.0).abs() < 0.03, "{few:?} {}", patch.of_map);
        }
    }
}

/// On a sheet of pieces a defect changes the reported CV² as it changes that of the map, which has the same pieces.
#[test]
fn identical_a_defect_is_in_the_cv_of_a_sheet_of_pieces() {
    let [with, without] = [DEFECT, DEFECT.split_once("\ndefects").unwrap().0].map(|words| {
        let sheet = "length = \"1.7 m\"\npatches = [\"10 mm\", \"20 mm\"]\n";
        found(&line(words, sheet).replace("3 m/s", "10 m/s").replace("= 500", "= 100")).patches
    });
    for (with, without) in with.iter().zip(&without) {
        let [reported, map] =
            [|patch: &PatchFindings| patch.few.unwrap().cv, |patch: &PatchFindings| patch.of_map]
                .map(|cv: fn(&PatchFindings) -> f64| cv(with).powi(2) - cv(without).powi(2));
        // Quanta are rounded.
        assert!(
            (reported / map - 1.0).abs() < 1e-3 && map > 0.05 * without.of_map.powi(2),
            "{reported} {map}"
        );
    }
}

/// A web of 0.016 m², whose coarse sheets are ten times as large.
fn of_two_levels(error: &str) -> WebSpec {
    let text = WEB.replace("\"30 mm\"", "\"100 mm\"").replace("length = \"20 mm\"", "length = \"100 mm\"");
    read_web((format!("{text}error = {error}\n").as_str(), "web.toml"), &[]).unwrap().spec
}

/// Simulates a web.
///
/// * `kept` – where sheets are kept
/// * `watch` – is called before each simulation, with the number of its filaments
fn few_of(
    spec: &WebSpec,
    threads: usize,
    kept: Option<&Log>,
    watch: &dyn Fn(u64),
) -> Result<SubsampleEstimate, Error> {
    let (laid, stop) = (AtomicU64::new(0), AtomicBool::new(false));
    let by = RunContext { threads, isa: Isa::detect(), stop: &stop, done: &laid };
    let follow = |flights: Flights<'_>, work: &mut (dyn FnMut() + Send)| {
        watch(flights.fibres);
        work();
    };
    let mut web = Flyer::new(threads, &stop, &follow).keeping(kept).web(spec)?;
    Ok(web.find(by)?.laid.simulated[0].few.clone().unwrap())
}

/// What the filaments of a web say, in words, and how many of them are simulated.
fn estimate_and_fibres(spec: &WebSpec, threads: usize, kept: Option<&Log>) -> (String, u64) {
    let fibres = AtomicU64::new(0);
    let count = |count| {
        fibres.fetch_add(count, Ordering::Relaxed);
    };
    let few = few_of(spec, threads, kept, &count).unwrap();
    (format!("{few:?}"), fibres.into_inner())
}

const SMALL_ERROR: &str = "0.06";

/// A web of several coarse sheets, simulated at once on one thread.
static OF_SMALL_ERROR: LazyLock<(String, u64)> =
    LazyLock::new(|| estimate_and_fibres(&of_two_levels(SMALL_ERROR), 1, None));

/// A web of which little is wanted to be known takes one coarse sheet; the bits are the same on any number of threads.
#[test]
#[ignore = "slow: three webs of two levels"]
fn identical_two_levels_on_any_number_of_threads() {
    let of = |error: &str, threads: usize| few_of(&of_two_levels(error), threads, None, &|_| ()).unwrap();
    let [alone, one, two] =
        [("\"none\"", 1), ("0.2", 1), ("0.2", 2)].map(|(error, threads)| of(error, threads));
    assert_eq!(format!("{one:?}"), format!("{two:?}"));
    assert!(one.is_of_two_levels() && !alone.is_of_two_levels(), "{one:?}");
    // Over ten times the area the clouds leave a third of the error open.
    let error = |few: &SubsampleEstimate| {
        let cv = few.cvs.iter().find(|cv| cv.patch == 0.01).unwrap();
        cv.by_chance.map(|error| error / cv.cv)
    };
    println!("{:?} {:?} {}", error(&alone), error(&one), one.area);
    assert!(one.area > 10.0 * alone.area && error(&one).unwrap() < 0.2, "{one:?}");
}

/// What was simulated for a large error is not simulated again for a smaller one, whose bits are those without it; and
/// what is kept of another web is not taken.
#[test]
#[ignore = "slow: six webs of two levels"]
fn identical_a_smaller_error_goes_on_from_the_kept_sheets_of_a_larger_one() {
    let large = of_two_levels("0.2");
    let (whole, of_whole) = &*OF_SMALL_ERROR;
    let kept = [Log::in_memory(), Log::in_memory()];
    let (first, of_first) = estimate_and_fibres(&large, 1, Some(&kept[0]));
    let of_large = kept[0].keys();
    for (key, piece) in of_large.iter().flat_map(|key| kept[0].pieces(*key).map(move |piece| (*key, piece))) {
        kept[1].append(key, piece.unwrap()).unwrap();
    }
    let small = of_two_levels(SMALL_ERROR);
    for (threads, kept) in (1..).zip(&kept) {
        let (continued, of_rest) = estimate_and_fibres(&small, threads, Some(kept));
        assert_eq!(continued, *whole);
        // Only the fine sheet, from which the map is made, is simulated twice.
        let (_, of_fine) = estimate_and_fibres(&small, threads, Some(kept));
        println!("{of_whole} {of_first} {of_rest} {of_fine}");
        assert_eq!(of_first + of_rest, of_whole + of_fine);
        assert!(of_fine < of_rest && of_rest < *of_whole, "{of_fine} {of_rest} {of_whole}");
    }
    let [kept, _] = kept;
    let all = kept.keys().len();
    let other = WebSpec { seed: large.seed + 1, ..large };
    assert_ne!(estimate_and_fibres(&other, 2, Some(&kept)).0, first);
    assert_eq!(kept.keys().len(), all + of_large.len());
}

/// A command that is stopped after a sheet has kept it.
#[test]
#[ignore = "slow: three webs of two levels"]
fn identical_an_interrupted_web_goes_on_from_its_sheets() {
    let spec = of_two_levels(SMALL_ERROR);
    let (kept, stop) = (Log::in_memory(), AtomicBool::new(false));
    let follow = |_: Flights<'_>, work: &mut (dyn FnMut() + Send)| {
        let look = || {
            stop.fetch_or(kept.keys().len() > 1, Ordering::Relaxed);
        };
        look_while(Duration::from_millis(1), look, work);
    };
    let stopped = Flyer::new(1, &stop, &follow).keeping(Some(&kept)).web(&spec);
    assert!(matches!(stopped, Err(Error::Interrupted)));
    let before = kept.keys().len();
    assert!(before >= 2);
    let continued = few_of(&spec, 2, Some(&kept), &|_| ()).unwrap();
    assert_eq!(format!("{continued:?}"), OF_SMALL_ERROR.0);
    assert!(kept.keys().iter().all(|key| kept.pieces(*key).count() == 1) && kept.keys().len() > before);
}
