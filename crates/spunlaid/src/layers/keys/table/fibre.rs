//! The keys of the table `[fibre]`.

use super::super::access::{Access, WebKey, diameter, is_flown, layer, layer_mut};
use super::{EITHER, positive};
use crate::case::keys::Value;
use crate::case::keys::row::{at, number};
use crate::units::Dimension;

/// In the order of the file.
pub(super) const KEYS: &[WebKey] = &[
    positive("fibre.diameter", Dimension::Length)
        .access(Access {
            get: |web| layer(web).filter(|layer| layer.titre.is_none()).map(|layer| layer.diameter.into()),
            set: |web, value| {
                let layer = layer_mut(web)?;
                (layer.diameter, layer.titre) = (number(value)?, None);
                Ok(())
            },
        })
        .derived(is_flown)
        .required("18 µm")
        .meaning(
            "Diameter of the round filaments. With `laydown.case` it is that of the case, and \
             where a filament flies it is the key of its case.",
        )
        .label("Fibre diameter *d*"),
    positive("fibre.density", Dimension::Density)
        .access(at!(layer, layer_mut, density))
        .derived(is_flown)
        .required("910 kg/m³")
        .meaning("Density of the polymer. With `laydown.case` it is that of the case.")
        .label("Fibre density"),
    positive("fibre.linear_density", Dimension::LinearDensity)
        .access(Access {
            get: |web| layer(web)?.titre.map(Value::Number),
            set: |web, value| {
                let (titre, layer) = (number(value)?, layer_mut(web)?);
                (layer.diameter, layer.titre) = (diameter(titre, layer.density), Some(titre));
                Ok(())
            },
        })
        .alternative_to(&["fibre.diameter"], EITHER)
        .in_other_words(|web| Some(layer(web)?.linear_density().into()))
        .follows("diameter and density give it")
        .meaning(
            "Mass per length of a filament, which may be written instead of `fibre.diameter`; the diameter \
             follows with the density.",
        )
        .label("Linear density"),
];
