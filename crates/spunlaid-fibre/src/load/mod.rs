//! The load of a line's filaments on its air: what they change of its momentum, its pressure, its eddies and its heat.
//!
//! ```text
//! force of a simulated filament along its way + filaments per metre of width + slot of the air → Load
//! ```
//!
//! The flights are in the air as it is given; a load says by how much the filaments would change it.
//!                                                                            theory.md (116) to (119)

mod measures;

use crate::case::Case;
use crate::spinline::Solution;
pub use measures::{LOAD_MEASURES, LOAD_POSITION_MEASURES};
use spunlaid_air::{HEAT_CAPACITY_OF_AIR, Hint};
use spunlaid_ground::Vec3;

/// Number of places at which a load is reported, at equal distances from the inlet to the belt.
const PLACES: usize = 10;

/// What one simulated filament does at a place on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WayPlace {
    /// Distance from the inlet [m].
    pub distance: f64,
    /// Force along x with which it drives the air between the inlet and here [N].
    pub force: f64,
    /// Its standard error [N]; None if it is not known.
    pub standard_error: Option<f64>,
    /// Length of fibre per length of the way [-].
    pub fibre: f64,
}

/// The load of filaments on their air, per metre of width.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Filaments per metre of width [1/m].
    pub filaments_per_metre: f64,
    /// Mass flow of the filaments [kg/(s m)].
    pub mass_flow: f64,
    /// Momentum flux of the filaments at the inlet [N/m].
    pub momentum: f64,
    /// The air of the slot at the inlet; None where the size of the slot is not known.
    pub air: Option<SlotAir>,
    /// What the filaments do to it from the inlet to the belt; empty where nothing was simulated.
    pub places: Vec<LoadPlace>,
    /// Upper bound of the share of the energy of the eddies, as the exponent of its decay, that the filaments take
    /// on the way to the belt [-]; None where the slot is not known, nothing was simulated, or the air is calm.
    pub damping: Option<f64>,
    /// Heat that the filaments have given up since the die; None without a spinline.
    pub heat: Option<Heat>,
}

/// The air of a slot, per metre of width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlotAir {
    /// Size of the slot in machine direction [m].
    pub slot: f64,
    /// Its mass flow [kg/(s m)].
    pub mass_flow: f64,
    /// Its momentum flux at the inlet [N/m].
    pub momentum: f64,
}

/// The load between the inlet and a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadPlace {
    /// Distance from the inlet [m].
    pub distance: f64,
    /// Force along x with which all filaments drive the air between the inlet and here [N/m].
    pub force: f64,
    /// Its standard error [N/m]; None if it is not known.
    pub standard_error: Option<f64>,
    /// Momentum flux of the air here, if none of its mass flow is lost and none comes in from beside [N/m].
    pub momentum: Option<f64>,
    /// Rise of the pressure between the inlet and here, if walls hold the air [Pa].
    pub pressure: Option<f64>,
}

/// Heat that filaments give up between the die and the end of the spinline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heat {
    /// By cooling, and by crystallising as far as the spinline has computed it [W/m].
    pub given: f64,
    /// What full crystallisation would add, if the spinline leaves it out [W/m].
    pub of_crystals: Option<f64>,
    /// By how much it warms the air of the slot, if all of it goes there [K].
    pub warming: Option<f64>,
}

impl Load {
    /// The load of filaments on their air; None for a fibre of fixed length.
    ///
    /// * `slot` – size in machine direction of the slot of the air [m], if it is known
    /// * `way` – of a simulated filament, at even distances; empty if none was simulated
    /// * `spun` – the solved spinline from which they come
    pub fn new(
        case: &Case,
        filaments_per_metre: f64,
        slot: Option<f64>,
        way: &[WayPlace],
        spun: Option<&Solution>,
    ) -> Option<Self> {
        let line = case.line?;
        let mass_flow = filaments_per_metre * case.throughput()?;
        let speed = MeanSpeed::new(case);
        let air = slot.filter(|slot| *slot > 0.0 && speed.at_inlet > 0.0).map(|slot| {
            let mass_flow = case.air.density * speed.at_inlet * slot;
            SlotAir { slot, mass_flow, momentum: mass_flow * speed.at_inlet }
        });
        let places = match way {
            [] => Vec::new(),
            _ => (1..=PLACES)
                .map(|i| i as f64 / PLACES as f64 * line.distance)
                .map(|distance| LoadPlace::new(way, distance, &speed, air).times(filaments_per_metre))
                .collect(),
        };
        let damping = air.filter(|_| !way.is_empty()).and_then(|air| {
            let damping = filaments_per_metre / air.mass_flow * drag_of_eddies(case, way, line.distance);
            (damping > 0.0).then_some(damping)
        });
        let heat = spun.and_then(|spun| Heat::new(case, spun, mass_flow, air));
        let momentum = mass_flow * line.feed_speed;
        Some(Self { filaments_per_metre, mass_flow, momentum, air, places, damping, heat })
    }

    /// Mass flow of the filaments over that of the air at the inlet [-].
    pub fn mass_loading(&self) -> Option<f64> {
        self.air.map(|air| self.mass_flow / air.mass_flow)
    }

