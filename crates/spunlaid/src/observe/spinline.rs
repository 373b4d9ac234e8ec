//! What is measured of a spinline. Each measure is declared once: its name, unit, meaning, figure, and how it is found.

use super::{Figure, MILLIMETRES, MILLINEWTONS, Measure, RATIO, Unit};
use crate::spinline::Solution;

/// A measure of a spinline.
#[derive(Debug)]
pub struct SpinlineMeasure {
    /// What it is.
    pub measure: Measure,
    /// Its value.
    pub number: fn(&Solution) -> f64,
}

/// The measures of a spinline, in the order of the tables.
pub const OF_SPINLINES: &[SpinlineMeasure] = &[
    SpinlineMeasure {
        measure: Measure {
            name: "final_diameter",
            column: "final_diameter_m",
            label: "Diameter of the filament",
            meaning: "diameter of the cold filament",
            unit: MICROMETRES,
            figure: &DIAMETER,
            series: "",
            ..Measure::NUMBER
        },
        number: |found| found.final_diameter,
    },
    SpinlineMeasure {
        measure: Measure {
            name: "final_speed",
            column: "final_speed_m_s",
            label: "Speed at the end",
            meaning: "speed of the filament at the end of the spinline",
            unit: SPEED_UNIT,
            figure: &SPEED,
            series: "",
            ..Measure::NUMBER
        },
        number: |found| found.final_speed,
    },
    SpinlineMeasure {
        measure: Measure {
            name: "linear_density",
            column: "linear_density_kg_m",
            label: "Titre",
            meaning: "mass per length of the filament",
            unit: DTEX,
            figure: &TITRE,
            series: "",
            ..Measure::NUMBER
        },
        number: |found| found.linear_density,
    },
    SpinlineMeasure {
        measure: Measure {
            name: "draw_ratio",
            column: "draw_ratio",
            label: "Draw ratio",
            meaning: "speed at the end over the speed of the melt in the hole",
            unit: RATIO,
            figure: &DRAW,
            series: "",
            ..Measure::NUMBER
        },
        number: Solution::draw_ratio,
    },
    SpinlineMeasure {
        measure: Measure {
            name: "freezing_distance",
            column: "freezing_distance_m",
            label: "Freezing point, distance from the die",
            meaning: "distance from the die at which the thread is solid",
            unit: MILLIMETRES,
            figure: &PLACE,
            series: "",
            ..Measure::NUMBER
        },
        number: |found| found.freezing.distance,
    },
    SpinlineMeasure {
        measure: Measure {
            name: "freezing_temperature",
            column: "freezing_temperature_k",
            label: "Freezing point, temperature",
            meaning: "temperature of the thread where it becomes solid",
            unit: KELVIN,
            figure: &FREEZING,
            series: "",
            ..Measure::NUMBER
        },
        number: |found| found.freezing.temperature,
    },
    SpinlineMeasure {
        measure: Measure {
            name: "freezing_stress",
            column: "freezing_stress_pa",
            label: "Freezing point, stress",
            meaning: "stress of the thread where it becomes solid",
            unit: MEGAPASCALS,
            figure: &STRESS,
            series: "",
            ..Measure::NUMBER
        },
        number: |found| found.freezing.stress,
    },
    SpinlineMeasure {
        measure: Measure {
            name: "force_at_die",
            column: "force_at_die_n",
            label: "Tension at the die",
            meaning: "tension of the thread at the die",
            unit: MILLINEWTONS,
            figure: &FORCE,
            series: "",
            ..Measure::NUMBER
        },
        number: |found| found.force_at_die,
    },
    SpinlineMeasure {
        measure: Measure {
            name: "largest_strain_rate",
            column: "largest_strain_rate_per_s",
            label: "Largest strain rate",
            meaning: "largest rate at which the thread is stretched",
            unit: PER_SECOND,
            figure: &STRAIN,
            series: "",
            ..Measure::NUMBER
        },
        number: |found| found.largest_strain_rate,
    },
    SpinlineMeasure {
        measure: Measure {
            name: "cooling_rate",
            column: "cooling_rate_k_s",
            label: "Cooling rate at the freezing point",
            meaning: "how fast the thread cools where it becomes solid",
            unit: KELVIN_PER_SECOND,
            figure: &COOLING,
            series: "",
            ..Measure::NUMBER
        },
        number: |found| found.freezing.cooling_rate,
    },
    SpinlineMeasure {
        measure: Measure {
            name: "birefringence",
            column: "birefringence",
            label: "Birefringence",
            meaning: "birefringence of the filament by the stress-optical law",
            unit: RATIO,
            figure: &BIREFRINGENCE,
            series: "",
            ..Measure::NUMBER
        },
        number: |found| found.birefringence,
    },
    SpinlineMeasure {
        measure: Measure {
            name: "modulus_estimate",
            column: "modulus_estimate_pa",
            label: "Young’s modulus, an estimate",
            meaning: "Young's modulus to expect of the filament; it can be wrong by a factor of two",
            unit: GIGAPASCALS,
            figure: &MODULUS,
            series: "",
            ..Measure::NUMBER
        },
        number: |found| found.modulus_estimate,
    },
];

const MICROMETRES: Unit = Unit { shown: "µm", per_si: 1e6 };
const SPEED_UNIT: Unit = Unit { shown: "m/s", per_si: 1.0 };
const DTEX: Unit = Unit { shown: "dtex", per_si: 1e7 };
const KELVIN: Unit = Unit { shown: "K", per_si: 1.0 };
const MEGAPASCALS: Unit = Unit { shown: "MPa", per_si: 1e-6 };
const GIGAPASCALS: Unit = Unit { shown: "GPa", per_si: 1e-9 };
const PER_SECOND: Unit = Unit { shown: "1/s", per_si: 1.0 };
const KELVIN_PER_SECOND: Unit = Unit { shown: "K/s", per_si: 1.0 };

const fn figure(name: &'static str, title: &'static str, words: &'static str) -> Figure {
    Figure { name, title, words, logarithmic: false, from_zero: true, caption: "" }
}

const DIAMETER: Figure = figure("final_diameter", "Diameter of the filament", "diameter of the filament");
const SPEED: Figure = figure("final_speed", "Speed at the end of the spinline", "speed of the filament");
const TITRE: Figure = figure("linear_density", "Titre of the filament", "titre");
const DRAW: Figure = figure("draw_ratio", "Draw ratio", "draw ratio");
const PLACE: Figure = figure(
    "freezing_distance",
    "Distance of the freezing point from the die",
    "distance of the freezing point",
);
const FREEZING: Figure =
    figure("freezing_temperature", "Temperature of the freezing point", "temperature of the freezing point");
const STRESS: Figure =
    figure("freezing_stress", "Stress at the freezing point", "stress at the freezing point");
const FORCE: Figure = figure("force_at_die", "Tension at the die", "tension at the die");
const STRAIN: Figure = figure("largest_strain_rate", "Largest strain rate", "largest strain rate");
const COOLING: Figure = figure("cooling_rate", "Cooling rate at the freezing point", "cooling rate");
const BIREFRINGENCE: Figure = figure("birefringence", "Birefringence of the filament", "birefringence");
const MODULUS: Figure =
    figure("modulus_estimate", "Estimate of Young’s modulus", "estimate of Young’s modulus");
