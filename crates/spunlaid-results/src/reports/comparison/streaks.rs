//! Where the streaks of a scan may come from: what one hole, several holes, or a pack of the line beside it would lay.

use super::files::Cause;
use super::web::Web;
use crate::numbers::{HARD, THIN, plus_minus, significant};
use serde_json::{Value as Json, json};
use spunlaid_ground::NORMAL_95;
use spunlaid_web::scan::WIDTH;
use std::f64::consts::{PI, SQRT_2};

/// A period and a pitch that differ by less are the same.
const SAME: f64 = 0.03;
/// A wave that is laid weaker than this cannot be seen in any scan.
const UNSEEN: f64 = 1e-4;

/// σ of the normal profile that fits a rectangle best, over the width of that, and its mass over that of it.
const OF_PACK: f64 = 0.357;
const MASS_OF_PACK: f64 = 1.06;

/// The holes of a layer, and how they lay.
struct LaidLayer {
    /// In words, behind a noun; empty of a line of one layer.
    of: String,
    name: String,
    /// Holes per width over the share of the layer in the basis weight [1/m].
    holes: f64,
    share: f64,
    /// Standard deviation of the positions at which a filament lands [m].
    sigma: f64,
    pitches: Vec<f64>,
}

impl LaidLayer {
    /// Amplitude of the dip that one blocked hole leaves, over the basis weight.             theory.md (115c)
    fn dip(&self) -> f64 {
        1.0 / (self.holes * (2.0 * PI).sqrt() * self.sigma)
    }

    /// Share of a wave across the web that is left when filaments are laid.                  theory.md (115d)
    fn left(&self, period: f64) -> f64 {
        let ratio = PI * self.sigma / period;
        libm::exp(-2.0 * ratio * ratio)
    }
}

/// A streak of a scan, by its file.
struct Streak {
    place: f64,
    amplitude: f64,
    error: f64,
    sigma: f64,
    /// The 95 % interval of its sigma [m].
    range: [f64; 2],
}

/// What the line of a web says of the streaks of a scan; nothing unless one of both is a scan, and the other a line.
pub(super) fn causes(webs: [&Web; 2]) -> Vec<Cause> {
    let lines = webs.map(layers);
    let (scan, line, layers) = match (&webs[0].scan["streaks"], &webs[1].scan["streaks"], lines) {
        (Json::Array(_), _, [_, layers]) if !layers.is_empty() => (webs[0], webs[1], layers),
        (_, Json::Array(_), [layers, _]) if !layers.is_empty() => (webs[1], webs[0], layers),
        _ => return Vec::new(),
    };
    let streaks: Vec<Streak> = list(&scan.scan["streaks"]).filter_map(streak).collect();
    let of_streaks = streaks.iter().map(|streak| of_streak(streak, &layers));
    let of_defects = list(&line.fabric["streaks"]).filter_map(|defect| of_defect(defect, &streaks));
    let of_periods = list(&scan.scan["periods"]).filter_map(|wave| of_period(wave, &layers));
    let of_layers = layers.iter().flat_map(|layer| of_layer(layer, scan));
    of_streaks.chain(of_periods).chain(of_defects).chain(of_layers).collect()
}

fn list(json: &Json) -> impl Iterator<Item = &Json> {
    json.as_array().into_iter().flatten()
}

fn layers(web: &Web) -> Vec<LaidLayer> {
    let Some(width) = web.width else { return Vec::new() };
    let all: Vec<&Json> = list(&web.layers).collect();
    let weight: f64 = all.iter().filter_map(|json| json["basis_weight_kg_m2"].as_f64()).sum();
    let layer = |json: &&Json| {
        let number = |name: &str| json[name].as_f64();
        let name = json["name"].as_str()?.to_owned();
        let share = number("basis_weight_kg_m2")? / weight;
        Some(LaidLayer {
            of: if all.len() > 1 { format!(" of layer {name}") } else { String::new() },
            name,
            holes: number("filaments")? / width / share,
            share,
            sigma: number("laid_sigma_cd_m")?,
            pitches: list(&json["hole_pitch_m"]).filter_map(Json::as_f64).collect(),
        })
    };
    all.iter().filter_map(layer).collect()
}

