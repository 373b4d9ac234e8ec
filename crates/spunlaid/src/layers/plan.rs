//! What a web in one air will fly, before it is flown.

use super::WebSpec;
use super::shared_air::beam_on;

/// The flight of a layer of a web in one air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedFlight {
    /// Number of filaments that are flown.
    pub filaments: u64,
    /// Whether they stand for others that are not flown.
    pub is_few: bool,
    /// Size of the sheet that they lay, across and along [m].
    pub sheet: [f64; 2],
    /// Memory that the field of eddies takes [B].
    pub memory: f64,
}

impl WebSpec {
    /// What a web in one air will fly, layer by layer; nothing of any other web, and of layers that name no case.
    pub fn planned_flights(&self) -> Vec<PlannedFlight> {
        let layers = (0..self.layers.len()).filter_map(|number| beam_on(self, number, None).ok());
        let plan = layers.map(|layer| PlannedFlight {
            filaments: layer.places.len() as u64,
            is_few: layer.few.is_some(),
            sheet: [layer.sheet.width, layer.sheet.length],
            memory: layer.beam().memory_of_air(&layer.sheet),
        });
        plan.collect()
    }
}
