//! Checks layers together: with each other, and with the sheet on which they lie.

use super::read::{Reading, SAME};
use crate::error::{Fault, WebFault};
use crate::layers::{LaydownSource, LayerSpec, too_small};
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
                Some(other) => self.written.reject(&key, WebFault::NameTwice { other: other + 1 }.into()),
                None => drop(seen.insert(name, i)),
            }
        }
    }

    /// Refuses layers on belts of different speeds.
    pub(super) fn check_belts(&mut self, prefixes: &[String], layers: &[Option<LayerSpec>]) {
        let Some(first) = layers.first().and_then(|layer| Some(layer.as_ref()?.belt_speed)) else { return };
        for (prefix, layer) in prefixes.iter().zip(layers).skip(1) {
            let belt = layer.as_ref().map_or(first, |layer| layer.belt_speed);
            if (belt / first - 1.0).abs() > SAME {
                let key = format!("{prefix}line.belt_speed");
                self.refuse(&key, Dimension::Velocity.pretty(belt), WebFault::TwoBelts { first });
            }
        }
    }

    /// Checks a layer together with the sheet.
    pub(super) fn check_layer(&mut self, prefix: &str, layer: &LayerSpec, sheet: &Sheet) {
        match &layer.filaments {
            Filaments::AtRandom { per_metre } if (per_metre * sheet.width).round() < 1.0 => {
                let least = (0.5 / sheet.width).ceil() as u64;
                let (key, width) = (format!("{prefix}line.filaments_per_metre"), sheet.width);
                self.written.reject(&key, WebFault::LaysNothing { width, least }.into());
            }
            Filaments::AtRandom { .. } => {}
            Filaments::Rows(rows) => {
                for (number, row) in (1..).zip(rows) {
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
        for (key, what, value) in [
            ("fibre.diameter", "the mass per length", layer.linear_density()),
            ("line.belt_speed", "the length that a filament lays on the web, in metres,", fed),
        ] {
            if !(value.is_normal() && value > 0.0) {
                self.written.reject(&format!("{prefix}{key}"), Fault::Degenerate { what, value });
            }
        }
    }

    /// Checks a row of nozzles together with the sheet.
    fn check_row(&mut self, before: &str, row: &Row, sheet: &Sheet) {
        let Row { offset, pitch, filaments } = *row;
        let (width, beam) = (sheet.width, pitch * filaments as f64);
        let last = offset + pitch * (filaments - 1) as f64;
        if sheet.edges == Edges::Periodic && (beam / width - 1.0).abs() > SAME {
            let fault = WebFault::RowNotPeriodic { pitch, beam, width };
            self.written.reject(&format!("{before}filaments"), fault.into());
        } else if sheet.edges == Edges::Cut && (offset > width || last < 0.0) {
            let fault = WebFault::RowBeside { from: offset, to: last, width };
            self.refuse(&format!("{before}offset"), Dimension::Length.pretty(offset), fault);
        }
    }
}
