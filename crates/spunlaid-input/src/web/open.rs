//! Makes the web of its file: layers, sheet and belt from what is written, then each filament, and all of it
//! checked together.

use super::super::Resources;
use super::super::written_values::{WrittenValue, WrittenValues, sorted};
use super::filament::Filament;
use super::read::{CASE, THROUGHPUT, WebParser, web_of};
use super::{WrittenWeb, flies_none};
use spunlaid_fibre::case::keys;
use spunlaid_fibre::{FedFilament, FilamentFeed};
use spunlaid_ground::{Diagnostic, Error, Fault};
use spunlaid_simulation::layers::keys::{NUMBERS, OF_FILAMENT, ONE_SOURCE, WEB};
use spunlaid_simulation::{LaydownSource, LayerSpec, WebSpec};
use spunlaid_web::map::Filaments;

/// The file of a web, read as far as it goes before its filaments are spun and simulated.
pub(super) struct OpenWeb<'a> {
    reading: WebParser<'a>,
    web: WebSpec,
    /// The filament of each layer, if it has to be simulated.
    filaments: Vec<Option<Filament>>,
}

/// Reads the layers, the sheet, and what is written of the filaments.
pub(super) fn open(written: WrittenWeb, resources: &Resources) -> OpenWeb<'_> {
    let WrittenWeb { values: key_values, path, named } = written;
    let notes = Vec::new();
    let basis_weight_key = String::new();
    let prefixes = prefixes(&key_values);
    let mut reading =
        WebParser { key_values, path, named, resources, notes, prefixes: prefixes.clone(), basis_weight_key };
    let mut web = WebSpec::unknown();
    let mut filaments: Vec<Option<Filament>> =
        prefixes.iter().map(|prefix| reading.add_layer(&mut web, prefix)).collect();
    reading.fill(&mut web, "web", "web.", false);
    reading.fill(&mut web, "fabric", "fabric.", false);
    reading.lay_weight(&mut web, &mut filaments);
    OpenWeb { reading, web, filaments }
}

/// What comes before the names of each layer's keys.
pub(super) fn prefixes(key_values: &WrittenValues) -> Vec<String> {
    match key_values.get("layer") {
        None => vec![String::new()],
        Some(_) => {
            let layers = key_values.number("layer").unwrap_or(0.0) as usize;
            (1..=layers).map(|number| format!("layer.{number}.")).collect()
        }
    }
}

impl OpenWeb<'_> {
    /// What is written of the filament of each layer; none of one that flies none.
    pub(super) fn filaments(&self) -> Vec<Option<WrittenValues>> {
        let values = |filament: &Filament| filament.values.clone();
        self.filaments.iter().map(|filament| filament.as_ref().map(values)).collect()
    }

    /// The web, and notes about its cases.
    ///
    /// # Errors
    /// Every problem with any key.
    pub(super) fn spec(self) -> Result<(WebSpec, Vec<Diagnostic>), Error> {
        let Self { mut reading, mut web, filaments } = self;
        let prefixes = reading.prefixes.clone();
        for (number, filament) in filaments.into_iter().enumerate() {
            let Some(filament) = filament else { continue };
            let prefix = &prefixes[number];
            let path = filament.path.clone();
            match reading.fly(prefix, filament)? {
                Some(case) => {
                    let says_throughput = reading.is_written(&format!("{prefix}{THROUGHPUT}"));
                    web.layers[number].take_case(path, case, says_throughput);
                }
                None => reading.excuse_numbers_of_case(prefix),
            }
        }
        reading.check_names(&prefixes);
        reading.complete_sheet(&mut web);
        reading.check_sources(&prefixes, &web);
        reading.check_assumed(&web);
        reading.check_turnable(&web);
        reading.settle_belt(&mut web);
        for (number, (prefix, layer)) in prefixes.iter().zip(&web.layers).enumerate() {
            reading.check_charge(prefix, &web, layer);
            reading.check_layer(prefix, &web.alone(number));
        }
        let unusual = reading.unusual();
        reading.note(unusual.clone());
        if reading.key_values.problems.is_empty() {
            reading.doubt_numbers(&web);
        }
        let WebParser { mut key_values, notes, .. } = reading;
        if key_values.problems.is_empty() {
            let Some(problem) = web.air_beyond_memory() else { return Ok((web, sorted(notes))) };
            key_values.problems.push(key_values.placed(problem));
        }
        // Unusual values may be why the web cannot be laid.
        let absurd = notes.into_iter().filter(|note| note.is_absurd);
        for note in absurd.chain(unusual) {
            if !key_values.problems.iter().any(|problem| problem.key == note.key) {
                key_values.problems.push(note.into_error());
            }
        }
        Err(sorted(key_values.problems).into())
    }

    /// What is written of its filament; none if it flies none.
    ///
    /// # Errors
    /// Every problem with the file, and if several layers have different filaments.
    pub(super) fn filament(self) -> Result<Option<WrittenValues>, Error> {
        let Self { mut reading, filaments, .. } = self;
        let filaments: Vec<Filament> = filaments.into_iter().flatten().collect();
        if let Some(number) = filaments.iter().position(|filament| !filament.is_same(&filaments[0])) {
            let fault = Fault::new(
                format!(
                    "have different filaments, and only one can be simulated (the first and the {}. of \
                     the simulated ones)",
                    number + 1
                ),
                "write the filament of one layer in a file of its own, without [[layer]], [line] and [web]",
            );
            reading.key_values.reject("layer", fault);
        }
        if !reading.key_values.problems.is_empty() {
            return Err(sorted(reading.key_values.problems).into());
        }
        Ok(filaments.into_iter().next().map(|filament| filament.values))
    }
}

