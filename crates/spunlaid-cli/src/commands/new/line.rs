//! The files of a line: one of its web and its filament, and the air between slot and belt.

use crate::args::{Given, LineNumbers};
use spunlaid::fibre::Polymer;
use spunlaid::ground::{Dimension, Fault};
use spunlaid_results::numbers::significant;
use std::f64::consts::PI;

/// Width of a line [m], if the user gives none.
const WIDTH: f64 = 1.0;
/// Distance to the belt [m], if the user gives none.
const DISTANCE: f64 = 0.5;
/// Turbulence of the air between slot and belt, of the usual size: intensity, length of an eddy [m], and the
/// velocity at the belt over that at the slot.
const INTENSITY: f64 = 0.1;
const EDDY: f64 = 16e-3;
const SLOWED: f64 = 1.0 / 6.0;

/// Depth of the slot [m], if the user gives none.
const DEPTH: f64 = 20e-3;
/// How far the weight that a belt takes may be from the one that is given beside it, as a share.
const NEARLY: f64 = 0.01;

/// Digits with which a number that was given is written.
const GIVEN: usize = 9;

/// The numbers of a line, in SI units.
pub(super) struct NewLine {
    polymer: Polymer,
    throughput: f64,
    /// As it was given: a titre, or a diameter.
    size: Size,
    /// As it was given: of the web, or by the speed of the belt.
    weight: Weight,
    holes_per_metre: u64,
    holes: Option<u64>,
    beams: u64,
    width: f64,
    distance: f64,
    air_speed: f64,
    slot_depth: Option<f64>,
    turbulence: Option<f64>,
    thickness: Option<f64>,
}

/// How heavy the web is.
#[derive(Clone, Copy)]
enum Weight {
    /// [kg/m²]
    OfWeb(f64),
    /// Of the belt [m/s].
    BySpeed(f64),
}

/// How fine a filament is.
#[derive(Clone, Copy)]
enum Size {
    /// [kg/m]
    Titre(f64),
    /// [m]
    Diameter(f64),
}

impl NewLine {
    /// The line of complete numbers.
    ///
    /// # Errors
    /// If a belt of the given speed takes another weight than the given one.
    pub(super) fn new(numbers: &LineNumbers) -> Result<Self, Fault> {
        let or = |given: &Option<Given<f64>>, usual: f64| given.as_ref().map_or(usual, |given| given.value);
        let nan = f64::NAN;
        let width = or(&numbers.width, WIDTH);
        let in_all = numbers.holes.map(|holes| (holes as f64 / width).round().max(1.0) as u64);
        let value = |given: &Option<Given<f64>>| given.as_ref().map(|given| given.value);
        let line = Self {
            polymer: numbers.polymer.as_ref().map_or(Polymer::Pp, |given| given.value),
            throughput: or(&numbers.throughput, nan),
            size: match &numbers.diameter {
                Some(diameter) => Size::Diameter(diameter.value),
                None => Size::Titre(or(&numbers.dtex, nan)),
            },
            weight: match &numbers.belt_speed {
                Some(speed) => Weight::BySpeed(speed.value),
                None => Weight::OfWeb(or(&numbers.basis_weight, nan)),
            },
            holes_per_metre: numbers.holes_per_metre.or(in_all).unwrap_or(1),
            holes: numbers.holes,
            beams: numbers.beams.unwrap_or(1),
            width,
            distance: or(&numbers.distance, DISTANCE),
            air_speed: or(&numbers.air_speed, nan),
            slot_depth: value(&numbers.slot_depth),
            turbulence: value(&numbers.turbulence),
            thickness: value(&numbers.thickness),
        };
        let wanted =
            value(&numbers.basis_weight).filter(|wanted| (line.basis_weight() / wanted - 1.0).abs() > NEARLY);
        match wanted {
            None => Ok(line),
            Some(wanted) => Err(Fault::new(
                format!(
                    "a belt of {} takes {} from these holes, and not {}, which need a belt of {}",
                    speed(line.belt_speed()),
                    Dimension::BasisWeight.pretty(line.basis_weight()),
                    Dimension::BasisWeight.pretty(wanted),
                    speed(line.mass_flow() / wanted),
                ),
                "leave out --belt-speed or --basis-weight, or change throughput and holes",
            )),
        }
    }

    fn density(&self) -> f64 {
        self.polymer.material(false).solid_density
    }