fn streak(json: &Json) -> Option<Streak> {
    let (widths, [amplitude, error]) = (&json["width_range_m"], height(json)?);
    let end = |names: [&str; 2]| names.into_iter().find_map(|name| widths[name].as_f64());
    let range = [end(["low", "at_least"]).unwrap_or(0.0), end(["high", "at_most"]).unwrap_or(f64::INFINITY)];
    let (place, sigma) = (json["place_m"].as_f64()?, json["width_m"].as_f64()? / WIDTH);
    Some(Streak { place, amplitude, error, sigma, range: range.map(|width| width / WIDTH) })
}

/// An amplitude with its standard error.
fn height(json: &Json) -> Option<[f64; 2]> {
    let amplitude = &json["amplitude"];
    Some([amplitude["value"].as_f64()?, amplitude["standard_error"].as_f64()?])
}

fn per_cent(value: f64) -> String {
    format!("{}{THIN}%", significant(100.0 * value, 2))
}

fn millimetres(length: f64) -> String {
    format!("{}{HARD}mm", significant(1e3 * length, 3))
}

/// What a layer says of a streak: in words, the name of the cause if it is one, and the number of holes.
fn of_streak(streak: &Streak, layers: &[LaidLayer]) -> Cause {
    let Streak { place, amplitude, error, sigma, range } = *streak;
    let said = |layer: &LaidLayer| {
        // The mass of the streak, in that of a hole: of the fit whose width is that of one filament, if it may be that.
        let is_hole = (range[0]..=range[1]).contains(&layer.sigma);
        let wide = if is_hole { sigma.hypot(layer.sigma) / SQRT_2 } else { sigma };
        let mass = amplitude * wide / layer.sigma / layer.dip();
        let off = (mass * error / amplitude).abs();
        let count = plus_minus(mass.abs(), Some(off));
        let (of, laid) = (&layer.of, millimetres(WIDTH * layer.sigma));
        let (cause, words) = if range[1] < layer.sigma {
            let words = format!(
                "narrower than one filament{of} is laid, {laid}: no hole, pack or spacing of holes can cause it. \
                 Check the rolls and the belt after the laydown, or the scanner"
            );
            (None, words)
        } else if range[0] > layer.sigma {
            let pack = (sigma * sigma - layer.sigma * layer.sigma).sqrt() / OF_PACK;
            let change = mass / (MASS_OF_PACK * layer.holes * layer.share * pack);
            let verb = if amplitude < 0.0 { "thinner" } else { "thicker" };
            let words = format!(
                "wider than one filament{of} is laid, {laid}: a pack about {} wide whose filaments are {} {verb}",
                millimetres(pack),
                per_cent(change.abs())
            );
            let possible = change >= -1.0;
            let words = if possible { words } else { format!("{words}, which none can be") };
            (possible.then_some("pack"), words)
        } else if amplitude > 0.0 {
            (Some("holes"), format!("as wide as one filament{of} is laid: {count} holes’ mass is too much"))
        } else if (mass.abs() - 1.0).abs() <= NORMAL_95 * off {
            (Some("blocked_hole"), format!("one blocked hole{of}: it lacks the mass of {count} holes"))
        } else if mass.abs() < 1.0 {
            (Some("holes"), format!("one hole{of} that feeds too little: it lacks the mass of {count} holes"))
        } else {
            (Some("holes"), format!("neighbouring holes{of} are blocked: it lacks the mass of {count} holes"))
        };
        let json = json!({"layer": layer.name, "cause": cause, "holes": mass, "holes_standard_error": off});
        (words, json)
    };
    let (words, json): (Vec<_>, Vec<_>) = layers.iter().map(said).unzip();
    let height = plus_minus(100.0 * amplitude, Some(100.0 * error));
    Cause {
        what: format!(
            "Streak at {}: {height}{THIN}%, {} wide",
            millimetres(place),
            millimetres(WIDTH * sigma)
        ),
        words: words.join("; "),
        json: json!({"streak_at_m": place, "amplitude": amplitude, "standard_error": error, "layers": json}),
    }
}

