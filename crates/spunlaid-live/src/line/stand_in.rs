//! Stands in for `spunlaid::experiment::plant_numbers` until it is there.

use spunlaid::ground::Dimension;
use spunlaid::input::WebSpec;

#[derive(Clone, Debug)]
pub struct PlantNumber { pub name: String, pub label: String, pub value: f64, pub text: String }
pub fn plant_numbers(spec: &WebSpec) -> Vec<PlantNumber> {
    let one = |name: &str, value: f64, text: String| PlantNumber { name: name.to_owned(), label: name.replace('_', " "), value, text };
    let (belt, weight) = (spec.belt_speed(), spec.weight());
    vec![one("belt_speed", belt, Dimension::Velocity.pretty_to(belt, 3)), one("basis_weight", weight, format!("{:.3} g/m²", 1e3 * weight))]
}