    /// Mass per length of a filament [kg/m].
    fn titre(&self) -> f64 {
        match self.size {
            Size::Titre(titre) => titre,
            Size::Diameter(diameter) => 0.25 * PI * diameter * diameter * self.density(),
        }
    }

    fn feed_speed(&self) -> f64 {
        self.throughput / self.titre()
    }

    /// Mass flow from each metre of width, of all beams [kg/(m s)].
    fn mass_flow(&self) -> f64 {
        (self.beams * self.holes_per_metre) as f64 * self.throughput
    }

    fn belt_speed(&self) -> f64 {
        match self.weight {
            Weight::OfWeb(weight) => self.mass_flow() / weight,
            Weight::BySpeed(speed) => speed,
        }
    }

    fn basis_weight(&self) -> f64 {
        self.mass_flow() / self.belt_speed()
    }

    /// The keys of the numbers that are made up and count for much. Those of the air are factors on what its table has.
    fn guessed(&self) -> String {
        let keys = [
            ("line.depth", self.slot_depth.is_none()),
            ("air.intensity_factor", self.turbulence.is_none()),
            ("air.length_factor", true),
        ];
        keys.into_iter().filter(|(_, is_guess)| *is_guess).map(|(key, _)| key).collect::<Vec<_>>().join(", ")
    }

    /// What is odd about these numbers.
    pub(super) fn warnings(&self) -> Vec<String> {
        let [air, feed] = [self.air_speed, self.feed_speed()].map(speed);
        let slow = format!(
            "the air of {air} is not faster than the filament, {feed}, and cannot draw it: check air speed, \
            throughput and titre"
        );
        (self.air_speed <= self.feed_speed()).then_some(slow).into_iter().collect()
    }

    /// The file of the line: its web, and the case of its filament.
    ///
    /// * `name` – what it is called
    /// * `air` – the file of the air
    pub(super) fn file(&self, name: &str, air: &str) -> String {
        format!(
            "# A spunbond line in its own words; the speeds follow. Each comment says how.\n\
             #\n\
             #     spunlaid check {name}.toml     # these numbers, and those that follow from them\n\
             #     spunlaid web {name}.toml       # flies some filaments, lays the web and says how even it is\n\
             #     spunlaid run {name}.toml       # flies single filaments, and says how each of them moves and lies\n\
             version = 1\n{}{}{}",
            self.holes_and_weight(),
            self.sheet(),
            self.filament(air)
        )
    }

    /// What comes from each beam, and the weight of all.
    fn holes_and_weight(&self) -> String {
        let Self { throughput, weight, holes_per_metre, beams, width, .. } = *self;
        let flow = self.mass_flow();
        let times_beams = if beams > 1 { format!("{beams} beams × ") } else { String::new() };
        let holes = match self.holes {
            Some(holes) => format!("{holes} holes / {}; ", exact_text(Dimension::Length, width)),
            None => String::new(),
        };
        let mut text = String::new();
        for number in 1..=beams {
            let (header, prefix) = match beams {
                1 => (String::new(), ""),
                _ => (format!("\n[[layer]]\nname = \"beam {number}\"\n"), "layer."),
            };
            text += &header;
            let [weight_text, belt] =
                [Dimension::BasisWeight.pretty(self.basis_weight()), speed(self.belt_speed())];
            let of_all = format!(
                "of the whole web: {times_beams}{holes_per_metre} holes/m × {}",
                flow_of_hole(throughput)
            );
            let weight = match weight {
                Weight::OfWeb(weight) => format!(
                    "basis_weight = \"{}\"   # {of_all} / {weight_text} = a belt of {belt}\n",
                    exact_text(Dimension::BasisWeight, weight)
                ),
                Weight::BySpeed(speed) => format!(
                    "belt_speed = \"{} m/min\"   # {of_all} / {belt} = {weight_text}\n",
                    significant(speed * 60.0, GIVEN as i32)
                ),
            };
            text += &format!(
                "\n[{prefix}line]\nthroughput = \"{}\"   # of each hole: {} / {} dtex = fed at {}\n{}\
                 filaments_per_metre = {holes_per_metre}   # {holes}{} kg/h from each metre of width, {} kg/h in all\n",
                exact_text(Dimension::MassFlow, throughput),
                flow_of_hole(throughput),
                significant(self.titre() * 1e7, 4),
                speed(self.feed_speed()),
                if number == 1 { weight } else { String::new() },
                significant(flow / beams as f64 * 3600.0, 4),
                significant(flow / beams as f64 * width * 3600.0, 4),
            );
            text += &format!(
                "depth = \"{}\"   # of the slot{}: the filaments come at an even pitch, each at a random depth\n",
                exact_text(Dimension::Length, self.slot_depth.unwrap_or(DEPTH)),
                if self.slot_depth.is_none() { ", a guess" } else { "" },
            );
        }
        text
    }