/// Which spacing of holes, or of packs, makes a period.
fn of_period(wave: &Json, layers: &[LaidLayer]) -> Option<Cause> {
    let (period, [amplitude, error]) = (wave["period_m"].as_f64()?, height(wave)?);
    let said = |layer: &LaidLayer| {
        let (of, left) = (&layer.of, layer.left(period));
        // Of the share of the layer in the basis weight.
        let needed = amplitude / left / layer.share;
        let pitch = layer.pitches.iter().find(|pitch| (*pitch / period - 1.0).abs() < SAME);
        let most = if pitch.is_some() { 2.0 } else { 1.0 };
        let (cause, words) = match pitch {
            _ if needed > most => (
                None,
                format!(
                    "no spacing of holes or packs{of}: of what repeats at this distance its filaments leave {}",
                    per_cent(left)
                ),
            ),
            Some(pitch) => (Some("pitch"), format!("the holes of a row{of}, {} apart", millimetres(*pitch))),
            None => (
                Some("packs"),
                format!("packs{of} at this distance whose throughput varies by ± {}", per_cent(needed)),
            ),
        };
        (words, json!({"layer": layer.name, "cause": cause, "left": left, "variation": needed}))
    };
    let (words, json): (Vec<_>, Vec<_>) = layers.iter().map(said).unzip();
    let height = plus_minus(100.0 * amplitude, Some(100.0 * error));
    Some(Cause {
        what: format!("Period of {}: ± {height}{THIN}%", millimetres(period)),
        words: words.join("; "),
        json: json!({"period_m": period, "amplitude": amplitude, "standard_error": error, "layers": json}),
    })
}

/// Which streak a defect in the file of the line makes: the dip over its band, which was simulated, beside that of the
/// streak over the same band.
fn of_defect(defect: &Json, streaks: &[Streak]) -> Option<Cause> {
    let number = |name: &str| defect[name].as_f64();
    let [place, band, dip] = [number("place_m")?, number("band_m")?, number("dip")?];
    let dip_of = |streak: &Streak| {
        let inside = libm::erf(band / (2.0 * SQRT_2 * streak.sigma));
        -streak.amplitude * (2.0 * PI).sqrt() * streak.sigma / band * inside
    };
    let fits = |streak: &&Streak| {
        let off = dip_of(streak) * streak.error / streak.amplitude;
        (dip_of(streak) - dip).abs() <= NORMAL_95 * off.abs()
    };
    let fitting: Vec<String> = streaks.iter().filter(fits).map(|streak| millimetres(streak.place)).collect();
    let words = match fitting.as_slice() {
        [] => "no streak of the scan is like it".to_owned(),
        all => format!("as deep as the streak at {}", all.join(", ")),
    };
    Some(Cause {
        what: format!("Defect in the file, dip of {} over {}", per_cent(dip), millimetres(band)),
        words,
        json: json!({"defect_at_m": place, "dip": dip, "like_streaks": fitting.len()}),
    })
}

/// What one blocked hole of a layer makes, whether the scan would show it, and what is left of the pitch of its holes.
fn of_layer(layer: &LaidLayer, scan: &Web) -> Vec<Cause> {
    let (of, dip) = (&layer.of, layer.dip());
    let far = |limit: &(f64, f64)| (limit.0 / layer.sigma).ln().abs();
    let limits = list(&scan.scan["streak_limits"])
        .filter_map(|limit| Some((limit["width_m"].as_f64()? / WIDTH, limit["amplitude"].as_f64()?)));
    let least = limits.min_by(|a, b| far(a).total_cmp(&far(b))).filter(|limit| far(limit) < SQRT_2.ln());
    let words = match least {
        None => "too wide or too narrow for this scan to show".to_owned(),
        Some((_, least)) if least <= dip => format!("this scan shows such dips from {} on", per_cent(least)),
        Some((_, least)) => format!(
            "this scan shows such dips from {} on; one {} times as long would show it",
            per_cent(least),
            significant((least / dip).powi(2), 2)
        ),
    };
    let hole = Cause {
        what: format!(
            "One blocked hole{of}: dip of {}, {} wide",
            per_cent(dip),
            millimetres(WIDTH * layer.sigma)
        ),
        words,
        json: json!({"layer": layer.name, "dip_of_one_hole": dip, "least_dip": least.map(|limit| limit.1)}),
    };
    let widest = layer.pitches.iter().copied().reduce(f64::max);
    let pitch = widest.map(|pitch| {
        let left = layer.left(pitch);
        let share = if left < UNSEEN { format!("less than {}", per_cent(UNSEEN)) } else { per_cent(left) };
        let json = json!({"layer": layer.name, "pitch_m": pitch, "left": left});
        let words = "of their wave is left";
        Cause {
            what: format!("Holes{of} {} apart in a row", millimetres(pitch)),
            words: format!("{share} {words}: exp(−2π²σ²/p²) with σ {}", millimetres(layer.sigma)),
            json,
        }
    });
    std::iter::once(hole).chain(pitch).collect()
}
