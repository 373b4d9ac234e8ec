//! Checks layers together: with each other, and with the sheet on which they lie.

use super::read::{BELT_SPEED, Reading, SAME};
use crate::air::Lateral;
use crate::case::{Note, Remark};
use crate::error::{Fault, Place};
use crate::layers::keys::{METHODS, WEB, without_numbers};
use crate::layers::{LaydownSource, LayerSpec, WebKey, WebSpec, too_small};
use crate::units::Dimension;
use crate::web::{Edges, Filaments, Row, Sheet};
use std::collections::BTreeMap;
use std::path::Path;

impl Reading<'_> {
    /// Refuses two layers of one name.
    pub(super) fn check_names(&mut self, prefixes: &[String]) {
        let mut seen: BTreeMap<String, usize> = BTreeMap::new();
        for (i, prefix) in prefixes.iter().enumerate() {
            let key = format!("{prefix}name");
            let Some(name) = self.written.text(&key) else { continue };
            match seen.get(&name) {
                Some(other) => {
                    let fault = Fault::new(
                        format!("is also the name of layer {}", other + 1),
                        "give each layer a name of its own",
                    );
                    self.written.reject(&key, fault);
                }
                None => drop(seen.insert(name, i)),
            }
        }
    }

    /// Gives every layer the speed of the belt, which is written in one layer or is that of a flown case.
    pub(super) fn settle_belt(&mut self, prefixes: &[String], layers: &mut [LayerSpec]) {
        let keys: Vec<String> = prefixes.iter().map(|prefix| format!("{prefix}{BELT_SPEED}")).collect();
        // Flown fibres come first, because they would lie otherwise on another belt.
        let known = (0..layers.len()).filter(|&layer| !layers[layer].belt_speed.is_nan());
        let Some(first) = known.min_by_key(|&layer| layers[layer].source.case().is_none()) else {
            let is_there = |key: &String| self.is_written(key) || self.written.is_excused(key);
            if let Some(key) = keys.first().filter(|_| !keys.iter().any(is_there)) {
                let table = without_numbers(key.trim_end_matches(".belt_speed"));
                self.written.reject(key, Fault::missing(&table, "belt_speed = \"3 m/s\""));
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
                self.written.reject(way.unwrap_or(key), Fault::new(message, remedy));
            }
            if layer.belt_speed > layer.feed_speed {
                let message = format!("is more than line.feed_speed = {feed}, which would tear the fibre");
                self.refuse(key, own, Fault::new(message, "slow the belt, or feed faster"));
            }
        }
    }

    /// Refuses layers that cannot be flown in one air.
    pub(super) fn check_shared_air(&mut self, prefixes: &[String], layers: &[LayerSpec]) {
        for (prefix, layer) in prefixes.iter().zip(layers) {
            let laydown = format!("{prefix}laydown");
            let fault = match &layer.source {
                LaydownSource::Case { case, path } if case.air.records.is_empty() => {
                    if case.air.lateral == Lateral::Uniform {
                        self.note(vec![uniform_air(path)]);
                    }
                    continue;
                }
                LaydownSource::Case { path, .. } => Fault::new(
                    format!(
                        "flies all filaments in one air, and that of {} follows a recorded wind (air.record), which says nothing of how \
                         the air differs from place to place across the flow",
                        path.display()
                    ),
                    "give the case the spectrum of the record (air.spectrum) in place of the record",
                ),
                // A case that cannot be read has been noted.
                LaydownSource::Surrogate(_) if !self.has_numbers(prefix) => continue,
                LaydownSource::Results { .. } | LaydownSource::Surrogate(_) => Fault::new(
                    format!("flies all filaments of the web, and {laydown} names no case to fly"),
                    format!("write {laydown}.case, or method = \"surrogate\""),
                ),
            };
            self.written.reject("web.method", fault);
            return;
        }
    }

    /// Checks a layer together with the sheet, if both are known.
    ///
    /// * `web` – the web of this layer alone
    pub(super) fn check_layer(&mut self, prefix: &str, web: &WebSpec) {
        let (sheet, Some(layer)) = (&web.sheet, web.layers.first()) else { return };
        let is_known =
            |key: &WebKey| key.get(web).and_then(|value| value.number()).is_none_or(|value| !value.is_nan());
        if !WEB.rows.iter().all(is_known) {
            return;
        }
        match &layer.filaments {
            Filaments::AtRandom { per_metre } | Filaments::Slot { per_metre, .. }
                if (per_metre * sheet.width).round() < 1.0 =>
            {
                let least = (0.5 / sheet.width).ceil() as u64;
                let width = Dimension::Length.pretty(sheet.width);
                let fault = Fault::new(
                    format!("lays no filament on a web of web.width = {width}"),
                    format!("write {least} or more"),
                );
                self.written.reject(&format!("{prefix}line.filaments_per_metre"), fault);
            }
            Filaments::AtRandom { .. } | Filaments::Slot { .. } => {}
            Filaments::Rows(rows) => {
                for (number, row) in (1..).zip(rows).filter(|(_, row)| row.filaments > 0) {
                    self.check_row(&format!("{prefix}line.rows.{number}."), row, sheet);
                }
            }
        }
        if let LaydownSource::Surrogate(surrogate) = &layer.source {
            for (key, side, what) in too_small(sheet, [surrogate.sigma_md, surrogate.sigma_cd]) {
                self.refuse(key, Dimension::Length.pretty(side), what);
            }
        }
        let fed = sheet.length * layer.feed_speed / layer.belt_speed;
        let density = layer.linear_density();
        if !density.is_normal() {
            let fault = Fault::degenerate("the mass per length", density);
            self.written.reject(&format!("{prefix}fibre.diameter"), fault);
        }
        if !fed.is_finite() {
            let fault = Fault::new(
                "is so small that a filament would lay an infinite length on the web",
                "write a higher speed",
            );
            self.written.reject(&format!("{prefix}line.belt_speed"), fault);
        }
    }

    /// Checks a row of nozzles together with the sheet.
    fn check_row(&mut self, before: &str, row: &Row, sheet: &Sheet) {
        let Row { offset, pitch, filaments, .. } = *row;
        let (width, beam) = (sheet.width, pitch * filaments as f64);
        let last = offset + pitch * (filaments - 1) as f64;
        if sheet.edges == Edges::Periodic && (beam / width - 1.0).abs() > SAME {
            let [pitch, shown, width] = [pitch, beam, width].map(|size| Dimension::Length.pretty_to(size, 8));
            let beam = Dimension::Length.pretty_to(beam, 12);
            let fault = Fault::new(
                format!(
                    "at a pitch of {pitch} make a row of {shown}, and with web.edges = \"periodic\" a row must be as wide as \
                     the web, {width}"
                ),
                format!(
                    "write web.width = \"{beam}\"; or write web.edges = \"cut\", and the edges, where the web is thin, are \
                     left out of the CV"
                ),
            );
            self.written.reject(&format!("{before}filaments"), fault);
        } else if sheet.edges == Edges::Cut && (offset > width || last < 0.0) {
            let [offset, last, width] = [offset, last, width].map(|size| Dimension::Length.pretty(size));
            let fault = Fault::new(
                format!(
                    "begins a row from {offset} to {last}, beside the web, which goes from 0 mm to {width}"
                ),
                "move the row, or widen the web",
            );
            self.refuse(&format!("{before}offset"), offset, fault);
        }
    }
}

/// The note about a case whose turbulence is the same across the flow.
fn uniform_air(case: &Path) -> Note {
    let what = Remark::EddiesInSpace { case: case.display().to_string() };
    let value = Some(format!("\"{}\"", METHODS[2]));
    Note { place: Place::Code, key: "web.method".to_owned(), value, what }
}
