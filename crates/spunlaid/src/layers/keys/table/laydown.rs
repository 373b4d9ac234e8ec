//! The keys of the table `[laydown]`.

use super::super::access::{WebKey, flown, layer, layer_mut, of_surrogate};
use super::positive;
use crate::case::keys::row::{key, number};
use crate::case::keys::{Condition, Kind};
use crate::layers::{LaydownSource, WebSpec};
use crate::surrogate::Surrogate;
use crate::units::Dimension;

/// The numbers of a surrogate.
pub(crate) const NUMBERS: [&str; 3] = ["laydown.sigma_md", "laydown.sigma_cd", "laydown.noise"];
/// Filaments of which these numbers are known, so that none are flown.
const KNOWN: &Condition<WebSpec> = &Condition {
    words: "without a case",
    holds: |web| matches!(layer(web).map(|layer| &layer.source), Some(LaydownSource::Surrogate(_))),
};
/// Where the numbers of a surrogate come from if they are left out.
const IDENTIFIED: &str = "identified in what the fibres of the case have laid";

/// Why a layer names one source of its fibres.
pub(crate) const ONE_SOURCE: &str =
    "keep one of a filament to fly and the numbers sigma_md, sigma_cd and noise";

/// In the order of the file.
pub(super) const KEYS: &[WebKey] = &[
    key("laydown.case", Kind::Text("spunbond.toml"))
        // What stands there is written into the file of the web.
        .told(|_: &WebSpec| None)
        .follows("the tables of a case in this file, or the three numbers")
        .meaning(
            "Path of the case of a fed fibre, relative to this file, which several webs may share. It is \
             flown, and the web is laid of what it lays. Keys of it that stand in this file too, as \
             `air.velocity`, take the place of those there.",
        ),
    positive("laydown.sigma_md", Dimension::Length)
        .access(of_surrogate!(sigma_md))
        .needed_if(KNOWN, "18.4 mm")
        .follows(IDENTIFIED)
        .meaning(
            "Spread of a laid filament in machine direction: the σ₁ of the surrogate. Known numbers do not \
             say how neighbours come down together, so the CV of such a web is a lower bound; a case in place \
             of them (`laydown.case`) is flown in one air, as in a line.",
        )
        .label("Spread in machine direction")
        .usual(1e-5, 1.0),
    positive("laydown.sigma_cd", Dimension::Length)
        .access(of_surrogate!(sigma_cd))
        .needed_if(KNOWN, "18.3 mm")
        .follows(IDENTIFIED)
        .meaning("Spread of a laid filament in cross direction: the σ₂ of the surrogate.")
        .label("Spread in cross direction")
        .usual(1e-5, 1.0),
    positive("laydown.noise", Dimension::Noise)
        .access(of_surrogate!(noise))
        .needed_if(KNOWN, "12.4 m^-0.5")
        .follows(IDENTIFIED)
        .meaning("Strength A of the noise in the direction of the surrogate.")
        .label("Noise of the direction *A*")
        .usual(0.1, 1e4),
];
