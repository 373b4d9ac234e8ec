//! What tells how the filaments of a layer lie.

use super::super::written_values::WrittenValue;
use super::filament::Filament;
use super::flies_none;
use super::read::{CASE, Reading};
use crate::case::keys::{self, Value};
use crate::error::{Fault, Place};
use crate::layers::LayerSpec;
use crate::layers::keys::{NUMBERS, OF_FILAMENT, ONE_SOURCE};
use std::path::PathBuf;

/// What tells how the filaments of a layer lie.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// A filament is flown.
    Fly,
    /// The numbers of a surrogate.
    Numbers,
    /// It is not known, because of a problem that is noted.
    Unknown,
}

/// A layer before its filament is spun and flown.
pub(super) struct Layer {
    pub(super) spec: LayerSpec,
    pub(super) way: Way,
    /// Its filament, if it has to be flown.
    pub(super) filament: Option<Filament>,
    /// The throughput of its holes, if the filament comes from a die [kg/s].
    pub(super) spun: Option<f64>,
}

impl Reading<'_> {
    /// What tells how the filaments of a layer lie.
    pub(super) fn way(&mut self, prefix: &str) -> Way {
        let is_written = |name: &&&str| self.is_written(&format!("{prefix}{name}"));
        let numbers = NUMBERS.iter().find(is_written);
        let ways: Vec<&'static str> =
            [&CASE].into_iter().chain(numbers).filter(is_written).copied().collect();
        let own = self.first_of_flights(prefix);
        let (way, other) = match ways[..] {
            [] if own.is_some() || self.first_of_flights("").is_some() => return Way::Fly,
            [CASE] => return Way::Fly,
            [] if self.key_values.is_excused(&format!("{prefix}laydown.")) => return Way::Unknown,
            [] => {
                let fault = Fault::new(
                    "says nothing of how the fibres lie",
                    "write [feed], [belt], [air] and [run] for a filament to fly, or in [laydown] case = \
                    \"spunbond.toml\" (it stands in that file), or sigma_md, sigma_cd and noise",
                );
                self.key_values.reject(&format!("{prefix}laydown"), fault);
                return Way::Unknown;
            }
            // They are still to be set.
            [number] => (Way::Numbers, number),
            [other, ref more @ ..] => {
                for way in more {
                    self.key_values.reject(&format!("{prefix}{way}"), Fault::excludes(other, ONE_SOURCE));
                }
                return Way::Unknown;
            }
        };
        if let Some((key, written_value)) = own {
            let is_set = matches!(written_value.place, Place::Override(_));
            let fault = match is_set {
                true => Fault::new(flies_none(), "leave it out"),
                false => Fault::excludes(&format!("{prefix}{other}"), ONE_SOURCE),
            };
            self.key_values.reject(&key, fault);
        }
        way
    }

    /// The first written key of a table that only a filament has which flies: not that of its size.
    fn first_of_flights(&self, prefix: &str) -> Option<(String, WrittenValue)> {
        let is_of_flight = |full: &str| {
            let name = full.strip_prefix(prefix).filter(|name| keys::find(name).is_some())?;
            let table = name.split('.').next()?;
            (OF_FILAMENT.contains(&table) && table != "fibre").then_some(())
        };
        let found = self.key_values.all().filter(|(full, _)| is_of_flight(full).is_some());
        let first = found.min_by(|a, b| a.1.place.cmp(&b.1.place))?;
        Some((first.0.to_owned(), first.1.clone()))
    }

    /// The path that a key names: of the file, relative to its folder.
    pub(super) fn path(&self, key: &str) -> Option<PathBuf> {
        let written_value = self.key_values.get(key)?;
        let Some(Value::Text(named)) = &written_value.value else { return None };
        Some(match &written_value.place {
            Place::Override(_) => PathBuf::from(named),
            _ => self.file.parent().map_or_else(|| PathBuf::from(named), |folder| folder.join(named)),
        })
    }
}