    /// The sheet, and which numbers are guesses.
    fn sheet(&self) -> String {
        format!(
            "\n[web]\nwidth = \"{}\"\nlength = \"1 m\"   # of the stretch that is looked at\n\
            # edges = \"cut\"   # if the edges of the web are to be seen; \
            without, it is a part of a wide web\nguessed = \"{}\"   # made up: the CV is also given \
            for half and twice of each; take out what you have measured\n{}",
            exact_text(Dimension::Length, self.width),
            self.guessed(),
            match self.thickness {
                Some(thickness) => format!(
                    "\n[fabric]\nthickness = \"{}\"   # between its bonds\n",
                    exact_text(Dimension::Length, thickness)
                ),
                None => String::new(),
            }
        )
    }

    /// The case of the filament, which is that of all beams.
    fn filament(&self, air: &str) -> String {
        let density = self.density();
        let size = match self.size {
            Size::Titre(titre) => format!(
                "linear_density = \"{} dtex\"   # of {}: √(4 × titre / (π × density))",
                significant(titre * 1e7, GIVEN as i32),
                length((4.0 * titre / (PI * density)).sqrt())
            ),
            Size::Diameter(diameter) => format!(
                "diameter = \"{}\"   # {} dtex: π/4 × diameter² × density",
                exact_text(Dimension::Length, diameter),
                significant(self.titre() * 1e7, 4)
            ),
        };
        // A filament as spun is oriented somewhat.
        let modulus = 1.5 * self.polymer.material(false).unoriented_modulus;
        format!(
            "\n# The filament, from the end of the slot to the belt.\n[fibre]\n{size}\n\
            density = \"{}\"   # of solid {}\nyoungs_modulus = \"{}\"   # half as much again as without \
            orientation, a guess: the lay-down hardly depends on it\n\
            root = \"clamped\"   # the filament leaves the slot straight down\n\n[belt]\n\
            distance = \"{}\"   # from the slot to the belt\n\n[air]\n\
            profile = \"{air}\"   # made up, of the usual shape: replace it by measured or computed air \
            (docs/air.md)\nwidening = \"md\"   # the air slows down because it widens along the belt\n\n\
            [drag]\nacross = \"marheineke-wegener\"   # agrees with measurements\n\n[run]\n\
            duration = \"1 s\"   # longer, or with more replicates: smaller errors\nreplicates = 8\n",
            Dimension::Density.pretty(density),
            self.polymer.name(),
            Dimension::Pressure.pretty_to(modulus, 2),
            exact_text(Dimension::Length, self.distance),
        )
    }

    /// The air between slot and belt: it slows down evenly.
    pub(super) fn air(&self) -> String {
        let row = |[place, velocity]: [f64; 2]| {
            let cutoff = velocity / (4.0 * EDDY);
            let intensity = significant(self.turbulence.unwrap_or(INTENSITY), GIVEN as i32);
            format!("{},{},{intensity},{},{}\n", place * 1e3, velocity, EDDY * 1e3, significant(cutoff, 4))
        };
        let rows = [[0.0, self.air_speed], [self.distance, SLOWED * self.air_speed]].map(row);
        format!(
            "# Air between the slot and the belt: made up, of the usual shape and size (cut-off = velocity / \
            4 / length scale).\nx_mm,velocity_m_s,turbulence_intensity,length_scale_mm,cutoff_frequency_hz\n\
            {}",
            rows.concat()
        )
    }
}

/// A number that was given, with all its digits.
fn exact_text(dimension: Dimension, value: f64) -> String {
    dimension.pretty_to(value, GIVEN)
}

fn length(metres: f64) -> String {
    Dimension::Length.pretty(metres)
}

fn speed(metres_per_second: f64) -> String {
    Dimension::Velocity.pretty(metres_per_second)
}

fn flow_of_hole(kilograms_per_second: f64) -> String {
    Dimension::MassFlow.pretty(kilograms_per_second)
}
