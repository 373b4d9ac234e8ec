//! The steady state of one filament: the shot that meets the end, what it says, and why there may be none.

use super::boundary::largest_tension;
use super::filament::{Filament, HEAT, LN_SPEED, PULL, Phase, TEMPERATURE, TENSION, WORK};
use super::shooting::{Hit, MISSED, Miss, find, follow};
use super::shot::Shot;
use super::solution::{Solidification, Solution, Station};
use super::{End, Failure, Spinline, Surroundings, ZERO_CELSIUS};
use crate::drag::FrictionLaw;
use spunlaid_ground::{Dimension, Fault};

/// Parts of the line between its stations, which are evenly spaced in the root of the distance.
const PARTS: usize = 400;
/// Looks at the strain rate in each step.
const LOOKS: usize = 16;
/// States whose speeds differ by more than this are not the same one, `ln v`.
const FAR: f64 = 0.3;

/// The steady state of a filament in this air.
pub(super) fn solve(line: &Spinline, friction: FrictionLaw, air: &Surroundings) -> Result<Solution, Failure> {
    let filament = Filament::new(line, friction, air);
    if let Some(failure) = impossible_line(&filament) {
        return Err(failure);
    }
    describe(&filament, &seek(&filament)?)
}

/// The steady state of a filament in this air, next to the state of a line that differs a little. If it is
/// lost it is sought.
pub(super) fn solve_near(
    line: &Spinline,
    friction: FrictionLaw,
    air: &Surroundings,
    near: &Solution,
) -> Result<Solution, Failure> {
    let filament = Filament::new(line, friction, air);
    describe(&filament, &hit_near(&filament, near)?)
}

/// The speed at the end of such a filament [m/s].
pub(super) fn final_speed_near(
    line: &Spinline,
    friction: FrictionLaw,
    air: &Surroundings,
    near: &Solution,
) -> Result<f64, Failure> {
    let filament = Filament::new(line, friction, air);
    let hit = hit_near(&filament, near)?;
    // Only where a filament breaks decides more than its end does.
    if hit.shot.solidification.is_none() || line.break_stress.is_finite() {
        return Ok(describe(&filament, &hit)?.final_speed);
    }
    Ok(libm::exp(hit.shot.end[LN_SPEED]))
}

/// The shot that meets the end next to a known one; sought if it is lost.
fn hit_near(filament: &Filament<'_>, near: &Solution) -> Result<Hit, Failure> {
    if let Some(failure) = impossible_line(filament) {
        return Err(failure);
    }
    // A state that differs much is another one: only a search reports which of them a line runs in.
    let is_near = |hit: &Hit| (hit.shot.end[LN_SPEED] - libm::log(near.final_speed)).abs() < FAR;
    match follow(filament, near.force_at_die, near.has_second).filter(is_near) {
        Some(hit) => pulled(filament, hit),
        None => seek(filament),
    }
}

/// The shot that meets the end.
fn seek(filament: &Filament<'_>) -> Result<Hit, Failure> {
    let found = find(filament, filament.line.crystallisation);
    pulled(filament, found.map_err(|miss| shooting_failure(filament, miss))?)
}

/// A filament that no godet pushes.
fn pulled(filament: &Filament<'_>, hit: Hit) -> Result<Hit, Failure> {
    match filament.end {
        End::TakeUp(speed) if hit.shot.end[TENSION] < -MISSED * largest_tension(&hit.shot) => {
            Err(slow_godet(filament, speed))
        }
        _ => Ok(hit),
    }
}

/// A take-up that is slower than the filament would run without it.
fn slow_godet(filament: &Filament<'_>, speed: f64) -> Failure {
    let free = Filament { end: End::Tension(0.0), ..filament.clone() };
    let free =
        find(&free, false).ok().map(|hit| libm::exp(hit.shot.end[LN_SPEED])).filter(|free| *free > speed);
    let faster = free.map_or(String::new(), |free| {
        format!(": without a godet it runs at {}", Dimension::Velocity.pretty(free))
    });
    let message =
        format!("is lower than the speed that the filament reaches by its weight and the air alone{faster}");
    let remedy = "raise it, or leave out spinline.end, which makes the end free";
    Failure::new("spinline.take_up_speed", Some(speed), Fault::new(message, remedy))
}

