//! What a file lacks, and which of its arrays may be meant.

use super::arrays::Arrays;
use super::names::{ENDINGS, EPSILON, K, Measure};
use spunlaid_ground::Fault;
use spunlaid_ground::error::{nearest_word, one_of};
use spunlaid_ground::units::excerpt;

/// Longest name of an array that a message proposes.
const LONGEST: usize = 60;

/// The fault of a file without the velocity.
pub(super) fn velocity(arrays: &Arrays<'_>) -> Fault {
    if let Some(request) = Measure::Velocity.request(arrays.layout) {
        return array(arrays, request, Measure::Velocity);
    }
    let (key, likely) = (Measure::Velocity.key(), likely_velocities(arrays));
    let likely: Vec<&str> = likely.iter().map(String::as_str).take(3).collect();
    let remedy = match likely.len() {
        0 => format!(
            "name it U or velocity, with three components, or write u, v and w, or name its arrays with {key}"
        ),
        1 => format!("write {key} = {} if this is it", one_of(&likely)),
        _ => format!("write {key} = {}, whichever it is", one_of(&likely)),
    };
    Fault::new(format!("none of the arrays is a velocity ({})", arrays.listed()), remedy)
}

/// The fault of a velocity that is zero everywhere, as a mean is before its averaging has begun, beside others.
///
/// * `others` – arrays that may be the velocity
pub(super) fn movement(sources: &[(&'static str, String)], others: &[String]) -> Option<Fault> {
    let (name, key) = (Measure::Velocity.name(), Measure::Velocity.key());
    let (_, read) = sources.iter().find(|(quantity, _)| *quantity == name)?;
    let others: Vec<&str> = others.iter().map(String::as_str).filter(|other| other != read).take(3).collect();
    (!others.is_empty()).then(|| {
        Fault::new(
            format!(
                "has a velocity that is zero everywhere ({read}), as a mean is before its averaging begins"
            ),
            format!("write {key} = {} for another array", one_of(&others)),
        )
    })
}

/// The arrays that may be the velocity, as the key takes them: those of three components, or else three with
/// the endings of components.
pub(super) fn likely_velocities(arrays: &Arrays<'_>) -> Vec<String> {
    let short = |name: &str| can_be_written(name) && !name.contains(',');
    let named = |i: usize| arrays.names[i].written.trim();
    let all = || (0..arrays.names.len()).filter(|i| short(named(*i)));
    let vectors: Vec<String> =
        all().filter(|i| arrays.components[*i] == 3).map(|i| named(i).to_owned()).collect();
    if !vectors.is_empty() {
        return vectors;
    }
    let of_parts = |i: usize| {
        let vector = ENDINGS.iter().find_map(|[first, ..]| arrays.names[i].plain.strip_suffix(first))?;
        let vector = vector.trim_end_matches('_');
        let parts = arrays.with_endings(vector).ok().flatten().filter(|_| !vector.is_empty())?;
        let names: Vec<&str> = parts.iter().flatten().map(|(array, _)| named(*array)).collect();
        Some(names.join(", "))
    };
    all().filter(|i| arrays.components[*i] == 1).filter_map(of_parts).collect()
}

/// The fault of an array that a case names and the file does not have, or not so.
pub(super) fn array(arrays: &Arrays<'_>, request: &str, measure: Measure) -> Fault {
    let key = measure.key();
    let parts: Vec<&str> = match measure {
        Measure::Velocity => request.split(',').map(str::trim).collect(),
        _ => vec![request.trim()],
    };
    let there_are = format!("the arrays are {}", arrays.listed());
    for part in &parts {
        if arrays.components_of(part, measure).is_none() {
            let known = arrays.names.iter().map(|name| name.written.as_str());
            let remedy = match nearest_word(part, known) {
                Some(nearest) => {
                    format!("did you mean \"{}\"? ", excerpt(nearest, LONGEST)) + "T" + &there_are[1..]
                }
                None => there_are,
            };
            return Fault::new(format!("has no array \"{}\", which {key} names", excerpt(part, 40)), remedy);
        }
    }
    let found: Vec<String> = parts
        .iter()
        .filter_map(|part| Some((part, arrays.components_of(part, measure)?)))
        .map(|(part, count)| {
            format!("\"{}\" of {count} component{}", excerpt(part, 40), if count == 1 { "" } else { "s" })
        })
        .collect();
    let needed = match measure {
        Measure::Velocity => {
            "one array of three components, or two or three arrays of one with commas between them, all at \
            points or all in cells"
        }
        _ => "an array of one component",
    };
    Fault::new(format!("{key} names {}, and it takes {needed}", found.join(" and ")), there_are)
}

/// What a file lacks for turbulence, the arrays that it has, and what to do about it; none if it has all.
pub(super) fn turbulence(arrays: &Arrays<'_>) -> Option<Fault> {
    let has = |measure| arrays.scalar(measure).is_ok_and(|found| found.is_some());
    let lacks = [!has(Measure::K), !has(Measure::Epsilon) && !has(Measure::Omega)];
    let missing = match lacks {
        [false, false] => return None,
        [false, true] => "has k but neither ε nor ω",
        [true, false] => "has ε or ω but no k",
        [true, true] => "has neither k nor ε nor ω",
    };
    let mut free = unused_scalars(arrays);
    let mut offers = Vec::new();
    for (measure, usual) in [(Measure::K, &K[..]), (Measure::Epsilon, &EPSILON[..])] {
        if lacks[usize::from(measure != Measure::K)] && !free.is_empty() {
            let with_unit = free.iter().position(|array| arrays.names[*array].has_unit(measure));
            let plain = |array: &usize| arrays.names[*array].plain.as_str();
            let like = |usual: &&str| {
                let nearest = nearest_word(usual, free.iter().map(plain))?;
                free.iter().position(|array| plain(array) == nearest)
            };
            let likely = with_unit.or_else(|| usual.iter().find_map(like)).unwrap_or(0);
            offers.push(format!(
                "{} = \"{}\"",
                measure.key(),
                arrays.names[free.remove(likely)].written.trim()
            ));
        }
    }
    let remedy = match offers.is_empty() {
        true => "write these arrays too".to_owned(),
        false => format!(
            "write these arrays too, or name those that have other names, like {}",
            offers.join(" and ")
        ),
    };
    Some(Fault::new(format!("{missing} among {}", arrays.listed()), remedy))
}

/// The arrays of one component that are nothing else that is read.
fn unused_scalars(arrays: &Arrays<'_>) -> Vec<usize> {
    let used = arrays.used().unwrap_or_default();
    let is_free = |i: &usize| {
        arrays.components[*i] == 1 && can_be_written(arrays.names[*i].written.trim()) && !used.contains(i)
    };
    (0..arrays.names.len()).filter(is_free).collect()
}

/// Whether a message may say that the name of an array is to be written.
fn can_be_written(name: &str) -> bool {
    name.len() <= LONGEST && !name.contains(char::is_control)
}
