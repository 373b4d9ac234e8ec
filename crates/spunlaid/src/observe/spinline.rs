//! What is measured of a spinline. Each measure is declared once: its name, unit, meaning, figure, and how it is found. `summary.json`,
//! the terminal, the report, Python and the studies follow from it.

use super::{MILLIMETRES, MILLINEWTONS, Measure, RATIO, Unit, figure};
use crate::spinline::{Solution, ZERO_CELSIUS};

/// A measure of a spinline.
#[derive(Debug)]
pub struct SpinlineMeasure {
    /// Name in `summary.json`, with its unit; a point separates the name of a group: `freezing.distance_m`.
    pub name: &'static str,
    /// Its label on the terminal and in the report of a spinline.
    pub label: &'static str,
    /// The unit in which it is shown there.
    pub unit: Unit,
    /// What it means.
    pub meaning: &'static str,
    /// Its value in SI units.
    pub number: fn(&Solution) -> f64,
    /// The SI value that is zero in `summary.json`: 273.15 K of a temperature in °C.
    pub zero: f64,
    /// Whether it tells how well the equations are solved. It has one digit, and the terminal tells it in a sentence.
    pub is_residual: bool,
    /// The measure as studies keep it; none if they do not.
    pub study: Option<Measure>,
    /// Its place among the columns of a study, from 0.
    pub study_place: usize,
}

impl SpinlineMeasure {
    /// A plain number that has no name yet.
    const NUMBER: Self = Self {
        name: "",
        label: "",
        unit: RATIO,
        meaning: "",
        number: |_| f64::NAN,
        zero: 0.0,
        is_residual: false,
        study: None,
        study_place: 0,
    };

    /// Its value in the unit of its name.
    pub fn value(&self, found: &Solution) -> f64 {
        (self.number)(found) - self.zero
    }
}