    /// Momentum flux of the filaments over that of the air at the inlet [-].
    pub fn momentum_loading(&self) -> Option<f64> {
        self.air.map(|air| self.momentum / air.momentum)
    }

    /// At the belt; None where nothing was simulated.
    pub fn at_belt(&self) -> Option<&LoadPlace> {
        self.places.last()
    }
}

impl LoadPlace {
    /// That of one filament.
    fn new(way: &[WayPlace], distance: f64, speed: &MeanSpeed<'_>, air: Option<SlotAir>) -> Self {
        let (force, standard_error) = between(way, distance);
        let momentum = air.map(|air| air.mass_flow * speed.at(distance));
        // The stream is as wide as its mass flow asks for.
        let width = |air: SlotAir, x: f64| air.slot * speed.at_inlet / speed.at(x);
        let above = way.iter().filter(|place| place.distance < distance);
        let above = above.map(|place| (place.distance, place.force)).chain([(distance, force)]);
        let rise = |air: SlotAir| {
            let pieces = above.scan((0.0, 0.0), |before, here| {
                let rise = (here.1 - before.1) / width(air, 0.5 * (here.0 + before.0));
                *before = here;
                Some(rise)
            });
            pieces.sum()
        };
        Self { distance, force, standard_error, momentum, pressure: air.map(rise) }
    }

    /// That of so many filaments.
    fn times(self, filaments: f64) -> Self {
        Self {
            force: self.force * filaments,
            standard_error: self.standard_error.map(|error| error * filaments),
            pressure: self.pressure.map(|pressure| pressure * filaments),
            ..self
        }
    }

    /// The force over the momentum flux of the air [-].
    pub fn share_of_momentum(&self) -> Option<f64> {
        self.momentum.map(|momentum| self.force / momentum)
    }

    /// By how much a free stream of the same width would be faster than the given air, over its velocity [-]; None
    /// where the filaments would stop it.
    pub fn change_of_velocity(&self) -> Option<f64> {
        let left = 1.0 + self.share_of_momentum()?;
        (left > 0.0).then(|| left.sqrt() - 1.0)
    }
}

/// The mean velocity of the air along x, in the middle of the slot.
struct MeanSpeed<'a> {
    case: &'a Case,
    at_inlet: f64,
}

impl<'a> MeanSpeed<'a> {
    fn new(case: &'a Case) -> Self {
        let mut speed = Self { case, at_inlet: 0.0 };
        speed.at_inlet = speed.at(0.0);
        speed
    }

    fn at(&self, x: f64) -> f64 {
        self.case.air.local(Vec3::new(x, 0.0, 0.0), &mut Hint::default()).velocity.x
    }
}

/// The force at a distance between places, or beyond them, along the line through the nearest two; with the larger
/// of their errors.
fn between(way: &[WayPlace], distance: f64) -> (f64, Option<f64>) {
    let after = way.iter().position(|place| place.distance > distance).unwrap_or(way.len());
    let last = after.clamp(1, way.len().saturating_sub(1).max(1));
    let (Some(a), Some(b)) = (way.get(last - 1), way.get(last)) else {
        return way.first().map_or((f64::NAN, None), |only| (only.force, only.standard_error));
    };
    let share = (distance - a.distance) / (b.distance - a.distance);
    let error = a.standard_error.zip(b.standard_error).map(|(a, b)| a.max(b));
    (a.force + share * (b.force - a.force), error)
}

/// `∫ k ℓ' dx` of one filament [kg/s]: `k`, the drag across it per length and velocity where it stands still in the
/// eddies of the place, and ℓ' the length of fibre per length of the way.                     theory.md (118)
fn drag_of_eddies(case: &Case, way: &[WayPlace], distance: f64) -> f64 {
    let drag = case.strand().drag;
    // The last place is the belt.
    let classes = way.iter().filter(|place| place.distance < distance);
    let step = distance / classes.clone().count() as f64;
    let at = |place: &WayPlace| {
        let rms = case.air.local(Vec3::new(place.distance, 0.0, 0.0), &mut Hint::default()).rms;
        let k = if rms > 0.0 { drag.across.force(rms, 1.0) / rms / case.fibre.rest_length() } else { 0.0 };
        k * place.fibre * step
    };
    classes.map(at).sum()
}

impl Heat {
    /// * `mass_flow` – of the filaments [kg/(s m)]
    fn new(case: &Case, spun: &Solution, mass_flow: f64, air: Option<SlotAir>) -> Option<Self> {
        let line = case.spinline.as_ref()?;
        let material = &line.material;
        let end = spun.end();
        let of_crystals = material.crystals.crystallinity * material.crystals.heat_of_fusion;
        let crystallised = if line.crystallisation { end.transformed * of_crystals } else { 0.0 };
        let given = mass_flow
            * (material.heat_content(line.die_temperature) - material.heat_content(end.temperature)
                + crystallised);
        Some(Self {
            given,
            of_crystals: (!line.crystallisation).then_some(mass_flow * of_crystals),
            warming: air.map(|air| given / air.mass_flow / HEAT_CAPACITY_OF_AIR),
        })
    }
}
