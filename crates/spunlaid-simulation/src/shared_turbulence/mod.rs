//! All filaments of a layer in shared turbulence: a beam, simulated together and laid on a sheet as they land.
//!
//! ```text
//! places → packs of eight neighbours → flights, which advance together by a block of time
//!        → laid points → the canvas, at once; the curves of a few filaments are kept
//!
//! layer → all of its filaments, or a few for all → a beam → the map, and what is said of all
//! webs  → a few filaments of each, in the same air → comparison
//! ```
//!
//! A sheet is not closed to a ring in machine direction, because the air at its two ends is not the same.
//! Instead the filaments lay more belt than the sheet is long, and the sheet is the part on which every
//! filament lies as it does after its start:
//!
//! ```text
//! belt   |  laid by the start  |······ sheet ······|  some filaments are still to come  |      → the belt moves
//!                              └ no point of the start lies behind here
//! ```

mod charge;
mod comparison;
mod flyer;
mod flying;
mod laid_curves;
mod lane_group;
mod layer_beam;
mod neighbours;
mod pinned;
mod sampled;
mod shared_air;
mod two_levels;

pub use charge::BeamCharge;
pub use comparison::{FewOfWeb, fits_memory, steps_in_same_air};
pub use flyer::{Flights, Flyer};
use flying::Sink;
pub use laid_curves::FlownWeb;
pub use layer_beam::PlannedFlight;
use neighbours::Neighbours;
pub use pinned::LaidStretch;
pub use pinned::{LookOfLayer, PITCHES, PinnedLayer, SeenOfLayer};
pub use sampled::Compared;
use shared_air::SharedAir;
use spunlaid_fibre::{Case, LaidPoint, WayPlace};
use spunlaid_ground::place::Inlet;
use spunlaid_ground::{Error, RunContext};
use spunlaid_web::{DepositionGrid, Depositor, LaidWeb, LayerFlown, Sheet, Titres, Window};

/// Filaments whose whole curves are kept, spread over the beam: some hundred kilobytes each.
const KEPT: usize = 64;
/// Time by which all flights advance before the next block, unless the air has one [s].
const BLOCK: f64 = 4e-3;
/// How far from its place a filament is reckoned to land before it is known, in ways from inlet to belt. Only
/// the display of progress needs it.
const SPREAD: f64 = 0.2;

/// The filaments of a layer.
#[derive(Clone, Copy, Debug)]
pub struct Beam<'a> {
    /// The case of each. The seed of its run is the key of the air.
    pub case: &'a Case,
    /// Where they are fed, in order across the web.
    pub places: &'a [Inlet],
    /// Size in machine direction of the slot in which the places lie [m]. All filaments of a slot fly in the
    /// same air, however many of them there are and wherever in its depth they hang.
    pub depth: f64,
    /// The charge that they carry; None without one.
    pub charge: Option<&'a BeamCharge>,
}

/// What the filaments of a beam have done besides laying the sheet.
#[derive(Debug, Default)]
pub struct BeamFindings {
    /// All points that some filaments have laid, from the start on, with their numbers across the web.
    pub kept: Vec<(usize, Vec<LaidPoint>)>,
    /// What the web keeps of them.
    pub layer: LayerFlown,
    /// The filaments that were lost, by their numbers across the web, each with the reason.
    pub lost: Vec<(usize, Error)>,
    /// What a filament does to its air on its way, on average.
    pub way: Vec<WayPlace>,
    /// Where the sheet begins on the belt, at its back [m].
    pub back: f64,
    /// How many times as fast the pattern of its air passes as that of the first beam beside it.
    pub(crate) pace: f64,
}

impl<'a> Beam<'a> {
    /// Filaments without charge at these places, in a slot that is as deep as they need.
    pub fn new(case: &'a Case, places: &'a [Inlet]) -> Self {
        let y = || places.iter().map(|place| place.y);
        let depth = y().fold(f64::NEG_INFINITY, f64::max) - y().fold(f64::INFINITY, f64::min);
        Self { case, places, depth: depth.max(0.0), charge: None }
    }
}

