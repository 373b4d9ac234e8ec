//! How many replicates a point of a study has: a number, or until its results are as exact as asked.

use super::super::document::Named;
use super::Base;
use super::reader::Reader;
use crate::error::{Fault, nearest_word};
use crate::study::Replicates;

impl Reader<'_> {
    pub(super) fn replicates(&mut self, base: &dyn Base) -> Replicates {
        let until = self.until(base);
        if until.is_empty() && !self.key_values.has_table("replicates") {
            let written = self.key_values.integer("replicates");
            return Replicates::fixed(written.unwrap_or(base.seed_and_replicates().1));
        }
        if until.is_empty() && self.problems() == 0 {
            let line =
                "until = { amplitude_y = \"5 %\" } (the wanted standard error as a fraction of the mean)";
            self.key_values.reject("replicates.until", Fault::missing("replicates", line));
        }
        let most = self.value("replicates.at_most").and_then(|most| most.number());
        let at_most = most.map_or(u64::MAX, |most| most as u64);
        let at_least = self.key_values.integer("replicates.at_least").unwrap_or_else(|| at_most.min(8));
        if at_least > at_most {
            let fault = Fault::new(format!("is larger than at_most = {at_most}"), "lower it");
            self.key_values.reject("replicates.at_least", fault);
        }
        Replicates { at_least, at_most, until }
    }

    fn until(&mut self, base: &dyn Base) -> Vec<(usize, f64)> {
        let (mut until, quantities) = (Vec::new(), base.quantities());
        for Named { row, name, entry } in self.named("replicates.until") {
            let measure = quantities.iter().position(|quantity| quantity.name == name).ok_or_else(|| {
                let names: Vec<&str> = quantities.iter().map(|quantity| &*quantity.name).collect();
                let nearest = nearest_word(&name, names.iter().copied()).map(ToOwned::to_owned);
                Fault::unknown("is not the name of a result", nearest, "the results are", &names)
            });
            let fraction = || match self.as_kind(&row.kind, &entry)?.number() {
                Some(fraction) if fraction < 1.0 => Ok(fraction),
                _ => Err(Fault::new(
                    "is not a fraction of the mean",
                    "write a number between 0 and 1, like 0.05 or \"5 %\"",
                )),
            };
            match measure.and_then(|measure| Ok((measure, fraction()?))) {
                Ok(wanted) => until.push(wanted),
                Err(fault) => self.reject(&format!("replicates.until.{name}"), &entry, fault),
            }
        }
        until
    }
}