/// Why no filament can run in this line, as far as this is known before it is solved.
fn impossible_line(filament: &Filament<'_>) -> Option<Failure> {
    let line = filament.line;
    let celsius = |kelvin: f64| Dimension::Temperature.pretty(kelvin);
    let solidification = line.material.solidification_temperature;
    if line.die_temperature <= solidification {
        let message = format!("is not above {}, at which the polymer solidifies", celsius(solidification));
        let remedy = "raise it, or correct spinline.material.solidification_temperature";
        let value = Some(line.die_temperature);
        return Some(Failure::new("spinline.die_temperature", value, Fault::new(message, remedy)));
    }
    let coldest = filament.coldest_air();
    if coldest >= solidification && !line.crystallisation {
        let (key, value) = key_of_air(filament.air, coldest, "spinline.temperature");
        let message = format!(
            "leaves the air nowhere colder than {}, and the polymer solidifies at {}",
            celsius(coldest),
            celsius(solidification)
        );
        return Some(Failure::new(key, value, Fault::new(message, "cool the air")));
    }
    let die_speed = filament.die_speed();
    match line.end {
        End::TakeUp(speed) if speed < die_speed => {
            let found = Dimension::Velocity.pretty(die_speed);
            let message = format!("is below {found}, the speed of the melt in the hole");
            let remedy =
                "raise the take-up speed, lower spinline.throughput, or widen spinline.hole_diameter";
            Some(Failure::new("spinline.take_up_speed", Some(speed), Fault::new(message, remedy)))
        }
        End::TakeUp(_) | End::Tension(_) | End::Flown(_) => None,
    }
}

/// The key that gives the air, and its value if it is a number.
///
/// * `value`, `key` – what they are if the air is the same everywhere
fn key_of_air(air: &Surroundings, value: f64, key: &'static str) -> (&'static str, Option<f64>) {
    match air {
        Surroundings::Uniform(_) => (key, Some(value)),
        Surroundings::Table(_) => ("spinline.profile", None),
        Surroundings::Field { .. } => ("spinline.field", None),
        Surroundings::Behind(_) => ("spinline.rows", None),
    }
}

const NO_THREAD: &str =
    "has no steady state: with any tension at the die the filament is either slack or faster than 2000 m/s";

const NOT_FOUND: &str = "is not solved: no steady state was found, and it is not known whether there is one";
const STAYS_LIQUID: &str = "has no steady state: in the solutions followed from slower lines, the melt \
    stops cooling before it is solid";
const CHECK_PULL: &str = "check the viscosity of the melt, the air and the throughput";

/// Why no tension at the die meets the end of the line.
fn shooting_failure(filament: &Filament<'_>, miss: Miss) -> Failure {
    let (line, air) = (filament.line, filament.air);
    match (miss, line.end) {
        (Miss::Liquid(temperature), _) => liquid_end(line, temperature),
        (Miss::ElasticWave, _) => Failure::new(
            "spinline.law",
            None,
            Fault::new(
                "makes the melt too elastic for this speed: the filament would be as fast as its own elastic wave",
                "raise spinline.material.modulus, or leave spinline.law out",
            ),
        ),
        (Miss::TooMuch | Miss::Pushed(_), End::TakeUp(speed)) => slow_godet(filament, speed),
        (Miss::Pushed(distance), _) => {
            let place = Dimension::Length.pretty(distance);
            let message =
                format!("has no steady state: the melt is no longer pulled at {place} from the die");
            Failure::new("spinline.throughput", Some(line.throughput), Fault::new(message, CHECK_PULL))
        }
        _ if !filament.is_computable() => {
            let message = "leads to numbers that are too large or too small to compute with";
            let remedy = "check it, and all other values of the line, and their units";
            Failure::new("spinline.throughput", Some(line.throughput), Fault::new(message, remedy))
        }
        (Miss::NoThread | Miss::TurnsBack(_) | Miss::StaysLiquid | Miss::NotFound, _)
        | (Miss::Slack, End::TakeUp(_)) => no_thread(filament, miss),
        (Miss::Slack, End::Tension(tension) | End::Flown(tension)) if tension != 0.0 => {
            no_thread(filament, miss)
        }
        (Miss::TooMuch | Miss::Slack, _) => {
            let velocity = match air {
                Surroundings::Uniform(air) => air.velocity,
                _ => f64::NAN,
            };
            let (key, value) = key_of_air(air, velocity, "spinline.velocity");
            let message =
                "has no steady state: the air does not pull, it is slower than the filament everywhere";
            Failure::new(key, value, Fault::new(message, "check the direction and the speed of the air"))
        }
    }
}

