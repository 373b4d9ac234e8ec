//! What is measured of a spinline. `summary.json`, the terminal, the report, Python and the studies follow from it.

use super::{SolidificationCause, Solution, ZERO_CELSIUS};
use spunlaid_ground::Formula::Number;
use spunlaid_ground::measure::figure;
use spunlaid_ground::{KELVIN, METRES_PER_SECOND, MILLIMETRES, MILLINEWTONS, Measure, RATIO, Unit};

/// The measures of a spinline, in the order of its tables and of studies.
pub const SPINLINE_MEASURES: &[Measure<Solution>] = &[
    spun("final_diameter_m", "Diameter, cold", MICROMETRES, |found| found.final_diameter)
        .meaning("diameter of the solid filament at the end of the line")
        .named("final_diameter")
        .main()
        .figure(&figure("final_diameter", "Diameter of the filament", "diameter of the filament")),
    spun("linear_density_kg_m", "Linear density (titre)", DECITEX, |found| found.linear_density)
        .meaning("mass per length of the filament: throughput over speed")
        .named("linear_density")
        .main()
        .figure(&figure("linear_density", "Titre of the filament", "titre")),
    spun("final_speed_m_s", "Speed at the end", METRES_PER_SECOND, |found| found.final_speed)
        .meaning("speed of the filament at the end of the line")
        .named("final_speed")
        .main()
        .figure(&figure("final_speed", "Speed at the end of the spinline", "speed of the filament")),
    spun("draw_ratio", "Draw ratio", RATIO, Solution::draw_ratio)
        .meaning("speed at the end over the speed of the melt at the die")
        .named("draw_ratio")
        .figure(&figure("draw_ratio", "Draw ratio", "draw ratio")),
    spun("solidification.distance_m", "Solidification point, below the die", MILLIMETRES, |found| {
        found.solidification.distance
    })
    .meaning("distance from the die at which the filament becomes solid; from there on its speed is constant")
    .kept("solidification_distance", "solidification_distance_m")
    .main()
    .figure(&figure(
        "solidification_distance",
        "Distance of the solidification point from the die",
        "distance of the solidification point",
    )),
    spun(
        "solidification.temperature_c",
        "Temperature at solidification",
        Unit { shown: "°C", ..KELVIN },
        |found| found.solidification.temperature,
    )
    .meaning("temperature of the filament where it becomes solid")
    .zero(ZERO_CELSIUS)
    .remark(|found| {
        let by = match found.solidification.by {
            SolidificationCause::Temperature => "it solidifies by cooling",
            SolidificationCause::Crystallisation => "it solidifies by crystallisation",
        };
        Some(by.to_owned())
    })
    .kept("solidification_temperature", "solidification_temperature_k")
    .figure(&figure(
        "solidification_temperature",
        "Temperature at solidification",
        "temperature at solidification",
    )),
    spun("solidification.diameter_m", "Diameter at solidification", MICROMETRES, |found| {
        found.solidification.diameter
    })
    .meaning("diameter of the filament where it becomes solid; it still shrinks"),
    spun("solidification.stress_pa", "Stress at solidification", MEGAPASCALS, |found| {
        found.solidification.stress
    })
    .meaning("tensile stress where it becomes solid, which orients the polymer")
    .kept("solidification_stress", "solidification_stress_pa")
    .main()
    .figure(&figure("solidification_stress", "Stress at solidification", "stress at solidification")),
    spun("solidification.cooling_rate_k_s", "Cooling rate at solidification", KELVIN_PER_SECOND, |found| {
        found.solidification.cooling_rate
    })
    .meaning("cooling rate where the filament becomes solid")
    .kept("cooling_rate", "cooling_rate_k_s")
    .figure(&figure("cooling_rate", "Cooling rate at solidification", "cooling rate")),
    spun("largest_strain_rate_per_s", "Largest strain rate", PER_SECOND, |found| found.largest_strain_rate)
        .meaning("strain rate where the filament is stretched fastest")
        .named("largest_strain_rate")
        .figure(&figure("largest_strain_rate", "Largest strain rate", "largest strain rate")),
    spun("largest_strain_rate_at_m", "Its position, below the die", MILLIMETRES, |found| {
        found.largest_strain_rate_at
    })
    .meaning("distance of the largest strain rate from the die"),
    spun("force_at_die_n", "Tension at the die", MILLINEWTONS, |found| found.force_at_die)
        .meaning("tension of the filament at the die, surface tension included")
        .named("force_at_die")
        .figure(&figure("force_at_die", "Tension at the die", "tension at the die")),
    spun("force_at_end_n", "Tension at the end", MILLINEWTONS, |found| {
        // A smaller force than this part of the one at the die is zero, but for rounding.
        const ZERO: f64 = 1e-9;
        if found.force_at_end.abs() < ZERO * found.force_at_die { 0.0 } else { found.force_at_end }
    })
    .meaning("tension of the filament at the end of the line; zero for a free end"),
    spun("birefringence", "Birefringence", RATIO, |found| found.birefringence)
        .meaning(
            "birefringence of the solid by the stress-optical law; 3 to 5 times too low for polypropylene",
        )
        .remark(|found| {
            found.has_low_birefringence.then(|| "3 to 5 times too low for polypropylene".to_owned())
        })
        .named("birefringence")
        .figure(&figure("birefringence", "Birefringence of the filament", "birefringence")),
    spun("modulus_estimate_pa", "Young’s modulus, an estimate", GIGAPASCALS, |found| {
        found.modulus_estimate
    })
    .meaning("Young’s modulus from the birefringence, within a factor of two; too low for polypropylene")
    .remark(|found| {
        let is_low = found.has_low_birefringence;
        is_low.then(|| {
            "too low, from a birefringence that is 3 to 5 times too low for polypropylene".to_owned()
        })
    })
    .named("modulus_estimate")
    .main()
    .figure(&figure("modulus_estimate", "Estimate of Young’s modulus", "estimate of Young’s modulus")),
    spun("momentum_residual", "Residual of the momentum balance", RATIO, |found| found.momentum_residual)
        .meaning("residual of the momentum balance over the line, divided by the largest tension")
        .digits(1)
        .short(""),
    spun("energy_residual", "Residual of the energy balance", RATIO, |found| found.energy_residual)
        .meaning("residual of the energy balance over the line, divided by the heat that the air takes up")
        .digits(1)
        .short(""),
];

/// A number of a spinline, to four digits.
const fn spun(
    column: &'static str,
    label: &'static str,
    unit: Unit,
    number: fn(&Solution) -> f64,
) -> Measure<Solution> {
    Measure::new(column, label, unit, Number(number)).digits(4)
}

const MICROMETRES: Unit = Unit { shown: "µm", per_si: 1e6 };
const DECITEX: Unit = Unit { shown: "dtex", per_si: 1e7 };
const MEGAPASCALS: Unit = Unit { shown: "MPa", per_si: 1e-6 };
const GIGAPASCALS: Unit = Unit { shown: "GPa", per_si: 1e-9 };
const PER_SECOND: Unit = Unit { shown: "1/s", per_si: 1.0 };
const KELVIN_PER_SECOND: Unit = Unit { shown: "K/s", per_si: 1.0 };