impl Beam<'_> {
    /// About how many steps all filaments together take for a sheet.
    pub(crate) fn steps(&self, sheet: &Sheet) -> u64 {
        let Some(line) = self.case.line else { return 0 };
        let fall = line.distance / line.feed_speed;
        let stretch = sheet.length + 2.0 * SPREAD * line.distance;
        let time = self.case.run.spin_up() + fall + stretch / line.belt_speed;
        (time / self.case.run.time_step) as u64 * self.places.len() as u64
    }

    /// Flies all filaments and lays them on a sheet.
    ///
    /// * `window` – of the sheet, whose single fibres are kept
    ///
    /// # Errors
    /// A filament that is not fed, one whose flight cannot be made, too many lost ones, an interruption, and
    /// a cell that would hold more fibre than can be counted.
    pub fn lay(
        &self,
        sheet: &Sheet,
        window: Window,
        by: RunContext<'_>,
    ) -> Result<(LaidWeb, BeamFindings), Error> {
        let element = self.element_mass();
        let canvas = DepositionGrid::new(sheet, &[element], self.basis_weight(sheet))?;
        let brush = Depositor::new(&canvas, element, Titres::default());
        let simulated = self.fly(sheet, window, Some(&brush), by)?;
        Ok((LaidWeb { simulated: vec![simulated.layer.clone()], ..canvas.finish()? }, simulated))
    }

    /// Mass of an element of a filament [kg].
    pub(crate) fn element_mass(&self) -> f64 {
        self.case.fibre.element_mass()
    }

    /// Length on the belt of what becomes of an element, if it is not stretched [m].
    pub(crate) fn longest_piece(&self) -> f64 {
        self.case.fibre.rest_length() * (1.0 + self.case.line.map_or(0.0, |line| line.belt_ratio()))
    }

    /// Mass of all filaments over the area on which they are laid [kg/m²].
    pub(crate) fn basis_weight(&self, sheet: &Sheet) -> f64 {
        let fibre = &self.case.fibre;
        let per_length = self.element_mass() / fibre.rest_length() * self.places.len() as f64;
        self.case.line.map_or(0.0, |line| per_length / line.belt_ratio() / sheet.width)
    }

    /// Flies all filaments, and lays them on a canvas or keeps all their curves.
    ///
    /// * `window` – of the sheet, whose single fibres are kept
    /// * `on` – what draws an element of fibre; None to keep the curves of all filaments in place of it
    ///
    /// # Errors
    /// If the case cannot be simulated or its fibre is not laid on a moving belt, if more than 2 % of the
    /// filaments are lost, or if it is stopped.
    pub(crate) fn fly(
        &self,
        sheet: &Sheet,
        window: Window,
        on: Option<&Depositor<'_>>,
        by: RunContext<'_>,
    ) -> Result<BeamFindings, Error> {
        let sink = Sink { window, on, neighbours: Some(Neighbours::new(self, sheet)) };
        let simulated = SharedAir::of_one(self, sheet, f64::INFINITY).fly(vec![sink], by)?;
        simulated.into_iter().next().ok_or_else(Error::no_fibre)?
    }

    /// Whether the curve of a filament is kept.
    pub(crate) fn keeps(&self, filament: usize) -> bool {
        let count = self.places.len();
        count <= KEPT || filament * KEPT / count != (filament + 1) * KEPT / count
    }
}

impl BeamFindings {
    /// Puts what packs have given into the order across the web.
    fn sort(&mut self) {
        self.kept.sort_by_key(|(filament, _)| *filament);
        self.lost.sort_by_key(|(filament, _)| *filament);
        // A filament comes through the window in the order of its strands.
        self.layer.strands.sort_by_key(|strand| strand.filament);
    }
}
