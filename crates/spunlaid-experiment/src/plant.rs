//! The numbers that a plant uses for its line.

use spunlaid_ground::units::rounded;
use spunlaid_simulation::{LayerSpec, SAME, WebSpec};

/// A number of a line in the unit in which a plant says it.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantNumber {
    /// A name that no other number of the line has: `titre`, or `titre.2` where the second layer has another one.
    pub name: String,
    /// What it is called.
    pub label: String,
    /// The number [SI].
    pub value: f64,
    /// With four digits and its unit: `0.5 g/min`.
    pub text: String,
}

/// A number of a web or of one of its layers.
struct Row {
    name: &'static str,
    label: &'static str,
    /// The unit, and its size [SI].
    unit: (&'static str, f64),
    /// The number [SI], if the web or the layer has it.
    of: fn(&WebSpec, &LayerSpec) -> Option<f64>,
}

const fn row(
    name: &'static str,
    label: &'static str,
    unit: (&'static str, f64),
    of: fn(&WebSpec, &LayerSpec) -> Option<f64>,
) -> Row {
    Row { name, label, unit, of }
}

const METRES_PER_MINUTE: (&str, f64) = ("m/min", 1.0 / 60.0);

/// From the hole to the belt.
const ROWS: [Row; 9] = [
    row("throughput", "throughput per hole", ("g/min", 1e-3 / 60.0), |_, layer| {
        Some(layer.fed_filament().throughput())
    }),
    row("titre", "titre", ("dtex", 1e-7), |_, layer| Some(layer.fed_filament().linear_density())),
    row("spinning_speed", "spinning speed", METRES_PER_MINUTE, |_, layer| {
        Some(layer.fed_filament().feed_speed())
    }),
    row("cabin_pressure", "cabin pressure", ("Pa", 1.0), |_, layer| layer.source.case()?.air.cabin_pressure),
    row("air_at_slot", "air at the slot", ("m/s", 1.0), |_, layer| {
        layer.source.case()?.air.velocity_at_slot()
    }),
    row("filament_to_air", "filament to its fastest air", ("", 1.0), |_, layer| {
        Some(layer.fed_filament().feed_speed() / layer.source.case()?.fastest_air()?)
    }),
    row("mass_flow", "per metre of width", ("kg/h", 1.0 / 3600.0), |web, _| Some(web.mass_flow())),
    row("belt_speed", "belt speed", METRES_PER_MINUTE, |web, _| Some(web.belt_speed)),
    row("basis_weight", "basis weight", ("g/m²", 1e-3), |web, _| Some(web.weight())),
];

/// The numbers of a line, from the hole to the belt. What layers have in common is said once.
pub fn plant_numbers(spec: &WebSpec) -> Vec<PlantNumber> {
    ROWS.iter().flat_map(|row| row.numbers(spec)).collect()
}

impl Row {
    fn numbers(&self, spec: &WebSpec) -> Vec<PlantNumber> {
        let values: Vec<Option<f64>> = spec.layers.iter().map(|layer| (self.of)(spec, layer)).collect();
        let is_same = |pair: &[Option<f64>]| match pair {
            [Some(a), Some(b)] => (a / b - 1.0).abs() <= SAME,
            _ => pair.iter().all(Option::is_none),
        };
        let is_common = values.windows(2).all(is_same);
        let numbers = (1..).zip(values).take(if is_common { 1 } else { usize::MAX });
        let named = |(layer, value): (usize, Option<f64>)| {
            let [name, label] = match is_common {
                true => [self.name, self.label].map(ToOwned::to_owned),
                false => [format!("{}.{layer}", self.name), format!("{}, layer {layer}", self.label)],
            };
            let (value, (unit, size)) = (value?, self.unit);
            let digits = rounded(value / size, 3);
            let text = if unit.is_empty() { digits.to_string() } else { format!("{digits} {unit}") };
            Some(PlantNumber { name, label, value, text })
        };
        numbers.filter_map(named).collect()
    }
}
