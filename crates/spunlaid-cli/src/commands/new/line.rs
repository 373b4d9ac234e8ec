//! The numbers of a line, with those that follow from them.

use crate::args::{LineNumbers, value};
use spunlaid::air::Cabin;
use spunlaid::fibre::{FedFilament, FilamentFeed, FilamentSize, Polymer};
use spunlaid::ground::{Dimension, Fault};

/// How far the weight that a belt takes may be from the one that is given beside it, as a share.
const NEARLY: f64 = 0.01;
/// Density of the air at 20 °C, that of the file [kg/m³].
const DENSITY: f64 = 1.204;
/// Digits with which a number that was given is written.
pub(super) const GIVEN: i32 = 9;

/// The numbers of a line [SI].
pub(super) struct NewLine<'a> {
    pub(super) given: &'a LineNumbers,
    pub(super) polymer: Polymer,
    pub(super) holes_per_metre: u64,
    pub(super) filament: FedFilament,
    /// Mass flow from each metre of width, of all beams.
    pub(super) flow: f64,
    pub(super) belt_speed: f64,
    pub(super) air_speed: f64,
    /// What blows the air, if its pressure is given.
    pub(super) cabin: Option<Cabin>,
}

impl<'a> NewLine<'a> {
    /// The line of complete numbers.
    ///
    /// # Errors
    /// If a belt of the given speed takes another weight than the given one, or if no air is as fast as the given one
    /// with the pressure.
    pub(super) fn new(given: &'a LineNumbers) -> Result<Self, Fault> {
        // What a line cannot be without has been asked for.
        let known = |number| value(number).unwrap_or(f64::NAN);
        let throughput = known(&given.throughput);
        let cabin = cabin(given)?;
        let air_speed = cabin.map_or(known(&given.air_speed), |cabin| cabin.speed(DENSITY));
        let in_all = given.holes.map(|holes| (holes as f64 / given.width.value).round().max(1.0) as u64);
        let holes_per_metre = given.holes_per_metre.or(in_all).unwrap_or(1);
        let polymer = value(&given.polymer).unwrap_or(Polymer::Pp);
        let size = value(&given.diameter)
            .map_or(FilamentSize::LinearDensity(known(&given.dtex)), FilamentSize::Diameter);
        let density = polymer.material(false).solid_density;
        let filament = FedFilament { density, size, feed: FilamentFeed::Throughput(throughput) };
        let flow = (given.beams * holes_per_metre) as f64 * throughput;
        let belt_speed = value(&given.belt_speed).unwrap_or(flow / known(&given.basis_weight));
        let weight = flow / belt_speed;
        if let Some(wanted) =
            value(&given.basis_weight).filter(|wanted| (weight / wanted - 1.0).abs() > NEARLY)
        {
            let [belt, needed] = [belt_speed, flow / wanted].map(speed);
            let [weight, wanted] = [weight, wanted].map(|weight| Dimension::BasisWeight.pretty(weight));
            let takes = format!("a belt of {belt} takes {weight} from these holes, and not {wanted}");
            return Err(Fault::new(
                format!("{takes}, which need a belt of {needed}"),
                "leave out --belt-speed or --basis-weight, or change throughput and holes",
            ));
        }
        Ok(Self { given, polymer, holes_per_metre, filament, flow, belt_speed, air_speed, cabin })
    }

    /// A warning of air that is too slow.
    pub(super) fn warning(&self) -> Option<String> {
        let [air, feed] = [self.air_speed, self.filament.feed_speed()].map(speed);
        (self.air_speed <= self.filament.feed_speed()).then(|| {
            format!(
                "the air of {air} is not faster than the filament, {feed}, and cannot draw it: check air speed, \
                throughput and titre"
            )
        })
    }
}

/// The cabin of the given pressure, with the coefficient that a measured speed gives.
fn cabin(given: &LineNumbers) -> Result<Option<Cabin>, Fault> {
    let Some(pressure) = value(&given.cabin_pressure) else { return Ok(None) };
    let Some(measured) = value(&given.air_speed) else { return Ok(Some(Cabin::new(pressure))) };
    let most = Cabin { pressure, coefficient: 1.0 }.speed(DENSITY);
    if measured > most {
        let message = format!(
            "{} blow air of {} at most, and not of {}",
            Dimension::Pressure.pretty(pressure),
            speed(most),
            speed(measured)
        );
        return Err(Fault::new(
            message,
            "leave out --cabin-pressure or --air-speed, or check where they were measured",
        ));
    }
    Ok(Some(Cabin { pressure, coefficient: measured / most }))
}

pub(super) fn speed(metres_per_second: f64) -> String {
    Dimension::Velocity.pretty(metres_per_second)
}

/// A length as it was given.
pub(super) fn length(metres: f64) -> String {
    Dimension::Length.pretty_to(metres, GIVEN as usize)
}