impl WebParser<'_> {
    /// Adds a layer to a web, with the belt if it says one. Its values are NaN where there is a problem with them,
    /// which is noted. Returns its filament, if it has to be simulated.
    fn add_layer(&mut self, web: &mut WebSpec, prefix: &str) -> Option<Filament> {
        let way = self.way(prefix);
        let by_case = way == Way::Fly;
        let filament = if by_case { self.filament(prefix) } else { None };
        if by_case && filament.is_none()
            || way == Way::Unknown && self.key_values.is_excused(&format!("{prefix}laydown."))
        {
            self.excuse_numbers_of_case(prefix);
        }
        let mut alone = web_of(LayerSpec::unknown(LaydownSource::UNKNOWN));
        self.fill(&mut alone, "layer", prefix, by_case);
        for table in
            ["fibre", "laydown", "line"].iter().filter(|table| **table != "laydown" || way == Way::Numbers)
        {
            self.fill(&mut alone, table, &format!("{prefix}{table}."), by_case);
        }
        if web.belt_speed.is_nan() {
            web.belt_speed = alone.belt_speed;
        }
        let mut spec = alone.layers.remove(0);
        let rows = self.rows(&format!("{prefix}line."));
        if !rows.is_empty() {
            spec.filaments = Filaments::Rows(rows);
        }
        spec.defects = self.defects(&format!("{prefix}line."));
        if let Some(filament) = &filament {
            let of_case = filament.size_and_feed();
            // The throughput that a layer says is written again as it is.
            let feed = match spec.filament.feed {
                FilamentFeed::Throughput(_) => spec.filament.feed,
                FilamentFeed::Speed(_) => of_case.feed,
            };
            spec.filament = FedFilament { feed, ..of_case };
        }
        web.layers.push(spec);
        filament
    }

    /// Excuses that the numbers are missing which a case would give.
    fn excuse_numbers_of_case(&mut self, prefix: &str) {
        for key in WEB.rows.iter().filter(|key| key.key_of_case().is_some()) {
            self.key_values.suppress_missing(format!("{prefix}{}", key.name));
        }
    }
}

/// What determines how the filaments of a layer lie.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    /// A filament is simulated.
    Fly,
    /// The numbers of a surrogate.
    Numbers,
    /// It is not known, because of a problem that is noted.
    Unknown,
}

impl WebParser<'_> {
    /// What determines how the filaments of a layer lie.
    fn way(&mut self, prefix: &str) -> Way {
        let is_written = |name: &&&str| self.is_written(&format!("{prefix}{name}"));
        let numbers = NUMBERS.iter().find(is_written);
        let ways: Vec<&'static str> =
            [&CASE].into_iter().chain(numbers).filter(is_written).copied().collect();
        let own = self.first_of_flights(prefix);
        let (way, other) = match ways[..] {
            [] if own.is_some() || self.first_of_flights("").is_some() => return Way::Fly,
            [CASE] => return Way::Fly,
            [] if self.key_values.is_excused(&format!("{prefix}laydown.")) => return Way::Unknown,
            [] => {
                let fault = Fault::new(
                    "does not say how the fibres lie",
                    "write [feed], [belt], [air] and [run] for a filament to be simulated, or in [laydown] case = \
                    \"spunbond.toml\" (it is in that file), or sigma_md, sigma_cd and noise",
                );
                self.key_values.reject(&format!("{prefix}laydown"), fault);
                return Way::Unknown;
            }
            // They are still to be set.
            [number] => (Way::Numbers, number),
            [other, ref more @ ..] => {
                for way in more {
                    self.key_values.reject(&format!("{prefix}{way}"), Fault::excludes(other, ONE_SOURCE));
                }
                return Way::Unknown;
            }
        };
        if let Some((key, written_value)) = own {
            let fault = match written_value.is_set() {
                true => Fault::new(flies_none(), "leave it out"),
                false => Fault::excludes(&format!("{prefix}{other}"), ONE_SOURCE),
            };
            self.key_values.reject(&key, fault);
        }
        way
    }

    /// The first written key of a table that only a filament has which flies: not that of its size.
    fn first_of_flights(&self, prefix: &str) -> Option<(String, WrittenValue)> {
        let is_of_flight = |full: &str| {
            let name = full.strip_prefix(prefix).filter(|name| keys::find(name).is_some())?;
            let table = name.split('.').next()?;
            (OF_FILAMENT.contains(&table) && table != "fibre").then_some(())
        };
        let found = self.key_values.all().filter(|(full, _)| is_of_flight(full).is_some());
        let first = found.min_by(|a, b| a.1.place.cmp(&b.1.place))?;
        Some((first.0.to_owned(), first.1.clone()))
    }
}
