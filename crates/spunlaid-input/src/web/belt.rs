//! The belt on which all layers lie: its speed is written, follows from a basis weight, or is that of the cases.

use super::filament::Filament;
use super::read::{BELT_SPEED, CASE, WebParser};
use spunlaid_ground::{Dimension, Fault};
use spunlaid_simulation::layers::full_names::without_numbers;
use spunlaid_simulation::layers::keys::{EITHER, WEB};
use spunlaid_simulation::{LayerSpec, SAME, WebSpec};

/// The key of the weight of all layers, which gives the speed of the belt.
const BASIS_WEIGHT: &str = "line.basis_weight";

impl WebParser<'_> {
    /// Gives the web the belt on which all layers have the basis weight that is written, if one is. The cases
    /// are simulated above it.
    pub(super) fn lay_weight(&mut self, web: &mut WebSpec, filaments: &mut [Option<Filament>]) {
        let Some(key) = self.of_all_layers(BASIS_WEIGHT) else { return };
        self.basis_weight_key.clone_from(&key);
        let of_same_layer = key.replace(BASIS_WEIGHT, BELT_SPEED);
        let mut belts = self.written_in_layers(BELT_SPEED).into_iter();
        if let Some(belt) = belts.find(|belt| *belt != of_same_layer) {
            self.key_values.reject(&key, Fault::excludes(&belt, EITHER));
        }
        let Some(weight) = self.key_values.number(&key) else { return };
        web.basis_weight = Some(weight);
        let belt = web.belt_speed_for(weight);
        // What is missing, or that nothing is laid, is reported elsewhere.
        web.belt_speed = if belt == 0.0 { f64::NAN } else { belt };
        let Some(written_value) = self.key_values.get(&key) else { return };
        if web.belt_speed.is_nan() {
            return;
        }
        for filament in filaments.iter_mut().flatten() {
            filament.derive("belt.speed", Dimension::Velocity, web.belt_speed, &key, written_value);
        }
    }

    /// The full names of a key in the layers in which it is written.
    fn written_in_layers(&self, name: &str) -> Vec<String> {
        let keys = self.prefixes.iter().map(|prefix| format!("{prefix}{name}"));
        keys.filter(|key| self.is_written(key)).collect()
    }

    /// The full name of a key of all layers in the first one in which it is written, if it is written in any. Another
    /// number in another layer is refused.
    fn of_all_layers(&mut self, name: &str) -> Option<String> {
        let key = WEB.find(name)?;
        let mut written = self.written_in_layers(name).into_iter();
        let first = written.next()?;
        let number = self.key_values.number(&first);
        for full in written {
            if let (Some(number), Some(other)) = (number, self.key_values.number(&full))
                && (other / number - 1.0).abs() > SAME
            {
                let number = key.kind.pretty(&number.into());
                let why = key.relations.of_all_layers;
                let fault = Fault::new(
                    format!("differs from {first} = {number}, and {}", why.unwrap_or_default()),
                    "write it in one layer and leave it out of the others",
                );
                self.key_values.reject(&full, fault);
            }
        }
        Some(first)
    }

    /// Checks that all layers lie on one belt, which tears none of them.
    pub(super) fn settle_belt(&mut self, web: &mut WebSpec) {
        let by_weight = !self.basis_weight_key.is_empty();
        if !by_weight {
            self.lay_on_common_belt(web);
        }
        let is_torn = |(_, layer): &(usize, &LayerSpec)| web.belt_speed > layer.fed_filament().feed_speed();
        let torn = (0..).zip(&web.layers).filter(is_torn);
        // The belt of a basis weight is one number for all.
        for (number, layer) in torn.take(if by_weight { 1 } else { usize::MAX }) {
            let [belt, feed] = [web.belt_speed, layer.fed_filament().feed_speed()]
                .map(|speed| Dimension::Velocity.pretty(speed));
            if by_weight {
                let message = format!(
                    "takes a belt of {belt}, which is more than line.feed_speed = {feed} and would tear the fibre"
                );
                let key = self.basis_weight_key.clone();
                self.key_values.reject(&key, Fault::new(message, "lay more, or feed faster"));
            } else {
                let message = format!("is more than line.feed_speed = {feed}, which would tear the fibre");
                let key = format!("{}{BELT_SPEED}", self.prefixes[number]);
                self.refuse(&key, belt, Fault::new(message, "slow the belt, or feed faster"));
            }
        }
    }

    /// Gives the web the speed of the belt, which is written in one layer or is that of the simulated cases.
    fn lay_on_common_belt(&mut self, web: &mut WebSpec) {
        self.of_all_layers(BELT_SPEED);
        let of_case = |layer: &LayerSpec| Some(layer.source.case()?.line?.belt_speed);
        let belts: Vec<Option<f64>> = web.layers.iter().map(of_case).collect();
        let first = belts.iter().position(Option::is_some);
        if let Some(of_cases) = first.and_then(|first| belts[first]) {
            web.belt_speed = of_cases;
        }
        if web.belt_speed.is_nan() {
            let keys: Vec<String> =
                self.prefixes.iter().map(|prefix| format!("{prefix}{BELT_SPEED}")).collect();
            if let Some(key) = keys.first().filter(|_| !keys.iter().any(|key| self.is_given(key))) {
                let table = without_numbers(key.trim_end_matches(".belt_speed"));
                self.key_values.reject(key, Fault::missing(&table, "belt_speed = \"3 m/s\""));
            }
            return;
        }
        for (own, prefix) in belts.into_iter().zip(self.prefixes.clone()) {
            if let Some(own) = own.filter(|own| (own / web.belt_speed - 1.0).abs() > SAME) {
                let [own, belt] = [own, web.belt_speed].map(|speed| Dimension::Velocity.pretty(speed));
                let message = format!(
                    "has belt.speed = {own}, which differs from the belt speed of layer {}, {belt}, and all layers \
                    lie on one belt",
                    first.unwrap_or_default() + 1
                );
                let key = self.says(&prefix, "belt.speed").unwrap_or_else(|| format!("{prefix}{CASE}"));
                self.key_values.reject(&key, Fault::new(message, "give all cases the same belt.speed"));
            }
        }
    }
}
