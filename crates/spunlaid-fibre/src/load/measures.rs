//! What is reported of the load of the filaments on their air. `summary.json` and the report follow from it.

use super::{Heat, Load, LoadPlace};
use Formula::{Known, Mean, Number};
use spunlaid_ground::{Formula, KELVIN, MILLIMETRES, Measure, PER_METRE, PERCENT, RATIO, Unit};

type OfLoad = Measure<Load>;
type OfPlace = Measure<LoadPlace>;

const NEWTONS_PER_METRE: Unit = Unit { shown: "N/m", per_si: 1.0 };
const PASCALS: Unit = Unit { shown: "Pa", per_si: 1.0 };
const KILOWATTS_PER_METRE: Unit = Unit { shown: "kW/m", per_si: 1e-3 };
const KILOGRAMS_PER_SECOND_AND_METRE: Unit = Unit { shown: "kg/s/m", per_si: 1.0 };

/// The measures of a load, in the order of its table.
pub const LOAD_MEASURES: &[Measure<Load>] = &[
    OfLoad::new(
        "filaments_per_m",
        "Filaments per metre of width",
        PER_METRE,
        Number(|load| load.filaments_per_metre),
    )
    .meaning("filaments of all rows, per metre of width")
    .digits(4),
    OfLoad::new("slot_m", "Slot gap", MILLIMETRES, Known(|load| Some(load.air?.slot)))
        .meaning("line.slot_gap: the gap, along MD, through which the filaments and their air pass")
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
    OfLoad::new("eddy_damping", "Damping of the eddies, at most", RATIO, Known(|load| load.damping))
        .meaning(
            "upper bound of the damping of the eddies by the filaments down to the belt: the amplitude falls by \
             less than exp(−this number)",
        )
        .digits(2),
    OfLoad::new(
        "heat_w_per_m",
        "Heat of the filaments",
        KILOWATTS_PER_METRE,
        Known(|load| Some(load.heat?.given)),
    )
    .meaning("heat given up between the die and the end of the spinline, per metre of width")
    .remark(|load| {
        let left_out = load.heat.as_ref().and_then(|heat: &Heat| heat.of_crystals)?;
        Some(format!(
            "without up to {:.1} kW/m of crystallisation, which this spinline leaves out",
            left_out * 1e-3
        ))
    })
    .digits(3),
    OfLoad::new("warming_k", "Warming of the slot's air, at most", KELVIN, Known(|load| load.heat?.warming))
        .meaning("warming of the air of the slot by all of this heat")
        .digits(3),
];

/// The measures of a load between the inlet and a place, in the order of its table.
pub const LOAD_POSITION_MEASURES: &[Measure<LoadPlace>] = &[
    OfPlace::new("x_m", "Distance from the inlet", MILLIMETRES, Number(|place| place.distance))
        .meaning("position between the inlet and the belt")
        .digits(4),
    OfPlace::new(
        "force_n_per_m",
        "Force on the air",
        NEWTONS_PER_METRE,
        Mean(|place| (place.force, place.standard_error)),
    )
    .meaning("force of the filaments on the air between the inlet and here, per metre of width"),
    OfPlace::new("share_of_momentum", "of the air’s momentum", PERCENT, Known(LoadPlace::share_of_momentum))
        .meaning("this force over the mass flow of the slot times the mean velocity here")
        .digits(2),
    OfPlace::new(
        "change_of_velocity",
        "Change of a free stream",
        PERCENT,
        Known(LoadPlace::change_of_velocity),
    )
    .meaning("fraction by which a free stream of the same width would be faster than the given air")
    .digits(2),
    OfPlace::new("pressure_pa", "Pressure between walls", PASCALS, Known(|place| place.pressure))
        .meaning("rise of pressure between the inlet and here if walls keep the given velocity")
        .digits(2),
];
