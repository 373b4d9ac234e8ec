//! The filaments of a line, each of which a page of its own shows as a fibre.

use super::Session;
use crate::board::PageId;
use crate::fibre::Document;
use crate::message::{Command, PageRequest};
use crate::page::Tab;
use std::path::PathBuf;
use std::sync::mpsc::SyncSender;

/// What asks as if it were a page: no page has this number, so nobody gets the answer.
const NO_PAGE: PageId = PageId::MAX;

/// The page of the filament of a layer.
pub(super) struct FilamentPage {
    layer: usize,
    /// The case that it shows.
    text: String,
    requests: SyncSender<PageRequest>,
}

impl Session {
    /// Numbers of the layers whose filaments are simulated, from 0.
    pub(crate) fn layers_with_filament(&self) -> Vec<usize> {
        let layers = self.web(self.now).spec.layers.iter().enumerate();
        layers.filter(|(_, layer)| layer.source.case().is_some()).map(|(number, _)| number).collect()
    }

    /// The filament of a layer as the knobs are now.
    pub(crate) fn filament_of(&self, layer: usize) -> Document {
        let name = format!("{}_filament{}.toml", self.title(), self.of_layer(layer, "_"));
        let case = self.web(self.now).spec.layers.get(layer).and_then(|layer| layer.source.case());
        case.map_or_else(
            || Document::new(String::new(), None),
            |case| Document::of_filament(case, PathBuf::from(name)),
        )
    }

    /// The tab of its page.
    pub(crate) fn tab_of_filament(&self, layer: usize) -> Tab {
        let [label, at] = [" of layer ", "-"].map(|before| self.of_layer(layer, before));
        Tab { label: format!("Fibre{label}"), at: format!("fibre{at}/") }
    }

    /// The number of a layer, from 1, after a text; nothing where there is one layer only.
    fn of_layer(&self, layer: usize, before: &str) -> String {
        if self.web(self.now).spec.layers.len() > 1 {
            format!("{before}{}", layer + 1)
        } else {
            String::new()
        }
    }

    /// From now on the page of a filament follows the knobs.
    pub(crate) fn show_filament_to(&mut self, layer: usize, requests: SyncSender<PageRequest>) {
        let text = self.filament_of(layer).text().to_owned();
        self.filaments.push(FilamentPage { layer, text, requests });
    }

    /// The filament of a layer has no page.
    pub(crate) fn lacks_filament(&mut self, layer: usize, why: &[String]) {
        let name = self.tab_of_filament(layer).label;
        self.lacking.push(format!("{name} has no page: {}", why.join("; ")));
        self.show();
    }

    /// Shows the filaments as the knobs are now, once their tension is known.
    pub(super) fn show_filaments(&mut self) {
        if self.web(self.now).line.needs_flights {
            return;
        }
        let mut pages = std::mem::take(&mut self.filaments);
        for FilamentPage { layer, text, requests } in &mut pages {
            let now = self.filament_of(*layer).text().to_owned();
            let command = Command::Filament { text: now.clone() };
            // A session that has much to hear gets it after the next change.
            if now != *text && requests.try_send(PageRequest { page: NO_PAGE, command }).is_ok() {
                *text = now;
            }
        }
        self.filaments = pages;
    }
}
