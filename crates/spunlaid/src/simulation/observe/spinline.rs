//! What is measured of a spinline. `summary.json`, the terminal, the report, Python and the studies follow from it.

use super::Formula::{Known, Mean, Number};
use super::{KELVIN, METRES_PER_SECOND, MILLIMETRES, MILLINEWTONS, Measure, PERCENT, RATIO, Unit, figure};
use crate::fibre::{FreezingCause, Heat, Load, LoadPlace, Solution, ZERO_CELSIUS};

type OfLoad = Measure<Load>;
type OfPlace = Measure<LoadPlace>;

/// The measures of a spinline, in the order of its tables and of studies.
pub const OF_SPINLINES: &[Measure<Solution>] = &[
    spun("final_diameter_m", "Diameter, cold", MICROMETRES, |found| found.final_diameter)
        .meaning("diameter of the solid filament at the end of the line")
        .named("final_diameter")
        .main()
        .figure(&figure("final_diameter", "Diameter of the filament", "diameter of the filament")),
    spun("linear_density_kg_m", "Line density", DECITEX, |found| found.linear_density)
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
    spun("freezing.distance_m", "Freezing point, below the die", MILLIMETRES, |found| {
        found.freezing.distance
    })
    .meaning("from here on the filament is solid and keeps its speed")
    .kept("freezing_distance", "freezing_distance_m")
    .main()
    .figure(&figure(
        "freezing_distance",
        "Distance of the freezing point from the die",
        "distance of the freezing point",
    )),
    spun(
        "freezing.temperature_c",
        "Temperature at the freezing point",
        Unit { shown: "°C", ..KELVIN },
        |found| found.freezing.temperature,
    )
    .meaning("temperature of the thread where it becomes solid")
    .zero(ZERO_CELSIUS)
    .remark(|found| {
        let by = match found.freezing.by {
            FreezingCause::Temperature => "it freezes by its temperature",
            FreezingCause::Crystallisation => "it freezes by crystallisation",
        };
        Some(by.to_owned())
    })
    .kept("freezing_temperature", "freezing_temperature_k")
    .figure(&figure(
        "freezing_temperature",
        "Temperature of the freezing point",
        "temperature of the freezing point",
    )),
    spun("freezing.diameter_m", "Diameter at the freezing point", MICROMETRES, |found| {
        found.freezing.diameter
    })
    .meaning("diameter of the thread where it becomes solid; it still shrinks"),
    spun("freezing.stress_pa", "Stress at the freezing point", MEGAPASCALS, |found| found.freezing.stress)
        .meaning("tensile stress where it becomes solid, which orients the polymer")
        .kept("freezing_stress", "freezing_stress_pa")
        .main()
        .figure(&figure("freezing_stress", "Stress at the freezing point", "stress at the freezing point")),
    spun("freezing.cooling_rate_k_s", "Cooling rate at the freezing point", KELVIN_PER_SECOND, |found| {
        found.freezing.cooling_rate
    })
    .meaning("how fast the thread cools where it becomes solid")
    .kept("cooling_rate", "cooling_rate_k_s")
    .figure(&figure("cooling_rate", "Cooling rate at the freezing point", "cooling rate")),
    spun("largest_strain_rate_per_s", "Largest strain rate", PER_SECOND, |found| found.largest_strain_rate)
        .meaning("strain rate where the thread is stretched the fastest")
        .named("largest_strain_rate")
        .figure(&figure("largest_strain_rate", "Largest strain rate", "largest strain rate")),
    spun("largest_strain_rate_at_m", "Its place, below the die", MILLIMETRES, |found| {
        found.largest_strain_rate_at
    })
    .meaning("distance of the largest strain rate from the die"),
    spun("force_at_die_n", "Tension at the die", MILLINEWTONS, |found| found.force_at_die)
        .meaning("tension of the thread at the die, surface tension included")
        .named("force_at_die")
        .figure(&figure("force_at_die", "Tension at the die", "tension at the die")),
    spun("force_at_end_n", "Tension at the end", MILLINEWTONS, |found| {
        // A smaller force than this part of the one at the die is zero, but for rounding.
        const ZERO: f64 = 1e-9;
        if found.force_at_end.abs() < ZERO * found.force_at_die { 0.0 } else { found.force_at_end }
    })
    .meaning("zero for a free end"),
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
    spun("momentum_residual", "Balance of momentum", RATIO, |found| found.momentum_residual)
        .meaning("how far the balance of momentum fails over the line, over the largest tension")
        .digits(1)
        .short(""),
    spun("energy_residual", "Balance of energy", RATIO, |found| found.energy_residual)
        .meaning("how far the balance of energy fails over the line, over the heat that the air takes")
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

const NEWTONS_PER_METRE: Unit = Unit { shown: "N/m", per_si: 1.0 };
const PASCALS: Unit = Unit { shown: "Pa", per_si: 1.0 };
const KILOWATTS_PER_METRE: Unit = Unit { shown: "kW/m", per_si: 1e-3 };
const KILOGRAMS_PER_SECOND_AND_METRE: Unit = Unit { shown: "kg/s/m", per_si: 1.0 };

/// The measures of a load, in the order of its table.
pub const OF_LOADS: &[Measure<Load>] = &[
    OfLoad::new("filaments_per_m", "Filaments per metre of width", super::PER_METRE, Number(|load| {
        load.filaments_per_metre
    }))
    .meaning("filaments of all rows, per metre of width")
    .digits(4),
    OfLoad::new("slot_m", "Size of the slot in machine direction", MILLIMETRES, Known(|load| {
        Some(load.air?.slot)
    }))
    .meaning("line.depth, through which the filaments and their air come")
    .digits(4),
    OfLoad::new(
        "air_kg_s_m",
        "Air from the slot",
        KILOGRAMS_PER_SECOND_AND_METRE,
        Known(|load| Some(load.air?.mass_flow)),
    )
    .meaning("density times mean velocity at the inlet times slot, per metre of width")
    .digits(3),
    OfLoad::new("mass_loading", "Mass loading", PERCENT, Known(Load::mass_loading))
        .meaning("mass flow of the filaments over that of the air at the inlet")
        .digits(3),
    OfLoad::new("momentum_loading", "Momentum loading", PERCENT, Known(Load::momentum_loading))
        .meaning("momentum flux of the filaments over that of the air at the inlet")
        .digits(3),
    OfLoad::new("eddy_damping", "Damping of the eddies, at most", super::RATIO, Known(|load| load.damping))
        .meaning(
            "upper bound of how the filaments damp the eddies down to the belt: their amplitude falls by less than \
             the factor exp(−this number)",
        )
        .digits(2),
    OfLoad::new("heat_w_per_m", "Heat of the filaments", KILOWATTS_PER_METRE, Known(|load| {
        Some(load.heat?.given)
    }))
    .meaning("heat given up between the die and the end of the spinline, per metre of width")
    .remark(|load| {
        let left_out = load.heat.as_ref().and_then(|heat: &Heat| heat.of_crystals)?;
        Some(format!("without up to {:.1} kW/m of crystallisation, which this spinline leaves out", left_out * 1e-3))
    })
    .digits(3),
    OfLoad::new("warming_k", "Warming of the slot's air, at most", KELVIN, Known(|load| load.heat?.warming))
        .meaning("warming of the air of the slot by all of this heat")
        .digits(3),
];

/// The measures of a load between the inlet and a place, in the order of its table.
pub const OF_LOAD_PLACES: &[Measure<LoadPlace>] = &[
    OfPlace::new("x_m", "Distance from the inlet", MILLIMETRES, Number(|place| place.distance))
        .meaning("place on the way from the inlet to the belt")
        .digits(4),
    OfPlace::new(
        "force_n_per_m",
        "Force on the air",
        NEWTONS_PER_METRE,
        Mean(|place| (place.force, place.standard_error)),
    )
    .meaning(
        "force with which the filaments drive the air between the inlet and here, per metre of width; \
         negative where the air drives them",
    ),
    OfPlace::new("share_of_momentum", "of the air’s momentum", PERCENT, Known(LoadPlace::share_of_momentum))
        .meaning("this force over the mass flow of the slot times the mean velocity here")
        .digits(2),
    OfPlace::new(
        "change_of_velocity",
        "Change of a free stream",
        PERCENT,
        Known(LoadPlace::change_of_velocity),
    )
    .meaning("share by which a free stream of the same width would be faster than the given air")
    .digits(2),
    OfPlace::new("pressure_pa", "Pressure between walls", PASCALS, Known(|place| place.pressure))
        .meaning("rise of pressure between the inlet and here if walls keep the given velocity")
        .digits(2),
];
