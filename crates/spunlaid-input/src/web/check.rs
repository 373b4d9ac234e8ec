//! Checks layers together: with each other, and with the sheet on which they lie.

use super::read::{BELT_SPEED, WebParser};
use spunlaid_experiment::plausible::implausible;
use spunlaid_fibre::{BREAKDOWN, STRONG};
use spunlaid_ground::{Diagnostic, Dimension, Fault};
use spunlaid_simulation::layers::keys::{NUMBERS, WEB};
use spunlaid_simulation::layers::too_small;
use spunlaid_simulation::{Flown, LaydownSource, LayerSpec, SAME, WantedError, WebKey, WebSpec};
use spunlaid_web::map::{Filaments, LayerFilaments, holes};
use spunlaid_web::{Defect, Edges, Row, Sheet};

/// Keys of webs whose filaments fly.
const OF_FLIGHTS: [&str; 3] = ["web.simulated", "web.error", "web.time"];
/// Most mass per length of a filament over that of the others.
const MOST_TITRE: f64 = 2.0;

impl WebParser<'_> {
    /// Refuses two layers of one name.
    pub(super) fn check_names(&mut self, prefixes: &[String]) {
        let name_of = |prefix| self.key_values.text(&format!("{prefix}name"));
        let names: Vec<Option<String>> = prefixes.iter().map(name_of).collect();
        for (i, prefix) in prefixes.iter().enumerate().filter(|(i, _)| names[*i].is_some()) {
            if let Some(other) = names[..i].iter().position(|name| *name == names[i]) {
                let message = format!("is also the name of layer {}", other + 1);
                let fault = Fault::new(message, "give each layer a name of its own");
                self.key_values.reject(&format!("{prefix}name"), fault);
            }
        }
    }

    /// Refuses layers that cannot be simulated in one air, and what only flights have.
    pub(super) fn check_sources(&mut self, prefixes: &[String], web: &WebSpec) {
        if !web.flies() {
            let has_numbers = prefixes.iter().any(|prefix| self.has_numbers(prefix));
            for key in OF_FLIGHTS {
                if !has_numbers || !self.is_written(key) {
                    continue;
                }
                let fault = Fault::needs(
                    "laydown.case",
                    "leave it out: filaments of known numbers are not simulated",
                );
                self.key_values.reject(key, fault);
            }
            return;
        }
        if web.simulated == Flown::All && matches!(web.error, WantedError::Of(_)) {
            let message = "has no effect where every filament is simulated (web.simulated = \"all\")";
            self.key_values
                .reject("web.error", Fault::new(message, "leave one of the two out, or write \"auto\""));
        }
        for (prefix, layer) in prefixes.iter().zip(&web.layers) {
            let laydown = format!("{prefix}laydown");
            match &layer.source {
                LaydownSource::Case { case, path } if !case.air.records.is_empty() => {
                    let message = format!(
                        "uses a velocity record ({}, air.record), which does not contain how the air \
                        varies across the flow, and all filaments of a web are in shared turbulence",
                        path.display()
                    );
                    let remedy = format!(
                        "give it the spectrum of the record (air.spectrum) instead of the record. Or simulate it \
                        with `spunlaid run`, and write the standard deviations σ₁ and σ₂ and the noise A that it \
                        reports as {laydown}.sigma_md, {laydown}.sigma_cd and {laydown}.noise instead of the case"
                    );
                    let key = self.says(prefix, "air.record").unwrap_or_else(|| format!("{laydown}.case"));
                    self.key_values.reject(&key, Fault::new(message, remedy));
                }
                LaydownSource::Surrogate(_) if self.has_numbers(prefix) => {
                    let key = NUMBERS.iter().map(|name| format!("{prefix}{name}"));
                    let key = key.into_iter().find(|key| self.is_written(key)).unwrap_or_default();
                    let fault = Fault::new(
                        "is a known number, and another layer is simulated: all filaments of a web are \
                         simulated, or none",
                        format!(
                            "name a case there ({laydown}.case). Or simulate the case of the other layer \
                            with `spunlaid run`, and write the standard deviations and the noise that it \
                            reports in its [laydown]"
                        ),
                    );
                    self.key_values.reject(&key, fault);
                }
                // A case that cannot be read has been noted.
                LaydownSource::Case { .. } | LaydownSource::Surrogate(_) => {}
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
            Filaments::AtRandom { per_metre } | Filaments::Slot { per_metre, .. }
                if (per_metre * sheet.width).round() < 1.0 =>
            {
                let least = (0.5 / sheet.width).ceil() as u64;
                let width = Dimension::Length.pretty(sheet.width);
                let fault = Fault::new(
                    format!("lays no filament on a web of web.width = {width}"),
                    format!("write {least} or more"),
                );
                self.key_values.reject(&format!("{prefix}line.filaments_per_metre"), fault);
            }
            Filaments::AtRandom { .. } | Filaments::Slot { .. } => {}
            Filaments::Rows(rows) => {
                for (number, row) in (1..).zip(rows).filter(|(_, row)| row.filaments > 0) {
                    self.check_row(&format!("{prefix}line.rows.{number}."), row, sheet);
                }
            }
        }
        for (number, defect) in layer.defects.iter().enumerate() {
            self.check_defect(&format!("{prefix}line.defects.{}.", number + 1), web, number, defect);
        }
        if let LaydownSource::Surrogate(surrogate) = &layer.source {
            for (key, side, what) in too_small(sheet, [surrogate.sigma_md, surrogate.sigma_cd]) {
                self.refuse(key, Dimension::Length.pretty(side), what);
            }
        }
        let of_field = layer.source.case().map(|case| {
            let off_middle = case.fed_off_the_middle(layer.filaments.depths());
            [
                (case.changes_across(sheet.width), "air.field_machine_direction"),
                (off_middle, "air.field_root"),
            ]
        });
        for (what, key) in of_field.into_iter().flatten() {
            let (place, key) = (self.key_values.whole(), key.to_owned());
            self.note(what.map(|what| Diagnostic { place, key, ..what }).into_iter().collect());
        }
        let fed = web.fed_length(layer);
        let density = layer.fed_filament().linear_density();
        if !density.is_normal() {
            let fault = Fault::degenerate("the mass per length", density);
            self.key_values.reject(&format!("{prefix}fibre.diameter"), fault);
        }
        // A belt whose speed is not known has been reported.
        if fed.is_infinite() {
            let (key, how, remedy) = match web.basis_weight {
                Some(_) => (self.basis_weight_key.clone(), "large", "write a lower weight"),
                None => (format!("{prefix}{BELT_SPEED}"), "small", "write a higher speed"),
            };
            let message = format!("is so {how} that a filament would lay an infinite length on the web");
            self.key_values.reject(&key, Fault::new(message, remedy));
        }
    }

    /// Notes numbers that spunbond lines do not have, where they are written or else of the whole file.
    pub(super) fn doubt_numbers(&mut self, web: &WebSpec) {
        for found in implausible(web) {
            let full = self.prefixes.get(found.layer).map(|prefix| format!("{prefix}{}", found.limit.key));
            let note = match full.filter(|full| self.is_written(full)) {
                Some(key) => self.key_values.placed(Diagnostic { key, ..found.note(true) }),
                None => Diagnostic { place: self.key_values.whole(), ..found.note(false) },
            };
            self.note(vec![note]);
        }
    }

    /// Checks a defect together with the holes of its layer.
    fn check_defect(&mut self, before: &str, web: &WebSpec, number: usize, defect: &Defect) {
        let Some(layer) = web.layers.first() else { return };
        if defect.titre > MOST_TITRE {
            let fault = Fault::new(
                format!("is more than {MOST_TITRE} times the mass of the other filaments"),
                format!("write 0 for blocked holes, and up to {MOST_TITRE} for others"),
            );
            self.key_values.reject(&format!("{before}titre"), fault);
        }
        let filaments = &layer.filaments;
        let layer = LayerFilaments { sheet: &web.sheet, seed: web.seed, number: 0, filaments };
        let of = |defect: &Defect| holes(layer, number, defect).len();
        let (width, count) = (web.sheet.width, of(&Defect { share: 1.0, ..*defect }));
        let fault = if defect.from.is_some_and(|from| from > width) {
            let width = Dimension::Length.pretty(width);
            Fault::new(
                format!("lies outside of the web, which extends from 0 mm to {width}"),
                "write a position on the web",
            )
        } else if count == 0 {
            Fault::new(
                "has no hole: none of this row lies between from and to",
                "write positions on the web with from below to, and a row that exists",
            )
        } else if count == of(&Defect::USUAL)
            && *defect == (Defect { from: defect.from, to: defect.to, row: defect.row, ..Defect::USUAL })
        {
            Fault::new(
                "blocks every hole, so that nothing is laid",
                "say which holes: from, to, row or share; or how they differ: titre or after",
            )
        } else {
            return;
        };
        let keys = ["from", "to", "row"].map(|key| format!("{before}{key}"));
        let key = keys.into_iter().find(|key| self.is_written(key));
        let list = before.trim_end_matches(|c: char| c == '.' || c.is_ascii_digit());
        self.key_values.reject(key.as_deref().unwrap_or(list), fault);
    }

    /// Checks a row of holes together with the sheet.
    fn check_row(&mut self, before: &str, row: &Row, sheet: &Sheet) {
        let Row { offset, pitch, filaments, .. } = *row;
        let (width, beam) = (sheet.width, pitch * filaments as f64);
        let last = offset + pitch * (filaments - 1) as f64;
        if sheet.edges == Edges::Periodic && (beam / width - 1.0).abs() > SAME {
            let [pitch, shown, width] = [pitch, beam, width].map(|size| Dimension::Length.pretty_to(size, 8));
            let beam = Dimension::Length.pretty_to(beam, 12);
            let fault = Fault::new(
                format!(
                    "at a pitch of {pitch} make a row of {shown}, and with web.edges = \"periodic\" a row \
                    must be as wide as the web, {width}"
                ),
                format!(
                    "write web.width = \"{beam}\"; or write web.edges = \"cut\", and the edges, where the \
                    web is thin, are left out of the CV"
                ),
            );
            self.key_values.reject(&format!("{before}filaments"), fault);
        } else if sheet.edges == Edges::Cut && (offset > width || last < 0.0) {
            let [offset, last, width] = [offset, last, width].map(|size| Dimension::Length.pretty(size));
            let fault = Fault::new(
                format!(
                    "begins a row from {offset} to {last}, outside of the web, which extends from 0 mm to {width}"
                ),
                "move the row, or widen the web",
            );
            self.refuse(&format!("{before}offset"), offset, fault);
        }
    }
}