/// The measures of a spinline, in the order of its tables.
pub const OF_SPINLINES: &[SpinlineMeasure] = &[
    SpinlineMeasure {
        name: "final_diameter_m",
        label: "Diameter, cold",
        unit: MICROMETRES,
        meaning: "of the solid filament at the end of the line, with the density of the solid",
        number: |found| found.final_diameter,
        study: Some(Measure {
            name: "final_diameter",
            column: "final_diameter_m",
            label: "Diameter of the filament",
            meaning: "diameter of the cold filament",
            unit: MICROMETRES,
            figure: &figure("final_diameter", "Diameter of the filament", "diameter of the filament"),
            ..Measure::NUMBER
        }),
        study_place: 0,
        ..SpinlineMeasure::NUMBER
    },
    SpinlineMeasure {
        name: "linear_density_kg_m",
        label: "Line density",
        unit: DECITEX,
        meaning: "mass per length of the filament: throughput over speed",
        number: |found| found.linear_density,
        study: Some(Measure {
            name: "linear_density",
            column: "linear_density_kg_m",
            label: "Titre",
            meaning: "mass per length of the filament",
            unit: DECITEX,
            figure: &figure("linear_density", "Titre of the filament", "titre"),
            ..Measure::NUMBER
        }),
        study_place: 2,
        ..SpinlineMeasure::NUMBER
    },
    SpinlineMeasure {
        name: "final_speed_m_s",
        label: "Speed",
        unit: METRES_PER_SECOND,
        meaning: "of the filament at the end of the line",
        number: |found| found.final_speed,
        study: Some(Measure {
            name: "final_speed",
            column: "final_speed_m_s",
            label: "Speed at the end",
            meaning: "speed of the filament at the end of the spinline",
            unit: METRES_PER_SECOND,
            figure: &figure("final_speed", "Speed at the end of the spinline", "speed of the filament"),
            ..Measure::NUMBER
        }),
        study_place: 1,
        ..SpinlineMeasure::NUMBER
    },
    SpinlineMeasure {
        name: "draw_ratio",
        label: "Draw ratio",
        meaning: "speed at the end over the speed at the die",
        number: Solution::draw_ratio,
        study: Some(Measure {
            name: "draw_ratio",
            column: "draw_ratio",
            label: "Draw ratio",
            meaning: "speed at the end over the speed of the melt in the hole",
            figure: &figure("draw_ratio", "Draw ratio", "draw ratio"),
            ..Measure::NUMBER
        }),
        study_place: 3,
        ..SpinlineMeasure::NUMBER
    },
    SpinlineMeasure {
        name: "freezing.distance_m",
        label: "Freezing point, below the die",
        unit: MILLIMETRES,
        meaning: "from here on the filament is solid and keeps its speed",
        number: |found| found.freezing.distance,
        study: Some(Measure {
            name: "freezing_distance",
            column: "freezing_distance_m",
            label: "Freezing point, distance from the die",
            meaning: "distance from the die at which the thread is solid",
            unit: MILLIMETRES,
            figure: &figure(
                "freezing_distance",
                "Distance of the freezing point from the die",
                "distance of the freezing point",
            ),
            ..Measure::NUMBER
        }),
        study_place: 4,
        ..SpinlineMeasure::NUMBER
    },
    SpinlineMeasure {
        name: "freezing.temperature_c",
        label: "Temperature there",
        unit: CELSIUS,
        zero: ZERO_CELSIUS,
        meaning: "of the thread at the freezing point",
        number: |found| found.freezing.temperature,
        study: Some(Measure {
            name: "freezing_temperature",
            column: "freezing_temperature_k",
            label: "Freezing point, temperature",
            meaning: "temperature of the thread where it becomes solid",
            unit: KELVIN,
            figure: &figure(
                "freezing_temperature",
                "Temperature of the freezing point",
                "temperature of the freezing point",
            ),
            ..Measure::NUMBER
        }),
        study_place: 5,
        ..SpinlineMeasure::NUMBER
    },
    SpinlineMeasure {
        name: "freezing.diameter_m",
        label: "Diameter there",
        unit: MICROMETRES,
        meaning: "of the thread at the freezing point; it shrinks as it cools further",
        number: |found| found.freezing.diameter,
        ..SpinlineMeasure::NUMBER
    },
    SpinlineMeasure {
        name: "freezing.stress_pa",
        label: "Stress there",
        unit: MEGAPASCALS,
        meaning: "tensile stress at the freezing point, which orients the polymer",
        number: |found| found.freezing.stress,
        study: Some(Measure {
            name: "freezing_stress",
            column: "freezing_stress_pa",
            label: "Freezing point, stress",
            meaning: "stress of the thread where it becomes solid",
            unit: MEGAPASCALS,
            figure: &figure(
                "freezing_stress",
                "Stress at the freezing point",
                "stress at the freezing point",
            ),
            ..Measure::NUMBER
        }),
        study_place: 6,
        ..SpinlineMeasure::NUMBER
    },
    SpinlineMeasure {
        name: "freezing.cooling_rate_k_s",
        label: "Cooling rate there",
        unit: KELVIN_PER_SECOND,
        meaning: "how fast the thread cools at the freezing point",
        number: |found| found.freezing.cooling_rate,
        study: Some(Measure {
            name: "cooling_rate",
            column: "cooling_rate_k_s",
            label: "Cooling rate at the freezing point",
            meaning: "how fast the thread cools where it becomes solid",
            unit: KELVIN_PER_SECOND,
            figure: &figure("cooling_rate", "Cooling rate at the freezing point", "cooling rate"),
            ..Measure::NUMBER
        }),
        study_place: 9,
        ..SpinlineMeasure::NUMBER
    },
    SpinlineMeasure {
        name: "largest_strain_rate_per_s",
        label: "Largest strain rate",
        unit: PER_SECOND,
        meaning: "where the thread is stretched the fastest",
        number: |found| found.largest_strain_rate,
        study: Some(Measure {
            name: "largest_strain_rate",
            column: "largest_strain_rate_per_s",
            label: "Largest strain rate",
            meaning: "largest rate at which the thread is stretched",
            unit: PER_SECOND,
            figure: &figure("largest_strain_rate", "Largest strain rate", "largest strain rate"),
            ..Measure::NUMBER
        }),
        study_place: 8,
        ..SpinlineMeasure::NUMBER
    },
    SpinlineMeasure {
        name: "largest_strain_rate_at_m",
        label: "Its place, below the die",
        unit: MILLIMETRES,
        meaning: "distance of the largest strain rate from the die",
        number: |found| found.largest_strain_rate_at,
        ..SpinlineMeasure::NUMBER
    },
    SpinlineMeasure {
        name: "force_at_die_n",
        label: "Tension at the die",
        unit: MILLINEWTONS,
        meaning: "with the part of the surface tension",
        number: |found| found.force_at_die,
        study: Some(Measure {
            name: "force_at_die",
            column: "force_at_die_n",
            label: "Tension at the die",
            meaning: "tension of the thread at the die",
            unit: MILLINEWTONS,
            figure: &figure("force_at_die", "Tension at the die", "tension at the die"),
            ..Measure::NUMBER
        }),
        study_place: 7,
        ..SpinlineMeasure::NUMBER
    },
    SpinlineMeasure {
        name: "force_at_end_n",
        label: "Tension at the end",
        unit: MILLINEWTONS,
        meaning: "zero for a free end",
        number: |found| found.force_at_end,
        ..SpinlineMeasure::NUMBER
    },
    SpinlineMeasure {
        name: "birefringence",
        label: "Birefringence",
        meaning: "of the solid, by the stress-optical law",
        number: |found| found.birefringence,
        study: Some(Measure {
            name: "birefringence",
            column: "birefringence",
            label: "Birefringence",
            meaning: "birefringence of the filament by the stress-optical law; that of polypropylene is 3 to 5 times too low",
            figure: &figure("birefringence", "Birefringence of the filament", "birefringence"),
            ..Measure::NUMBER
        }),
        study_place: 10,
        ..SpinlineMeasure::NUMBER
    },
    SpinlineMeasure {
        name: "modulus_estimate_pa",
        label: "Young’s modulus, an estimate",
        unit: GIGAPASCALS,
        meaning: "from the birefringence; it can be wrong by a factor of two",
        number: |found| found.modulus_estimate,
        study: Some(Measure {
            name: "modulus_estimate",
            column: "modulus_estimate_pa",
            label: "Young’s modulus, an estimate",
            meaning: "Young's modulus to expect of the filament; it can be wrong by a factor of two, and is too low for polypropylene",
            unit: GIGAPASCALS,
            figure: &figure("modulus_estimate", "Estimate of Young’s modulus", "estimate of Young’s modulus"),
            ..Measure::NUMBER
        }),
        study_place: 11,
        ..SpinlineMeasure::NUMBER
    },
    SpinlineMeasure {
        name: "momentum_residual",
        label: "Balance of momentum",
        meaning: "by how much it fails over the whole line, as a share of the largest tension",
        number: |found| found.momentum_residual,
        is_residual: true,
        ..SpinlineMeasure::NUMBER
    },
    SpinlineMeasure {
        name: "energy_residual",
        label: "Balance of energy",
        meaning: "by how much it fails over the whole line, as a share of the heat that the air takes",
        number: |found| found.energy_residual,
        is_residual: true,
        ..SpinlineMeasure::NUMBER
    },
];

const MICROMETRES: Unit = Unit { shown: "µm", per_si: 1e6 };
const METRES_PER_SECOND: Unit = Unit { shown: "m/s", per_si: 1.0 };
const DECITEX: Unit = Unit { shown: "dtex", per_si: 1e7 };
const CELSIUS: Unit = Unit { shown: "°C", per_si: 1.0 };
const KELVIN: Unit = Unit { shown: "K", per_si: 1.0 };
const MEGAPASCALS: Unit = Unit { shown: "MPa", per_si: 1e-6 };
const GIGAPASCALS: Unit = Unit { shown: "GPa", per_si: 1e-9 };
const PER_SECOND: Unit = Unit { shown: "1/s", per_si: 1.0 };
const KELVIN_PER_SECOND: Unit = Unit { shown: "K/s", per_si: 1.0 };
