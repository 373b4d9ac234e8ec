//! Settings of the machine that change how even a web is, and webs in which one of them is changed.

use crate::ground::Setting;
use crate::simulation::WebSpec;

const fn named(name: &'static str, words: &'static str) -> Setting {
    Setting { name, words }
}

/// Mass that each hole gives per time. Of known filaments the titre stays, and those of a spinline become
/// coarser with it.
pub const THROUGHPUT: Setting = named("throughput", "throughput of a hole");
/// Number of holes.
pub const HOLES: Setting = named("holes", "holes");
/// Mass per length of the filaments. The throughput of a hole stays, so the filaments come slower if they
/// are coarser.
pub const TITRE: Setting = named("titre", "titre");
/// Way from the inlet to the belt.
pub const DISTANCE: Setting = named("distance", "distance to the belt");
/// Speed of the air between inlet and belt.
pub const AIR_SPEED: Setting = named("air_speed", "air speed");
/// How strongly this air fluctuates.
pub const TURBULENCE: Setting = named("turbulence", "turbulence");
/// Speed of the air that draws the filaments of a spinline.
pub const DRAWING_AIR: Setting = named("drawing_air", "speed of the drawing air");
/// Temperature of the die.
pub const DIE_TEMPERATURE: Setting = named("die_temperature", "die temperature");
/// Size of the slot in machine direction.
pub const DEPTH: Setting = named("depth", "depth of the slot");
/// Places of the rows in machine direction.
pub const ROW_PLACES: Setting = named("row_places", "distance of the rows");
/// Charge per mass that the filaments carry.
pub const CHARGE: Setting = named("charge", "charge of the filaments");
/// None of the machine: a number that is a guess, and may be another one than is written.
pub const GUESS: Setting = named("guess", "guessed number");

/// A changed web; of the same basis weight, unless what changes is a guess.
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
