//! The layers of a web: what is to be laid, as a file says it.
//!
//! ```text
//! WebSpec (sheet and layers) + the fibres of each layer, simulated or known → Web, which `web` lays
//! ```

mod charge;
mod fabric;
pub mod full_names;
pub mod keys;

use crate::ensemble::LineFilaments;
pub use full_names::{place_in_web, web_key};
pub use keys::{WEB, WEB_KEYS, WEB_TABLES, WebKey};
use spunlaid_fibre::{Case, FedFilament};
use spunlaid_ground::{Diagnostic, Dimension, Error, Fault};
use spunlaid_web::map::LayerFilaments;
use spunlaid_web::map::{Filaments, inlets};
use spunlaid_web::{Defect, Edges, FabricKeys, Fibres, Layer, Sheet, Surrogate, Titres, Web, Window};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Fewest standard deviations of a filament's place that a closed side of the web is long.
const LEAST_SPREADS: f64 = 8.0;

/// Relative difference up to which two numbers are the same.
pub const SAME: f64 = 1e-9;

/// A web before its fibres have been simulated.
#[derive(Clone, Debug, PartialEq)]
pub struct WebSpec {
    /// The sheet.
    pub sheet: Sheet,
    /// What lies on it.
    pub layers: Vec<LayerSpec>,
    /// Seed of all random numbers.
    pub seed: u64,
    /// How many filaments of a web in shared turbulence are simulated.
    pub simulated: Flown,
    /// The error that the CV of a web in shared turbulence may have.
    pub error: WantedError,
    /// Time after which no more sheets are begun for it [s]; None without a limit.
    pub time: Option<f64>,
    /// Side of the square in the middle of the sheet whose single fibres are written out [m].
    pub window: f64,
    /// Most memory that the air of a web in shared turbulence may take [B].
    pub memory_limit: f64,
    /// Speed of the belt, on which all layers lie [m/s].
    pub belt_speed: f64,
    /// Mass of all layers per area, if it is given in place of the speed of the belt, which follows from it [kg/m²].
    pub basis_weight: Option<f64>,
    /// What is given of the fabric and of its tests.
    pub fabric: FabricKeys,
    /// Keys of the web and of its cases whose numbers are assumed values, as the file names them.
    pub assumed: Vec<String>,
    /// Names of the settings that are turned while the line runs; the usual ones if none are named.
    pub turnable: Option<Vec<String>>,
}

/// How many filaments of a web in shared turbulence are simulated for all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flown {
    /// As many as the length scale of the air asks for.
    Auto,
    /// All of them.
    All,
    /// So many per metre of width.
    PerMetre(u64),
}

/// The standard error of the CV over the patches that the eye judges first which is wanted of a web in shared
/// turbulence, as a fraction of the CV.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WantedError {
    /// That of [`USUAL_ERROR`], and of a web so small that all of it is simulated the one of its own clouds.
    Auto,
    /// That of one sheet.
    OfOneSheet,
    /// This one.
    Of(f64),
}

/// The error that is wanted if nothing is said.
pub const USUAL_ERROR: f64 = 0.04;

/// A layer before its fibres have been simulated.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerSpec {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// A filament as it is given. A simulated one is that of its case: see [`Self::fed_filament`].
    pub filament: FedFilament,
    /// How the filaments lie, or what determines it.
    pub source: LaydownSource,
    /// Where the filaments come down.
    pub filaments: Filaments,
    /// Holes that feed more or less than the others.
    pub defects: Vec<Defect>,
    /// Charge per mass of the filaments, if they are charged [C/kg].
    pub charge: Option<f64>,
    /// Distance of grounded plates from the middle of the slot, if there are any [m].
    pub walls: Option<f64>,
}

/// What determines how a filament lies.
#[derive(Clone, Debug, PartialEq)]
pub enum LaydownSource {
    /// A case that is to be simulated.
    Case {
        /// Its file.
        path: PathBuf,
        /// What is in it.
        case: Arc<Case>,
    },
    /// Known numbers.
    Surrogate(Surrogate),
}

impl LaydownSource {
    /// Numbers of a surrogate that are not known yet.
    pub const UNKNOWN: Self =
        Self::Surrogate(Surrogate { sigma_md: f64::NAN, sigma_cd: f64::NAN, noise: f64::NAN });

    /// The case of the simulated fibres, if there is one.
    pub fn case(&self) -> Option<&Case> {
        match self {
            Self::Case { case, .. } => Some(case),
            Self::Surrogate(_) => None,
        }
    }

    /// The path of the case, for messages.
    pub fn path(&self) -> &Path {
        match self {
            Self::Case { path, .. } => path,
            Self::Surrogate(_) => Path::new(""),
        }
    }
}

impl LayerSpec {
    /// A layer whose keys are set one after another.
    pub fn unknown(source: LaydownSource) -> Self {
        Self {
            name: None,
            filament: FedFilament::UNKNOWN,
            source,
            filaments: Filaments::AtRandom { per_metre: f64::NAN },
            defects: Vec::new(),
            charge: None,
            walls: None,
        }
    }

