//! Links: keys that follow from other keys by a formula.

use super::super::document::Named;
use super::super::entry::Entry;
use super::{Base, Reader, not_written};
use spunlaid_experiment::{Factor, Link};
use spunlaid_fibre::case::keys::VariedKey;
use spunlaid_ground::units::unknown_name;
use spunlaid_ground::{Diagnostic, Expression, Fault, Powers};

/// Formulas with a name: the name, the key it is for, the formula.
const READY_MADE: [(&str, &str, &str); 1] =
    // The integral time of a flat spectrum is 1/(4f). By Taylor's hypothesis the length of an eddy is then U/(4f).
    [("taylor", "air.cutoff_frequency", "air.velocity / (4 * air.length_scale)")];

impl Reader<'_> {
    /// The keys that follow from others. Those that cannot are noted as problems.
    pub(super) fn links(&mut self, factors: &[Factor], base: &dyn Base) -> Vec<Link> {
        let (mut links, mut entries): (Vec<Link>, Vec<Entry<'_>>) = (Vec::new(), Vec::new());
        for named in self.named("link") {
            let others: Vec<&str> = links.iter().map(|link| &*link.key.name).collect();
            let Some(linked) = self.varied(base, &named, &others) else { continue };
            let Named { row, name, entry } = named;
            let link = if !linked.words().is_empty() {
                Err(Fault::new("takes words, and a formula gives a number", "list the words under [vary]"))
            } else if factors.iter().any(|factor| factor.key == linked) {
                Err(Fault::new("is both varied and linked", "keep one"))
            } else {
                self.as_kind(&row.kind, &entry)
                    .and_then(|_| read(base, linked, entry.value.as_str().unwrap_or_default()))
            };
            match link {
                Ok(link) => {
                    links.push(link);
                    entries.push(entry);
                }
                Err(fault) => self.reject(&name, &entry, fault),
            }
        }
        let keys = factors.iter().map(|factor| &factor.key).chain(links.iter().map(|link| &link.key));
        let keys: Vec<&str> = keys.map(|key| &*key.name).collect();
        for (link, entry) in links.iter().zip(&entries) {
            if let Some(name) = unwritten(link, &keys, base) {
                let (place, key) = (entry.place.clone(), name.to_owned());
                let what = not_written("use it in a formula");
                self.key_values.problems.push(Diagnostic { place, key, ..what.into() });
            }
        }
        if let Err((link, fault)) = order(&links) {
            self.reject(&links[link].key.name, &entries[link], fault);
        }
        links
    }
}

/// Reads the formula of a key.
fn read(base: &dyn Base, key: VariedKey, text: &str) -> Result<Link, Fault> {
    let text = text.trim();
    let text = text.strip_prefix('=').unwrap_or(text).trim();
    let named = READY_MADE.iter().find(|(name, owner, _)| *name == text && *owner == key.name);
    let expression = Expression::parse(named.map_or(text, |(.., formula)| formula))?;
    for name in expression.names() {
        if let Err(advice) = base.numeric(name) {
            return Err(unknown_name(name, advice));
        }
    }
    // Units do not depend on values, so any value serves for this check.
    let (_, found) = expression
        .value(&|name| Some((1.0, Powers::from_dimension(base.numeric(name).ok()?.dimension()))))?;
    let wanted = Powers::from_dimension(key.dimension());
    if !found.agree(wanted) {
        let name = key.dimension().name();
        let message = format!("gives a value in {found}, but {name} in {wanted} is needed");
        return Err(Fault::new(message, "check the formula"));
    }
    Ok(Link { key, expression })
}

/// An order in which every link comes after the links it depends on.
///
/// # Errors
/// Index of a link that depends on itself, and the keys of the circle.
pub(super) fn order(links: &[Link]) -> Result<Vec<usize>, (usize, Fault)> {
    let mut order: Vec<usize> = Vec::new();
    while order.len() < links.len() {
        let waits_for = |i: usize| {
            let names = links[i].expression.names();
            names
                .into_iter()
                .filter_map(|name| links.iter().position(|link| link.key.name == name))
                .find(|other| !order.contains(other))
        };
        let ready = (0..links.len()).filter(|i| !order.contains(i)).find(|i| waits_for(*i).is_none());
        match ready {
            Some(next) => order.push(next),
            None => {
                let start = (0..links.len()).find(|i| !order.contains(i)).unwrap_or(0);
                let mut way = vec![start];
                // Every waiting link waits for another waiting link, so this path returns to a link on it.
                let last = loop {
                    let next = way.last().and_then(|i| waits_for(*i)).unwrap_or(start);
                    if way.contains(&next) {
                        break next;
                    }
                    way.push(next);
                };
                let circle = way.iter().skip_while(|i| **i != last).chain([&last]);
                let circle: Vec<&str> = circle.map(|i| &*links[*i].key.name).collect();
                let message = format!("depends on itself: {}", circle.join(" ← "));
                return Err((last, Fault::new(message, "remove one of these links")));
            }
        }
    }
    Ok(order)
}

/// The first key in a link's formula that has no value: neither varied nor linked nor written in the case.
pub(super) fn unwritten<'a>(link: &'a Link, set: &[&str], base: &dyn Base) -> Option<&'a str> {
    let has_value =
        |name: &str| set.contains(&name) || base.numeric(name).is_ok_and(|key| base.value(&key).is_some());
    link.expression.names().into_iter().find(|name| !has_value(name))
}

/// The values of the links, in the order of `links`.
///
/// * `order` – the order of [`order`]
/// * `known` – returns the value of a key that is not linked
pub(super) fn values(
    base: &dyn Base,
    links: &[Link],
    order: &[usize],
    known: &dyn Fn(&str) -> Option<f64>,
) -> Vec<f64> {
    let mut values: Vec<Option<f64>> = vec![None; links.len()];
    for &i in order {
        let known = |name: &str| {
            let linked = links.iter().position(|link| link.key.name == name);
            let value = linked.map_or_else(|| known(name), |other| values[other])?;
            Some((value, Powers::from_dimension(base.numeric(name).ok()?.dimension())))
        };
        let value = links[i].expression.value(&known).map_or(f64::NAN, |(value, _)| value);
        values[i] = Some(if links[i].key.is_whole() { value.round() } else { value });
    }
    values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect()
}