/// That no tension at the die meets the end, and how this is known.
fn no_thread(filament: &Filament<'_>, miss: Miss) -> Failure {
    let end = filament.end;
    let message = match (miss, end) {
        (Miss::NotFound, _) => NOT_FOUND.to_owned(),
        (Miss::StaysLiquid, _) => STAYS_LIQUID.to_owned(),
        (Miss::TurnsBack(speed), End::TakeUp(_)) => {
            let speed = Dimension::Velocity.pretty(speed);
            format!(
                "has no steady state: the solutions followed from slower lines end at {speed} and turn back"
            )
        }
        (Miss::TurnsBack(tension), _) => {
            let tension = Dimension::Force.pretty(tension);
            format!(
                "has no steady state: the solutions followed from slower lines end with {tension} and turn back"
            )
        }
        _ => NO_THREAD.to_owned(),
    };
    let (key, value, remedy) = match end {
        End::TakeUp(speed) => {
            ("spinline.take_up_speed", speed, "lower it, heat the die, or write a higher melt flow rate")
        }
        End::Tension(tension) | End::Flown(tension) if tension != 0.0 => (
            "spinline.end_tension",
            tension,
            "write \"0 N\" for a free end, or a small tension like \"0.1 mN\"",
        ),
        _ => ("spinline.throughput", filament.line.throughput, CHECK_PULL),
    };
    Failure::new(key, Some(value), Fault::new(message, remedy))
}

/// The filament is not solid at the end of the line.
fn liquid_end(line: &Spinline, temperature: f64) -> Failure {
    let celsius = |kelvin: f64| format!("{:.0} °C", kelvin - ZERO_CELSIUS);
    let reached = celsius(temperature);
    let solid = celsius(line.material.solidification_temperature);
    let message = format!(
        "is too short: the polymer is still at {reached} at the end of the spinline and solidifies at {solid}"
    );
    Failure::new(
        "spinline.length",
        Some(line.length),
        Fault::new(message, "more quench air, or a longer line"),
    )
}

/// What a shot says.
fn describe(filament: &Filament<'_>, hit: &Hit) -> Result<Solution, Failure> {
    let (line, shot) = (filament.line, &hit.shot);
    let Some((by, at, cooling_rate)) = shot.solidification else {
        return Err(liquid_end(line, shot.end[TEMPERATURE]));
    };
    let solidification = Solidification {
        distance: at.distance,
        temperature: at.temperature,
        diameter: at.diameter,
        stress: at.stress,
        cooling_rate,
        by,
    };
    let stations = stations(filament, shot, at.distance);
    let breaks = |station: &&Station| station.stress > line.break_stress && station.distance <= at.distance;
    if let Some(broken) = stations.iter().find(breaks) {
        let strongest = Dimension::Pressure.pretty(broken.stress);
        let place = Dimension::Length.pretty(broken.distance);
        let message = format!("is exceeded: {strongest} at {place} from the die");
        let remedy = "a hotter die, less drawing air or a higher melt flow rate lowers the stress";
        return Err(Failure::new(
            "spinline.break_stress",
            Some(line.break_stress),
            Fault::new(message, remedy),
        ));
    }
    let (largest_strain_rate, largest_strain_rate_at) = largest_strain_rate(filament, shot);
    let material = &line.material;
    let final_speed = libm::exp(shot.end[LN_SPEED]);
    let linear_density = line.throughput / final_speed;
    let birefringence = material.birefringence(at.stress, at.temperature);
    let (momentum_residual, energy_residual) = residuals(filament, hit, &stations);
    Ok(Solution {
        die_speed: filament.die_speed(),
        final_speed,
        final_diameter: line.final_diameter(final_speed),
        linear_density,
        solidification,
        force_at_die: hit.tension,
        force_at_end: shot.end[TENSION],
        largest_strain_rate,
        largest_strain_rate_at,
        birefringence,
        has_low_birefringence: line.has_low_birefringence(),
        modulus_estimate: material.estimate_modulus(birefringence),
        momentum_residual,
        energy_residual,
        has_second: hit.has_second,
        stations,
    })
}

