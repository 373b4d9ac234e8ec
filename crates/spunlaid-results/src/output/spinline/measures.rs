//! The measures of a solved spinline. Each is declared once: JSON, terminal, report and Python follow.

use spunlaid::observe::{MILLIMETRES, MILLINEWTONS, Unit};
use spunlaid::spinline::{Solution, ZERO_CELSIUS};

/// A measure of a solved spinline.
#[derive(Debug)]
pub struct SpinMeasure {
    /// Name in `summary.json`, with its unit; a point separates the name of a group: `freezing.distance_m`.
    pub name: &'static str,
    /// Its label on the terminal and in the report.
    pub label: &'static str,
    /// The unit in which it is shown there.
    pub unit: Unit,
    /// What it means.
    pub meaning: &'static str,
    /// Its value, in the unit of its name.
    pub value: fn(&Solution) -> f64,
}

/// No unit.
const PLAIN: Unit = Unit { shown: "", per_si: 1.0 };
const MICROMETRES: Unit = Unit { shown: "µm", per_si: 1e6 };
const DECITEX: Unit = Unit { shown: "dtex", per_si: 1e7 };
const METRES_PER_SECOND: Unit = Unit { shown: "m/s", per_si: 1.0 };
const CELSIUS: Unit = Unit { shown: "°C", per_si: 1.0 };
const MEGAPASCALS: Unit = Unit { shown: "MPa", per_si: 1e-6 };
const GIGAPASCALS: Unit = Unit { shown: "GPa", per_si: 1e-9 };
const KELVIN_PER_SECOND: Unit = Unit { shown: "K/s", per_si: 1.0 };
const PER_SECOND: Unit = Unit { shown: "1/s", per_si: 1.0 };

/// The measures, in the order of tables.
pub const MEASURES: &[SpinMeasure] = &[
    SpinMeasure {
        name: "final_diameter_m",
        label: "Diameter, cold",
        unit: MICROMETRES,
        meaning: "of the solid filament at the end of the line, with the density of the solid",
        value: |solution| solution.final_diameter,
    },
    SpinMeasure {
        name: "linear_density_kg_m",
        label: "Line density",
        unit: DECITEX,
        meaning: "mass per length of the filament: throughput over speed",
        value: |solution| solution.linear_density,
    },
    SpinMeasure {
        name: "final_speed_m_s",
        label: "Speed",
        unit: METRES_PER_SECOND,
        meaning: "of the filament at the end of the line",
        value: |solution| solution.final_speed,
    },
    SpinMeasure {
        name: "draw_ratio",
        label: "Draw ratio",
        unit: PLAIN,
        meaning: "speed at the end over the speed at the die",
        value: Solution::draw_ratio,
    },
    SpinMeasure {
        name: "freezing.distance_m",
        label: "Freezing point, below the die",
        unit: MILLIMETRES,
        meaning: "from here on the filament is solid and keeps its speed",
        value: |solution| solution.freezing.distance,
    },
    SpinMeasure {
        name: "freezing.temperature_c",
        label: "Temperature there",
        unit: CELSIUS,
        meaning: "of the thread at the freezing point",
        value: |solution| solution.freezing.temperature - ZERO_CELSIUS,
    },
    SpinMeasure {
        name: "freezing.diameter_m",
        label: "Diameter there",
        unit: MICROMETRES,
        meaning: "of the thread at the freezing point; it shrinks as it cools further",
        value: |solution| solution.freezing.diameter,
    },
    SpinMeasure {
        name: "freezing.stress_pa",
        label: "Stress there",
        unit: MEGAPASCALS,
        meaning: "tensile stress at the freezing point, which orients the polymer",
        value: |solution| solution.freezing.stress,
    },
    SpinMeasure {
        name: "freezing.cooling_rate_k_s",
        label: "Cooling rate there",
        unit: KELVIN_PER_SECOND,
        meaning: "how fast the thread cools at the freezing point",
        value: |solution| solution.freezing.cooling_rate,
    },
    SpinMeasure {
        name: "largest_strain_rate_per_s",
        label: "Largest strain rate",
        unit: PER_SECOND,
        meaning: "where the thread is stretched the fastest",
        value: |solution| solution.largest_strain_rate,
    },
    SpinMeasure {
        name: "largest_strain_rate_at_m",
        label: "Its place, below the die",
        unit: MILLIMETRES,
        meaning: "distance of the largest strain rate from the die",
        value: |solution| solution.largest_strain_rate_at,
    },
    SpinMeasure {
        name: "force_at_die_n",
        label: "Tension at the die",
        unit: MILLINEWTONS,
        meaning: "with the part of the surface tension",
        value: |solution| solution.force_at_die,
    },
    SpinMeasure {
        name: "force_at_end_n",
        label: "Tension at the end",
        unit: MILLINEWTONS,
        meaning: "zero for a free end",
        value: |solution| solution.force_at_end,
    },
    SpinMeasure {
        name: "birefringence",
        label: "Birefringence",
        unit: PLAIN,
        meaning: "of the solid, by the stress-optical law; too low for polypropylene, whose crystals orient more than the melt",
        value: |solution| solution.birefringence,
    },
    SpinMeasure {
        name: "modulus_estimate_pa",
        label: "Young’s modulus, an estimate",
        unit: GIGAPASCALS,
        meaning: "from the birefringence; it can be wrong by a factor of two",
        value: |solution| solution.modulus_estimate,
    },
    SpinMeasure {
        name: "momentum_residual",
        label: "Balance of momentum",
        unit: PLAIN,
        meaning: "by how much it fails over the whole line, as a share of the largest tension",
        value: |solution| solution.momentum_residual,
    },
    SpinMeasure {
        name: "energy_residual",
        label: "Balance of energy",
        unit: PLAIN,
        meaning: "by how much it fails over the whole line, as a share of the heat that the air takes",
        value: |solution| solution.energy_residual,
    },
];

impl SpinMeasure {
    /// Its value in the unit in which it is shown, as text.
    pub fn shown(&self, solution: &Solution) -> String {
        let value = (self.value)(solution) * self.unit.per_si;
        let residual = self.name.ends_with("_residual");
        crate::numbers::number_to(value, if residual { 1 } else { 4 })
    }
}
