//! Checks layers together: with each other, and with the sheet on which they lie.

use super::read::{BELT_SPEED, Reading, SAME, differs_from_case};
use crate::case::keys;
use crate::error::Fault;
use crate::layers::keys::{WEB, without_numbers};
use crate::layers::{LaydownSource, LayerSpec, WebKey, WebSpec, too_small};
use crate::units::Dimension;
use crate::web::{Edges, Filaments, Row, Sheet};
use std::collections::BTreeMap;

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
        // What a case says is kept, because its fibres are flown with it.
        let is_known = |layer: &LayerSpec| !layer.belt_speed.is_nan();
        let flown = layers.iter().position(|layer| is_known(layer) && layer.source.case().is_some());
        let Some(first) = flown.or_else(|| layers.iter().position(is_known)) else {
            let is_told = |key: &String| self.is_written(key) || self.written.is_excused(key);
            if let Some(key) = keys.first().filter(|_| !keys.iter().any(is_told)) {
                let (table, line) =
                    key.rsplit_once('.').map_or(("", ""), |(table, _)| (table, "belt_speed = \"3 m/s\""));
                self.written.reject(key, Fault::missing(&without_numbers(table), line));
            }
            return;
        };
        let (belt, source) = (layers[first].belt_speed, layers[first].source.clone());
        for (number, layer) in layers.iter_mut().enumerate() {
            let key = &keys[number];
            if layer.belt_speed.is_nan() && !self.is_written(key) {
                layer.belt_speed = belt;
            } else if (layer.belt_speed / belt - 1.0).abs() > SAME {
                self.refuse_belt(&prefixes[number], layer, (first + 1, belt, &source));
            }
            if layer.belt_speed > layer.feed_speed {
                let [value, feed] =
                    [layer.belt_speed, layer.feed_speed].map(|speed| Dimension::Velocity.pretty(speed));
                let fault = Fault::new(
                    format!("is more than line.feed_speed = {feed}, which would tear the fibre"),
                    "slow the belt, or feed faster",
                );
                self.refuse(key, value, fault);
            }
        }
    }

    /// Refuses a layer on another belt than that of the first layer that says its speed.
    fn refuse_belt(
        &mut self,
        prefix: &str,
        layer: &LayerSpec,
        (first, belt, source): (usize, f64, &LaydownSource),
    ) {
        let key = format!("{prefix}{BELT_SPEED}");
        let [own, other] = [layer.belt_speed, belt].map(|speed| Dimension::Velocity.pretty(speed));
        match (&layer.source, source.case(), keys::find("belt.speed")) {
            (LaydownSource::Surrogate(_), Some(_), Some(of_case)) => {
                let fibres = format!("the fibres of layer {first}");
                let fault = differs_from_case(of_case, &belt.into(), source.path(), &fibres);
                self.written.reject(&key, fault);
            }
            (LaydownSource::Surrogate(_), ..) => {
                let fault = Fault::new(
                    format!(
                        "differs from the belt speed of layer {first}, {other}, and all layers lie on one belt"
                    ),
                    "write it in one layer and leave it out of the others",
                );
                self.written.reject(&key, fault);
            }
            (LaydownSource::Case { .. } | LaydownSource::Results { .. }, ..) => {
                let way = if matches!(layer.source, LaydownSource::Case { .. }) { "case" } else { "results" };
                let fault = Fault::new(
                    format!(
                        "has belt.speed = {own}, but layer {first} is flown with {other}, and all layers lie on one belt"
                    ),
                    "give all cases the same belt.speed",
                );
                self.written.reject(&format!("{prefix}laydown.{way}"), fault);
            }
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
            Filaments::AtRandom { per_metre } if (per_metre * sheet.width).round() < 1.0 => {
                let least = (0.5 / sheet.width).ceil() as u64;
                let width = Dimension::Length.pretty(sheet.width);
                let fault = Fault::new(
                    format!("lays no filament on a web of web.width = {width}"),
                    format!("write {least} or more"),
                );
                self.written.reject(&format!("{prefix}line.filaments_per_metre"), fault);
            }
            Filaments::AtRandom { .. } => {}
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
        let Row { offset, pitch, filaments } = *row;
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
