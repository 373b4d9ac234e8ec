//! The speeds of feed and belt: written, those of a flown case, or from the throughput and the basis weight in their place.

use super::read::{BASIS_WEIGHT, BELT_SPEED, ROUNDED, Reading, THROUGHPUT};
use crate::case::{Case, Note, Remark};
use crate::error::{Fault, Place};
use crate::layers::full_names::without_numbers;
use crate::layers::keys::WEB;
use crate::layers::{LaydownSource, LayerSpec, SAME, WebKey, WebSpec};
use crate::units::Dimension;
use std::path::Path;

impl Reading<'_> {
    /// Leaves out what stands in the file in place of a number that the flown cases are given from outside.
    pub(super) fn leave_to_case(&mut self, prefixes: &[String]) {
        let flies = |prefix: &&String| self.is_written(&format!("{prefix}laydown.case"));
        let flying: Vec<String> = prefixes.iter().filter(flies).cloned().collect();
        let of_cases =
            |key: &'static WebKey| key.relations.gives_case.iter().map(move |of_case| (key, *of_case));
        for (key, of_case) in WEB.rows.iter().flat_map(of_cases) {
            let is_changed = |changes: &super::super::Overrides<'_>| {
                changes.values.iter().any(|(name, _)| name.trim() == of_case)
            };
            if flying.is_empty() || !self.of_case.iter().any(is_changed) {
                continue;
            }
            for prefix in if key.relations.of_all_layers { prefixes } else { &flying } {
                let full = format!("{prefix}{}", key.name);
                match self.key_values.get(&full).map(|written_value| &written_value.place) {
                    Some(Place::Override(_)) => {
                        let fault = Fault::excludes(of_case, "either gives the other; set one of the two");
                        self.key_values.reject(&full, fault);
                    }
                    Some(_) => drop(self.key_values.remove(&full)),
                    None => {}
                }
            }
        }
    }

    /// The change to a flown case that makes its throughput the one that the web gives; none if it has that already.
    pub(super) fn change_throughput(
        &mut self,
        prefix: &str,
        case: &Case,
        path: &Path,
    ) -> Option<(String, String)> {
        let full = format!("{prefix}{THROUGHPUT}");
        let (wanted, own) = (self.key_values.number(&full)?, case.throughput()?);
        if (own / wanted - 1.0).abs() <= SAME {
            return None;
        }
        let (key, dimension, value, own_value) = match (&case.spinline, case.line) {
            (Some(_), _) => ("spinline.throughput", Dimension::MassFlow, wanted, own),
            (None, line) => {
                let own_speed = line.map_or(f64::NAN, |line| line.feed_speed);
                ("feed.speed", Dimension::Velocity, wanted / case.linear_density(), own_speed)
            }
        };
        self.note_change(&full, key, dimension, [value, own_value], path);
        Some((key.to_owned(), dimension.exact(value)))
    }

    /// Notes that a case is flown with another number than its own, unless the two differ by rounding.
    fn note_change(
        &mut self,
        full: &str,
        of_case: &'static str,
        dimension: Dimension,
        [used, own]: [f64; 2],
        path: &Path,
    ) {
        if (own / used - 1.0).abs() > ROUNDED {
            let [used, own] = [used, own].map(|value| dimension.pretty(value));
            let what = Remark::CaseChanged { of_case, used, own, case: path.display().to_string() };
            let note = Note { place: self.key_values.whole(), key: full.to_owned(), value: None, what };
            self.note(vec![self.key_values.placed(note)]);
        }
    }

    /// Takes the throughput of a layer in place of its feed speed, or compares the two.
    pub(super) fn settle_throughput(&mut self, web: &mut WebSpec, prefix: &str) {
        let full = format!("{prefix}{THROUGHPUT}");
        let (Some(throughput), Some(layer)) = (self.key_values.number(&full), web.layers.first_mut()) else {
            return;
        };
        let own = layer.linear_density() * layer.feed_speed;
        let speed = Dimension::Velocity.pretty(layer.feed_speed);
        let (of_speed, remedy) = match &layer.source {
            // It is flown with this throughput.
            LaydownSource::Case { .. } => {
                layer.throughput = Some(throughput);
                return;
            }
            LaydownSource::Surrogate(_) if layer.feed_speed.is_nan() => {
                layer.feed_speed = throughput / layer.linear_density();
                layer.throughput = Some(throughput);
                return;
            }
            LaydownSource::Surrogate(_) => {
                (format!("line.feed_speed = {speed}"), "or leave out one of the two speeds")
            }
            LaydownSource::Results { folder, .. } => (
                format!("feed.speed = {speed} of {}, with which the fibres were flown,", folder.display()),
                "or leave it out",
            ),
        };
        if (own / throughput - 1.0).abs() > ROUNDED {
            let own = Dimension::MassFlow.pretty(own);
            let titre = Dimension::LinearDensity.pretty(layer.linear_density());
            let message = format!("disagrees with {of_speed} and filaments of {titre}, which make {own}");
            self.key_values.reject(&full, Fault::new(message, format!("write {own}, {remedy}")));
        }
    }

    /// Gives every layer the speed of the belt on which all of them lie.
    pub(super) fn settle_belt(&mut self, prefixes: &[String], web: &mut WebSpec) {
        let weight = self.basis_weight(prefixes);
        let is_fixed = |(prefix, layer): (&String, &LayerSpec)| {
            self.is_written(&format!("{prefix}{BELT_SPEED}"))
                || matches!(layer.source, LaydownSource::Results { .. })
        };
        let fixed = prefixes.iter().zip(&web.layers).position(is_fixed);
        match (weight, fixed) {
            (Some(weight), None) => self.lay(weight, web),
            (Some(weight), Some(fixed)) => {
                self.settle_common_belt(prefixes, &mut web.layers);
                self.compare(weight, web, fixed);
            }
            (None, _) => self.settle_common_belt(prefixes, &mut web.layers),
        }
    }

    /// The basis weight that is written in one of the layers.
    fn basis_weight(&mut self, prefixes: &[String]) -> Option<f64> {
        let keys = prefixes.iter().map(|prefix| format!("{prefix}{BASIS_WEIGHT}"));
        let keys: Vec<String> = keys.filter(|key| self.is_written(key)).collect();
        let first = keys.first()?;
        self.basis_weight_key.clone_from(first);
        let weight = self.key_values.number(first);
        for key in &keys[1..] {
            if let (Some(weight), Some(other)) = (weight, self.key_values.number(key))
                && (other / weight - 1.0).abs() > SAME
            {
                let weight = Dimension::BasisWeight.pretty(weight);
                let fault = Fault::new(
                    format!("differs from {first} = {weight}, and it is the weight of all layers together"),
                    "write it in one layer and leave it out of the others",
                );
                self.key_values.reject(key, fault);
            }
        }
        weight
    }

    /// Makes the belt as fast as it takes to lay this basis weight; cases are flown above it.
    fn lay(&mut self, weight: f64, web: &mut WebSpec) {
        let (key, belt) = (self.basis_weight_key.clone(), web.belt_speed_for(weight));
        web.basis_weight = Some(weight);
        if belt.is_nan() || belt == 0.0 {
            // What is missing, or that nothing is laid, is reported elsewhere.
            web.layers.iter_mut().for_each(|layer| layer.belt_speed = f64::NAN);
            return;
        }
        let slowest = web.layers.iter().map(|layer| layer.feed_speed).fold(f64::INFINITY, f64::min);
        if belt > slowest {
            let [belt, feed] = [belt, slowest].map(|speed| Dimension::Velocity.pretty(speed));
            let message = format!(
                "takes a belt of {belt}, which is more than line.feed_speed = {feed} and would tear the fibre"
            );
            self.key_values.reject(&key, Fault::new(message, "lay more, or feed faster"));
            return;
        }
        for layer in &web.layers {
            if let LaydownSource::Case { path, .. } = &layer.source
                && (layer.belt_speed / belt - 1.0).abs() > SAME
            {
                self.note_change(&key, "belt.speed", Dimension::Velocity, [belt, layer.belt_speed], path);
            }
        }
        if let Err(fault) = web.set_belt_speed(belt) {
            self.key_values.reject(&key, fault);
        }
    }

    /// Compares the basis weight with that on a belt whose speed is given too.
    ///
    /// * `fixed` – the layer that gives it
    fn compare(&mut self, weight: f64, web: &WebSpec, fixed: usize) {
        let (layer, key) = (&web.layers[fixed], self.basis_weight_key.clone());
        let own = web.mass_flow() / layer.belt_speed;
        if (own / weight - 1.0).abs() > ROUNDED {
            let [own, belt] =
                [Dimension::BasisWeight.pretty(own), Dimension::Velocity.pretty(layer.belt_speed)];
            let (of_belt, remedy) = match &layer.source {
                LaydownSource::Results { folder, .. } => (
                    format!("belt.speed = {belt} of {}, with which the fibres were flown", folder.display()),
                    "or leave it out",
                ),
                _ => (format!("line.belt_speed = {belt}"), "or leave out one of the two"),
            };
            let message = format!("disagrees with {of_belt}: on this belt the filaments lay {own}");
            self.key_values.reject(&key, Fault::new(message, format!("write {own}, {remedy}")));
        }
    }

    /// Gives every layer the speed of the belt, which is written in one layer or is that of a flown case.
    fn settle_common_belt(&mut self, prefixes: &[String], layers: &mut [LayerSpec]) {
        let keys: Vec<String> = prefixes.iter().map(|prefix| format!("{prefix}{BELT_SPEED}")).collect();
        // Flown fibres come first, because they would lie otherwise on another belt.
        let known = (0..layers.len()).filter(|&layer| !layers[layer].belt_speed.is_nan());
        let Some(first) = known.min_by_key(|&layer| layers[layer].source.case().is_none()) else {
            let is_there = |key: &String| self.is_written(key) || self.key_values.is_excused(key);
            let is_replaced = !self.basis_weight_key.is_empty();
            if let Some(key) = keys.first().filter(|_| !is_replaced && !keys.iter().any(is_there)) {
                let table = without_numbers(key.trim_end_matches(".belt_speed"));
                self.key_values.reject(key, Fault::missing(&table, "belt_speed = \"3 m/s\""));
            }
            return;
        };
        let LayerSpec { belt_speed: belt, source, .. } = layers[first].clone();
        for ((layer, prefix), key) in layers.iter_mut().zip(prefixes).zip(&keys) {
            let is_written = self.is_written(key);
            if layer.belt_speed.is_nan() && !is_written {
                layer.belt_speed = belt;
            }
            let [own, feed, first_belt] =
                [layer.belt_speed, layer.feed_speed, belt].map(|speed| Dimension::Velocity.pretty(speed));
            if (layer.belt_speed / belt - 1.0).abs() > SAME {
                let whose =
                    if is_written { String::new() } else { format!("has belt.speed = {own}, which ") };
                let message = format!(
                    "{whose}differs from the belt speed of layer {}, {first_belt}, and all layers lie on one belt",
                    first + 1
                );
                let remedy = match source.case() {
                    _ if !is_written => "give all cases the same belt.speed".to_owned(),
                    Some(_) => {
                        format!("leave it out here, and set belt.speed in {}", source.path().display())
                    }
                    None => "write it in one layer and leave it out of the others".to_owned(),
                };
                let ways = ["case", "results"].map(|way| format!("{prefix}laydown.{way}"));
                let way = ways.iter().find(|way| self.is_written(way)).filter(|_| !is_written);
                self.key_values.reject(way.unwrap_or(key), Fault::new(message, remedy));
            }
            if layer.belt_speed > layer.feed_speed {
                let message = format!("is more than line.feed_speed = {feed}, which would tear the fibre");
                self.refuse(key, own, Fault::new(message, "slow the belt, or feed faster"));
            }
        }
    }
}
