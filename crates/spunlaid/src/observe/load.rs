//! The measures of the load of filaments on their air.

use super::Formula::{Known, Mean, Number};
use super::{KELVIN, MILLIMETRES, Measure, PERCENT, Unit};
use crate::load::{Heat, Load, LoadPlace};

const NEWTONS_PER_METRE: Unit = Unit { shown: "N/m", per_si: 1.0 };
const PASCALS: Unit = Unit { shown: "Pa", per_si: 1.0 };
const KILOWATTS_PER_METRE: Unit = Unit { shown: "kW/m", per_si: 1e-3 };
const KILOGRAMS_PER_SECOND_AND_METRE: Unit = Unit { shown: "kg/s/m", per_si: 1.0 };

/// The measures of a load, in the order of its table.
pub const OF_LOADS: &[Measure<Load>] = &[
    Measure::new("filaments_per_m", "Filaments per metre of width", super::PER_METRE, Number(|load: &Load| {
        load.filaments_per_metre
    }))
    .meaning("of all rows")
    .digits(4),
    Measure::new("slot_m", "Size of the slot in machine direction", MILLIMETRES, Known(|load: &Load| {
        Some(load.air?.slot)
    }))
    .meaning("line.depth: the filaments and the air that drives them come through it")
    .digits(4),
    Measure::new(
        "air_kg_s_m",
        "Air from the slot",
        KILOGRAMS_PER_SECOND_AND_METRE,
        Known(|load: &Load| Some(load.air?.mass_flow)),
    )
    .meaning("density times mean velocity at the inlet times size of the slot, per metre of width")
    .digits(3),
    Measure::new("mass_loading", "Mass loading", PERCENT, Known(Load::mass_loading))
        .meaning("mass flow of the filaments over that of the air at the inlet")
        .digits(3),
    Measure::new("momentum_loading", "Momentum loading", PERCENT, Known(Load::momentum_loading))
        .meaning("momentum flux of the filaments over that of the air at the inlet")
        .digits(3),
    Measure::new("eddy_damping", "Damping of the eddies, at most", super::RATIO, Known(|load: &Load| load.damping))
        .meaning(
            "∫ k n/(ρU) dx from the inlet to the belt, k the drag across filaments that stand still in the eddies, n \
             their length per volume: the amplitude of eddies falls by less than the factor exp(−∫)",
        )
        .digits(2),
    Measure::new("heat_w_per_m", "Heat of the filaments", KILOWATTS_PER_METRE, Known(|load: &Load| {
        Some(load.heat?.given)
    }))
    .meaning("given up between the die and the end of the spinline, per metre of width")
    .remark(|load| {
        let left_out = load.heat.as_ref().and_then(|heat: &Heat| heat.of_crystals)?;
        Some(format!("without up to {:.1} kW/m of crystallisation, which this spinline leaves out", left_out * 1e-3))
    })
    .digits(3),
    Measure::new("warming_k", "Warming of the slot's air, at most", KELVIN, Known(|load: &Load| load.heat?.warming))
        .meaning("if all of this heat goes into the air of the slot")
        .digits(3),
];

/// The measures of a load between the inlet and a place, in the order of its table.
pub const OF_LOAD_PLACES: &[Measure<LoadPlace>] = &[
    Measure::new("x_m", "Distance from the inlet", MILLIMETRES, Number(|place: &LoadPlace| place.distance))
        .meaning("place on the way from the inlet to the belt")
        .digits(4),
    Measure::new("force_n_per_m", "Force on the air", NEWTONS_PER_METRE, Mean(|place: &LoadPlace| {
        (place.force, place.standard_error)
    }))
    .meaning(
        "with which the filaments drive the air between the inlet and here, per metre of width; negative where the \
         air drives them",
    ),
    Measure::new("share_of_momentum", "of the air’s momentum", PERCENT, Known(LoadPlace::share_of_momentum))
        .meaning("over the mass flow of the slot times the mean velocity here")
        .digits(2),
    Measure::new("change_of_velocity", "Change of a free stream", PERCENT, Known(LoadPlace::change_of_velocity))
        .meaning("by which a free stream of the same width would be faster than the given air")
        .digits(2),
    Measure::new("pressure_pa", "Pressure between walls", PASCALS, Known(|place: &LoadPlace| place.pressure))
        .meaning("rise of the pressure between the inlet and here, if walls hold the air at the given velocity")
        .digits(2),
];