    /// The filament with the numbers with which it is simulated, if it is.
    pub fn fed_filament(&self) -> FedFilament {
        self.source.case().map_or(self.filament, Case::filament)
    }

    /// Takes a case that is to be simulated, with the size and the speed of its filament.
    ///
    /// * `keeps_feed` – whether the layer says the throughput itself, which gives the speed of the case
    pub fn take_case(&mut self, path: PathBuf, case: Arc<Case>, keeps_feed: bool) {
        let feed = if keeps_feed { self.filament.feed } else { case.filament().feed };
        self.filament = FedFilament { feed, ..case.filament() };
        self.source = LaydownSource::Case { path, case };
    }

    /// Whether other webs have other streaks, by the places of its filaments or by their defects.
    pub(crate) fn has_random_streaks(&self) -> bool {
        self.filaments.are_at_random() || self.defects.iter().any(|defect| defect.share < 1.0)
    }

    /// The layer, once its fibres are known.
    ///
    /// * `belt_speed` – of the belt on which it lies [m/s]
    fn layer(&self, fibres: Fibres, belt_speed: f64) -> Layer {
        Layer {
            linear_density: self.fed_filament().linear_density(),
            feed_speed: self.fed_filament().feed_speed(),
            belt_speed,
            filaments: self.filaments.clone(),
            defects: self.defects.clone(),
            fibres,
        }
    }
}

impl WebSpec {
    /// A web without layers, whose keys are set one after another.
    pub const fn unknown() -> Self {
        let nan = f64::NAN;
        Self {
            sheet: Sheet::new(nan, nan, nan),
            layers: Vec::new(),
            seed: 0,
            simulated: Flown::Auto,
            error: WantedError::Auto,
            time: None,
            window: nan,
            memory_limit: nan,
            belt_speed: nan,
            basis_weight: None,
            fabric: FabricKeys::USUAL,
            assumed: Vec::new(),
            turnable: None,
        }
    }

    /// Whether its filaments are simulated: those of cases hang in shared turbulence and lay the web as they come
    /// down. Those of known numbers are independent paths of the surrogate.
    pub fn flies(&self) -> bool {
        self.cases().next().is_some()
    }

    /// The cases that it flies, in the order of its layers.
    pub fn cases(&self) -> impl Iterator<Item = &Case> {
        self.layers.iter().filter_map(|layer| layer.source.case())
    }

    /// What the defects of a layer make of its filaments.
    pub(crate) fn titres(&self, number: usize) -> Titres {
        let of = |layer: &LayerSpec| {
            let LayerSpec { filaments, defects, .. } = layer;
            let layer = LayerFilaments { sheet: &self.sheet, seed: self.seed, number, filaments };
            Titres::new(layer, defects, self.belt_speed)
        };
        self.layers.get(number).map(of).unwrap_or_default()
    }

    /// Mass of all filaments that is fed per time over the width of the sheet [kg/(m s)].
    pub fn mass_flow(&self) -> f64 {
        let flow =
            |layer: &LayerSpec| layer.fed_filament().throughput() * layer.filaments.count(&self.sheet) as f64;
        self.layers.iter().map(flow).sum::<f64>() / self.sheet.width
    }

    /// Length of a filament of a layer on the sheet [m].
    pub fn fed_length(&self, layer: &LayerSpec) -> f64 {
        self.sheet.length * layer.fed_filament().feed_speed() / self.belt_speed
    }

    /// Mass of all layers per area [kg/m²].
    pub fn weight(&self) -> f64 {
        self.mass_flow() / self.belt_speed
    }

    /// The speed of a belt on which all layers together have this mass per area [m/s].
    pub fn belt_speed_for(&self, basis_weight: f64) -> f64 {
        self.mass_flow() / basis_weight
    }

    /// Puts all layers on a belt of this speed, above which the cases are simulated.
    ///
    /// * `belt` – its speed [m/s]
    pub fn set_belt_speed(&mut self, belt: f64) {
        let has_changed = (self.belt_speed / belt - 1.0).abs() > SAME;
        self.belt_speed = belt;
        for layer in self.layers.iter_mut().filter(|_| has_changed) {
            if let LaydownSource::Case { case, .. } = &mut layer.source
                && let Some(line) = &mut Arc::make_mut(case).line
            {
                line.belt_speed = belt;
            }
        }
    }

    /// The web of one of its layers alone.
    pub fn alone(&self, layer: usize) -> Self {
        Self { layers: self.layers.get(layer).cloned().into_iter().collect(), ..self.clone() }
    }

    /// The square in the middle of the sheet whose single fibres are shown.
    pub fn window(&self) -> Window {
        let corner = [self.sheet.width, self.sheet.length].map(|size| 0.5 * (size - self.window));
        Window { corner, sides: [self.window; 2] }
    }

    /// The web, once the fibres of each layer are known, in their order.
    pub fn web(&self, fibres: impl IntoIterator<Item = Fibres>) -> Web {
        let layers = self
            .layers
            .iter()
            .zip(fibres)
            .map(|(layer, fibres)| layer.layer(fibres, self.belt_speed))
            .collect();
        Web { sheet: self.sheet.clone(), layers, seed: self.seed }
    }

