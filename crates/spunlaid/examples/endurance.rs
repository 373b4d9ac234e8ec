//! Flies fibres with settings drawn at random, and counts those that the guard finds lost and those that it
//! should have found.
//!
//!     cargo run --release --example endurance            # a thousand fibre-seconds, slack fed fibres
//!     cargo run --release --example endurance -- wide    # fed and hanging fibres, settings from wider ranges
//!
//! A setting with a number of its own flies again with `-- slack 17` or `-- wide 17`.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use spunlaid::fibre::{Flight, Job};
use spunlaid::ground::{Error, Isa};
use spunlaid::input::read_case;

/// Fibre-seconds to fly.
const WANTED: f64 = 1000.0;
/// Speed, in parts of what the case lets expect, from which on a node is printed.
const FAST: f64 = 3.0;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let wide = arguments.first().is_some_and(|first| first == "wide");
    let one: Option<u64> = arguments.get(1).and_then(|number| number.parse().ok());
    let folder = std::env::temp_dir().join(format!("spunlaid-endurance-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let mut simulated = 0.0;
    let (mut lost, mut refused) = (0, 0);
    let (mut fast, mut cases) = (0, 0);
    for number in one.unwrap_or(0).. {
        let mut random = Random(Xoshiro256PlusPlus::seed_from_u64(number));
        let text = if wide && random.share() < 0.4 { random.hanging() } else { random.fed(wide, &folder) };
        let file = folder.join("case.toml");
        std::fs::write(&file, &text).unwrap();
        cases += 1;
        match read_case(&file, &[]) {
            Err(_) => refused += 1,
            Ok((case, _)) => {
                let mut worst: f64 = 0.0;
                let driven = case.driving_speed();
                let jobs: Vec<_> = (0..8).map(|replicate| Job::new(&case, replicate)).collect();
                let mut flight = Flight::new(&jobs, Isa::detect()).unwrap();
                let instants = case.run.steps / case.run.output_steps;
                let mut end = Ok(());
                for instant in 1..=instants {
                    end = flight.step_to((instant * case.run.output_steps) as f64 * case.run.time_step);
                    if end.is_err() {
                        break;
                    }
                    let nodes = flight.chain().velocity.iter();
                    let speeds = nodes.flat_map(|v| (0..8).map(move |lane| v.lane(lane).norm()));
                    worst = speeds.fold(worst, f64::max);
                }
                simulated += 8.0 * flight.time();
                if let Err(error) = &end
                    && !matches!(error, Error::NotLanding { .. })
                {
                    lost += 1;
                    println!("{number}: {error}\n{text}");
                } else if worst > FAST * driven {
                    fast += 1;
                    println!("{number}: {worst:.1} m/s, {:.1} times what drives it", worst / driven);
                }
            }
        }
        if one.is_some() || simulated > WANTED {
            break;
        }
    }
    std::fs::remove_dir_all(&folder).unwrap();
    println!(
        "{cases} cases, {refused} refused; {simulated:.0} fibre-seconds simulated; {lost} flights with a lost fibre, \
        {fast} with a fast one"
    );
}

struct Random(Xoshiro256PlusPlus);

impl Random {
    fn share(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Evenly in the logarithm.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.share())
    }

    fn evenly(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    fn of<'a>(&mut self, all: &[&'a str]) -> &'a str {
        all[(self.share() * all.len() as f64) as usize]
    }

    fn fibre(&mut self, diameter: f64, element: f64, wide: bool) -> String {
        let modulus = if wide { self.between(0.05, 100.0) } else { 2.0 };
        let density = if wide { self.between(800.0, 2600.0) } else { 910.0 };
        let root = self.of(&["clamped", "pinned"]);
        format!(
            "version = 1\n[fibre]\ndiameter = \"{diameter} um\"\ndensity = \"{density} kg/m3\"\n\
            youngs_modulus = \"{modulus} GPa\"\nelement_length = \"{element} mm\"\nroot = \"{root}\"\n"
        )
    }

    fn drag(&mut self) -> String {
        let across = self.of(&["marheineke-wegener", "ju-shambaugh"]);
        let along = self.evenly(0.3, 1.0);
        format!("[drag]\nacross = \"{across}\"\nfriction_coefficient = {along}\n")
    }

    /// Air of 0.8 to 1.2 of the feed speed down to the belt; from nothing to three times it in the wider ranges.
    fn fed(&mut self, wide: bool, folder: &std::path::Path) -> String {
        let feed = self.between(if wide { 1.0 } else { 10.0 }, 100.0);
        let belt = feed * self.between(0.01, 0.6);
        let (diameter, element) = (self.between(10.0, 200.0), self.between(1.0, 8.0));
        let distance = self.evenly(0.1, 0.5).max(8e-3 * element);
        let [top, low] = if wide { [0.1, 3.0] } else { [0.8, 1.2] };
        let velocities = [feed * self.evenly(top, low), feed * self.evenly(top, low)];
        let intensity = if self.share() < 0.2 { 0.0 } else { self.evenly(0.0, 0.2) };
        let scale = self.between(4.0, 40.0);
        let mut table =
            "x_mm,velocity_m_s,turbulence_intensity,length_scale_mm,cutoff_frequency_hz\n".to_owned();
        for (x, velocity) in [0.0, 1e3 * distance].into_iter().zip(velocities) {
            table += &format!("{x},{velocity},{intensity},{scale},{}\n", 250.0 * velocity / scale);
        }
        std::fs::write(folder.join("air.csv"), table).unwrap();
        let contact =
            if wide && self.share() < 0.2 { "contact = \"friction\"\nkept_length = \"50 mm\"\n" } else { "" };
        let duration = 12.0 * distance / feed;
        self.fibre(diameter, element, wide)
            + &format!(
                "[feed]\nspeed = \"{feed} m/s\"\n[belt]\ndistance = \"{distance} m\"\nspeed = \"{belt} m/s\"\n{contact}\
                 [air]\nprofile = \"air.csv\"\n"
            )
            + &self.drag()
            + &format!("[run]\nduration = \"{duration} s\"\nreplicates = 8\n")
    }

    /// A fibre of fixed length, with any scheme and the step that the program chooses.
    fn hanging(&mut self) -> String {
        let (length, velocity) = (self.between(0.1, 2.0), self.between(0.5, 200.0));
        let elements = self.between(5.0, 60.0).round();
        let (intensity, scale) = (self.evenly(0.0, 0.4), self.between(5.0, 200.0));
        let scheme = self.of(&["implicit-tension", "implicit-tension", "leapfrog", "semi-implicit-euler"]);
        let duration = if scheme == "implicit-tension" { 2.0 } else { 0.05 };
        let diameter = self.between(5.0, 300.0);
        self.fibre(diameter, 1e3 * length / elements, true)
            + &format!(
                "length = \"{length} m\"\n[air]\nvelocity = \"{velocity} m/s\"\nturbulence_intensity = {intensity}\n\
                 length_scale = \"{scale} mm\"\ncutoff_frequency = \"{} Hz\"\n",
                250.0 * velocity / scale
            )
            + &self.drag()
            + &format!("[run]\nduration = \"{duration} s\"\nscheme = \"{scheme}\"\nreplicates = 8\n")
    }
}