/// The filament at places evenly spaced in the root of the distance, at the rows of the air's table and where
/// it becomes solid.
fn stations(filament: &Filament<'_>, shot: &Shot, frozen: f64) -> Vec<Station> {
    let length = filament.line.length;
    let even = (0..=PARTS).map(|i| {
        let share = i as f64 / PARTS as f64;
        length * share * share
    });
    let rows = filament.air.rows().iter().copied().filter(|row| (0.0..=length).contains(row));
    let mut distances: Vec<f64> = even.chain(rows).chain([frozen]).collect();
    distances.sort_by(f64::total_cmp);
    distances.dedup();
    let (mut hint, mut steps) = (0, shot.steps.iter().peekable());
    let at = |distance: f64| {
        let s = libm::sqrt(distance);
        // The solidification point belongs to the melt.
        while steps.len() > 1 && steps.peek().is_some_and(|step| step.end() < s) {
            steps.next();
        }
        let step = steps.peek()?;
        let phase = if distance <= frozen { Phase::Melt } else { step.phase };
        let looked = distance.max(1e-14 * length);
        Some(Station { distance, ..filament.rates(looked, &step.at(s), phase, &mut hint).station })
    };
    distances.into_iter().filter_map(at).collect()
}

/// The largest strain rate [1/s] and its distance from the die [m]: of many places in each step, and then by
/// thirds between the neighbours of the best.
pub(super) fn largest_strain_rate(filament: &Filament<'_>, shot: &Shot) -> (f64, f64) {
    let mut hint = 0;
    let mut rate = |step: &super::integration::Step, s: f64| {
        let distance = (s * s).max(1e-14 * filament.line.length);
        filament.rates(distance, &step.at(s), Phase::Melt, &mut hint).station.strain_rate
    };
    let mut best = (f64::NEG_INFINITY, 0.0);
    for step in shot.steps.iter().filter(|step| step.phase == Phase::Melt) {
        let s = |i: usize| step.start + step.length * i as f64 / LOOKS as f64;
        let Some(highest) = (0..=LOOKS).max_by(|a, b| rate(step, s(*a)).total_cmp(&rate(step, s(*b)))) else {
            continue;
        };
        let mut low = s(highest.saturating_sub(1));
        let mut high = s((highest + 1).min(LOOKS));
        if rate(step, s(highest)) > best.0 * (1.0 - 1e-3) {
            for _ in 0..40 {
                let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
                if rate(step, a) < rate(step, b) { low = a } else { high = b }
            }
            for place in [low, 0.5 * (low + high), high] {
                let found = rate(step, place);
                if found > best.0 {
                    best = (found, place * place);
                }
            }
        }
    }
    best
}

/// By how much the balances of momentum and of energy over the whole line fail [-].      theory.md (96), (97)
pub(super) fn residuals(filament: &Filament<'_>, hit: &Hit, stations: &[Station]) -> (f64, f64) {
    let (line, end, material) = (filament.line, &hit.shot.end, &filament.line.material);
    let mass_flow = line.throughput;
    let accelerated = mass_flow * (libm::exp(end[LN_SPEED]) - filament.die_speed());
    let forces = end[TENSION] - hit.tension - (accelerated - end[PULL]);
    let largest = stations.iter().map(|station| station.tension.abs()).fold(hit.tension, f64::max);
    // ∫ c_p dT from the end to the die.
    let [cold, hot] = [end[TEMPERATURE], line.die_temperature].map(|kelvin| kelvin - ZERO_CELSIUS);
    let cooled = (hot - cold) * (material.heat_capacity + 0.5 * material.heat_capacity_slope * (hot + cold));
    let fused = if line.crystallisation {
        material.crystals.heat_of_fusion * material.crystals.crystallinity * filament.transformed(end)
    } else {
        0.0
    };
    let worked = if line.dissipation { end[WORK] } else { 0.0 };
    let given = mass_flow * (cooled + fused) + worked;
    let scale = end[HEAT].abs().max(f64::MIN_POSITIVE);
    (forces / largest, (given - end[HEAT]) / scale)
}
