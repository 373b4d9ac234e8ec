//! The keys of the tables `[layer]`, `[fibre]` and `[laydown]`.

use super::super::access::{
    Access, WebKey, filament, filament_mut, given, is_flown, layer, layer_mut, of_surrogate,
};
use super::positive;
use crate::layers::{LaydownSource, WebSpec};
use spunlaid_fibre::FilamentSize;
use spunlaid_fibre::case::keys::row::{at, key, number};
use spunlaid_fibre::case::keys::{Condition, Kind, row_of};
use spunlaid_ground::{Dimension, Fault};

/// In the order of the file.
pub(super) const KEYS: &[WebKey] = &[
    row_of("fibre.diameter")
        .of_input(given!(size, FilamentSize::Diameter))
        .derived(is_flown)
        .required("18 µm"),
    row_of("fibre.density")
        .of_input(at!(filament, filament_mut, density))
        .derived(is_flown)
        .required("910 kg/m³"),
    row_of("fibre.linear_density")
        .of_input(given!(size, FilamentSize::LinearDensity))
        .in_other_words(|web| Some(filament(web)?.linear_density().into())),
];

/// In the order of the file.
pub(super) const LAYER: &[WebKey] = &[key("layer.name", Kind::Text("first beam"))
    .access(at!(layer, layer_mut, name))
    .follows("the layer's number")
    .meaning(
        "Name of a layer. Each beam is a `[[layer]]` with its own `[layer.line]`, `[layer.laydown]` \
         and `[layer.fibre]`; the basis weights add up. Tables of a filament above the layers hold \
         for all.",
    )];

/// The numbers of a surrogate.
pub const NUMBERS: [&str; 3] = ["laydown.sigma_md", "laydown.sigma_cd", "laydown.noise"];
/// Filaments of which these numbers are known, so that none are simulated.
const KNOWN: &Condition<WebSpec> = &Condition {
    words: "without a case",
    holds: |web| matches!(layer(web).map(|layer| &layer.source), Some(LaydownSource::Surrogate(_))),
};
/// Where the numbers of a surrogate come from if they are left out.
const IDENTIFIED: &str = "found from the fibre that the case lays";

/// Why a layer names one source of its fibres.
pub const ONE_SOURCE: &str =
    "keep either the filament to be simulated or the numbers sigma_md, sigma_cd and noise";

/// In the order of the file.
pub(super) const LAYDOWN: &[WebKey] = &[
    key("laydown.case", Kind::Text("spunbond.toml"))
        // What stands there is written into the file of the web.
        .reported(|_: &WebSpec| None)
        .follows("the tables of a case in this file, or the three numbers")
        .meaning(
            "Path of the case of a fed fibre, relative to this file. Keys that this file contains too, such as \
             `air.velocity`, replace those of the case.",
        ),
    positive("laydown.sigma_md", Dimension::Length, (1e-5, 1.0))
        .access(of_surrogate!(sigma_md))
        .needed_if(KNOWN, "18.4 mm")
        .follows(IDENTIFIED)
        .meaning(
            "Standard deviation of a laid filament in machine direction: σ₁ of the surrogate. The CV of such a web, \
             without the correlation of neighbours, is a lower bound.",
        )
        .label("Standard deviation in machine direction"),
    positive("laydown.sigma_cd", Dimension::Length, (1e-5, 1.0))
        .access(of_surrogate!(sigma_cd))
        .needed_if(KNOWN, "18.3 mm")
        .follows(IDENTIFIED)
        .meaning("Standard deviation of a laid filament in cross direction: σ₂ of the surrogate.")
        .label("Standard deviation in cross direction"),
    positive("laydown.noise", Dimension::Noise, (0.1, 1e4))
        .access(of_surrogate!(noise))
        .needed_if(KNOWN, "12.4 m^-0.5")
        .follows(IDENTIFIED)
        .meaning("Strength A of the noise in the direction of the surrogate.")
        .label("Noise of the direction *A*"),
];