impl WebParser<'_> {
    /// Checks the charge of a layer.
    pub(super) fn check_charge(&mut self, prefix: &str, web: &WebSpec, layer: &LayerSpec) {
        let [charge, walls] = ["charge", "walls"].map(|name| format!("{prefix}line.{name}"));
        if layer.charged().is_some() && !web.flies() {
            let fault = Fault::new(
                "is that of filaments of known numbers, which are not simulated",
                "leave it out, or name a case in [laydown] instead of the numbers",
            );
            self.key_values.reject(&charge, fault);
            return;
        }
        let farthest = layer.farthest_inlet();
        if let Some(distance) = layer.walls.filter(|distance| *distance <= farthest) {
            let shown = |length| Dimension::Length.pretty(length);
            let fault = Fault::new(
                format!("is no more than {}, where filaments are fed", shown(farthest)),
                "write a larger distance from the middle of the slot",
            );
            self.refuse(&walls, shown(distance), fault);
        }
        let Some(estimate) = layer.charge_estimate(&web.sheet) else { return };
        let field = Dimension::ElectricField.pretty_to(estimate.edge_field, 2);
        if estimate.edge_field > BREAKDOWN {
            let most = layer.charge.unwrap_or(0.0).abs() * BREAKDOWN / estimate.edge_field;
            let fault = Fault::new(
                format!(
                    "gives a field of {field} at the edge of the curtain, and air breaks down at {}",
                    Dimension::ElectricField.pretty(BREAKDOWN)
                ),
                format!("write {} or less", Dimension::SpecificCharge.pretty_to(0.99 * most, 2)),
            );
            self.key_values.reject(&charge, fault);
        } else if estimate.edge_field > STRONG {
            let note = Diagnostic::note(format!(
                "gives a field of about {field} at the edge of the curtain: air breaks down at {}, \
                and at edges of metal long before, so the charge is lost",
                Dimension::ElectricField.pretty(BREAKDOWN)
            ));
            let value = layer.charge.map(|charge| Dimension::SpecificCharge.pretty(charge));
            self.note(vec![note.with_key(charge, value)]);
        }
    }
}
