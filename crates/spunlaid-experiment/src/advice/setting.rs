//! Settings of the machine that change how even a web is, webs in which one of them is changed, and what these are
//! judged by: the CV over patches of some size, which is that of what a buyer sees.

use spunlaid_ground::{Dimension, Error, Fault, Setting, Turned};
use spunlaid_simulation::WebSpec;

const fn running(name: &'static str, words: &'static str) -> Setting {
    Setting { name, words, turned: Turned::Running }
}

const fn stopped(name: &'static str, words: &'static str) -> Setting {
    Setting { name, words, turned: Turned::Stopped }
}

const fn rebuilt(name: &'static str, words: &'static str) -> Setting {
    Setting { name, words, turned: Turned::Rebuilt }
}

/// Mass that each hole gives per time. Of known filaments the titre stays, and those of a spinline become
/// coarser with it.
pub const THROUGHPUT: Setting = running("throughput", "throughput per hole");
/// Number of holes.
pub const HOLES: Setting = rebuilt("holes", "holes");
/// Mass per length of the filaments. The throughput of a hole stays, so the filaments come slower if they
/// are coarser.
pub const TITRE: Setting = running("titre", "titre");
/// Way from the inlet to the belt.
pub const DISTANCE: Setting = stopped("distance", "distance to the belt");
/// Speed of the air between inlet and belt.
pub const AIR_SPEED: Setting = running("air_speed", "air speed");
/// How strongly this air fluctuates.
pub const TURBULENCE: Setting = rebuilt("turbulence", "turbulence");
/// Speed of the air that draws the filaments of a spinline.
pub const DRAWING_AIR: Setting = running("drawing_air", "speed of the drawing air");
/// Temperature of the die.
pub const DIE_TEMPERATURE: Setting = running("die_temperature", "die temperature");
/// Velocity of the air that cools the filaments of a spinline.
pub const QUENCH: Setting = running("quench", "quench air");
/// Size of the slot in machine direction.
pub const DEPTH: Setting = stopped("slot_gap", "slot gap");
/// Places of the rows in machine direction.
pub const ROW_PLACES: Setting = rebuilt("row_places", "distance of the rows");
/// Charge per mass that the filaments carry.
pub const CHARGE: Setting = running("charge", "charge of the filaments");
/// Speed of the belt: the basis weight follows. No advice tries it.
pub const BELT_SPEED: Setting = running("belt_speed", "belt speed");
/// Mass of the web per area: the belt follows. No advice tries it.
pub const BASIS_WEIGHT: Setting = running("basis_weight", "basis weight");
/// None of the machine: a number that is an assumed value, and may be another one than is written.
pub const ASSUMED: Setting = rebuilt("assumed", "assumed value");

/// All settings of the machine that advice tries.
pub const SETTINGS: [Setting; 12] = [
    THROUGHPUT,
    HOLES,
    TITRE,
    DISTANCE,
    AIR_SPEED,
    TURBULENCE,
    DRAWING_AIR,
    DIE_TEMPERATURE,
    QUENCH,
    DEPTH,
    ROW_PLACES,
    CHARGE,
];

/// A setting of the line of a web, whose file may say which ones are turned while it runs (`web.turnable`).
pub fn on_line_of(web: &WebSpec, setting: Setting) -> Setting {
    let turned = match &web.turnable {
        Some(named) if named.iter().any(|name| name == setting.name) => Turned::Running,
        Some(_) => setting.turned.max(Turned::Stopped),
        None => setting.turned,
    };
    Setting { turned, ..setting }
}

/// A changed web; of the same basis weight, unless what changes is an assumed value.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangedWeb {
    /// The file of the web.
    pub file: String,
    /// Keys and values with which that file is the changed web. What was set before is among them.
    pub set: Vec<(String, String)>,
    /// The web.
    pub spec: WebSpec,
    /// Speed of the belt before and after [m/s].
    pub belt_speed: [f64; 2],
    /// Mass that is laid per time and width before and after [kg/(m s)].
    pub mass_flow: [f64; 2],
}

/// Something that follows the CV over patches of its size.
#[derive(Debug)]
pub(crate) struct Aim {
    /// As it is asked for.
    pub name: &'static str,
    /// Side of its patches [m].
    side: fn(&WebSpec) -> f64,
}

/// All of them. How many thin spots there are follows from the CV over patches of their size, and the weakest
/// section of a strip from that over patches of the area of a section.                 theory.md (103), (104)
pub(crate) const AIMS: [Aim; 2] = [
    Aim { name: "thin-places", side: |_| 10e-3 },
    Aim { name: "strips", side: |web| (web.fabric.strip.width * web.fabric.strip.section).sqrt() },
];

/// The side of the patches by whose CV a web is judged [m].
///
/// * `text` – a length, or the name of one of `AIMS`, for which the nearest of the patches of the web is taken
///
/// # Errors
/// If it is neither, or if the web is not looked at over such patches.
pub fn judged_by(spec: &WebSpec, text: &str) -> Result<f64, Error> {
    let patches = &spec.sheet.patches;
    if let Some(aim) = AIMS.iter().find(|aim| aim.name == text) {
        let distance = |patch: &f64| (patch / (aim.side)(spec)).ln().abs();
        let nearest = patches.iter().copied().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        return nearest.ok_or_else(|| {
            Fault::new("the web is evaluated over no patches", "name some in web.patches").into()
        });
    }
    let names = || AIMS.map(|aim| aim.name).join(", ");
    let side = Dimension::Length.parse(text).ok().filter(|side| *side > 0.0).ok_or_else(|| {
        let remedy = format!("write the side of patches, like 10mm, or one of {}", names());
        Fault::new(format!("{text} is not what a web can be judged by"), remedy)
    })?;
    check_patch(spec, side)?;
    Ok(side)
}

/// Checks that the CV of a web is known over patches of a side [m], so that changes can be judged by it.
fn check_patch(spec: &WebSpec, side: f64) -> Result<(), Error> {
    if spec.sheet.patches.iter().any(|patch| super::is_same(*patch, side)) {
        return Ok(());
    }
    let pretty = |patch: &f64| Dimension::Length.pretty_to(*patch, 3);
    let known: Vec<String> = spec.sheet.patches.iter().map(pretty).collect();
    let what = format!("the web is evaluated over patches of {}, not of {}", known.join(", "), pretty(&side));
    Err(Fault::new(what, "name one of these, or write the size to web.patches").into())
}