    /// Says whether the sheet is large enough for filaments that spread so far. One that leaves it at one end
    /// comes in at the other, and must not meet itself there.
    ///
    /// * `spreads` – standard deviations of a filament's place in machine and in cross direction [m]
    ///
    /// # Errors
    /// If a side that is closed to a ring is shorter than eight standard deviations.
    pub fn check_spreads(&self, spreads: [f64; 2]) -> Result<(), Error> {
        let problems: Vec<Diagnostic> = too_small(&self.sheet, spreads)
            .map(|(key, side, what)| {
                Diagnostic::from(what).with_key(key, Some(Dimension::Length.pretty(side)))
            })
            .collect();
        if problems.is_empty() { Ok(()) } else { Err(problems.into()) }
    }
}

/// The sides of a sheet that are too short for filaments that spread so far: key, size [m] and what is wrong.
pub fn too_small(sheet: &Sheet, spreads: [f64; 2]) -> impl Iterator<Item = (&'static str, f64, Fault)> {
    let closed = [true, sheet.edges == Edges::Periodic];
    let sides =
        [("web.length", sheet.length, "laydown.sigma_md"), ("web.width", sheet.width, "laydown.sigma_cd")];
    let patch = move |(((key, side, sigma), spread), closed)| {
        let is_short = closed && side < LEAST_SPREADS * spread;
        let [spread, least] = [spread, LEAST_SPREADS * spread].map(|size| Dimension::Length.pretty(size));
        let fault = || {
            Fault::new(
                format!(
                    "is shorter than {LEAST_SPREADS} times {sigma} = {spread}, and a filament that leaves \
                    the web at one end comes in at the other and would meet itself"
                ),
                format!("write {least} or more"),
            )
        };
        is_short.then(|| (key, side, fault()))
    };
    sides.into_iter().zip(spreads).zip(closed).filter_map(patch)
}

impl WebSpec {
    /// The filaments of a layer per metre of width, and where they are fed; None if there is no such layer.
    pub fn curtain(&self, layer: usize) -> Option<LineFilaments> {
        let filaments = &self.layers.get(layer)?.filaments;
        let places = inlets(&self.sheet, self.seed, layer, filaments);
        let mut inlets: Vec<f64> = places.iter().map(|place| place.y).collect();
        inlets.sort_unstable_by(f64::total_cmp);
        Some(LineFilaments {
            filaments_per_metre: filaments.count(&self.sheet) as f64 / self.sheet.width,
            inlets,
        })
    }
}

impl WebSpec {
    /// The files from which the cases that it flies were read, each with the parts that it names, relative to
    /// its folder.
    pub fn files(&self) -> Vec<(&Path, &[PathBuf])> {
        self.cases().flat_map(Case::files).collect()
    }

    /// The same web with these files at other paths.
    pub fn with_files_at(&self, place: impl Fn(&Path) -> PathBuf) -> Self {
        let mut web = self.clone();
        for layer in &mut web.layers {
            if let LaydownSource::Case { case, .. } = &mut layer.source {
                *case = Arc::new(case.with_files_at(&place));
            }
        }
        web
    }
}

/// The first line of a log that keeps numbers of simulations.
pub const KEPT_SIMULATIONS: &str = "spunlaid kept simulations, format 2";

/// Under what the numbers of simulations of webs are kept: a checksum of all on which they depend.
///
/// * `numbers` – on which they depend besides the webs
pub fn kept_under<'a>(webs: impl IntoIterator<Item = &'a WebSpec>, numbers: &[f64]) -> u64 {
    let mut sum = crc32fast::Hasher::new();
    sum.update(env!("CARGO_PKG_VERSION").as_bytes());
    numbers.iter().for_each(|number| sum.update(&number.to_bits().to_le_bytes()));
    for web in webs {
        sum.update(&web.seed.to_le_bytes());
        web.of_any_error().enter(&mut sum);
    }
    sum.finalize().into()
}

impl WebSpec {
    /// Enters everything on which its records depend into a checksum.
    pub fn enter(&self, sum: &mut crc32fast::Hasher) {
        for number in 0..self.layers.len() {
            let alone = self.alone(number);
            for key in WEB_KEYS {
                if let Some(value) = key.get(&alone) {
                    sum.update(key.name.as_bytes());
                    sum.update(&value.bytes());
                }
            }
            let layer = &alone.layers[0];
            // The keys of rows show the first row only.
            sum.update(format!("{:?}", layer.filaments).as_bytes());
            layer.source.case().iter().for_each(|case| case.enter(sum));
        }
    }

    /// The same web without the keys that change no sheet of it, only how many there are or what is tried with it.
    fn of_any_error(&self) -> Self {
        // One sheet alone is a larger one, which the area says.
        let (error, assumed) = (WantedError::Auto, Vec::new());
        Self { error, time: None, assumed, turnable: None, ..self.clone() }
    }
}
