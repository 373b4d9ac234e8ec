//! The columns of OpenFOAM's probes of a velocity, which it writes without names:
//!
//! ```text
//! # Probe 0 (0.1 0 0)
//! #       Probe             0
//! #        Time
//! 0.001 (10.04 0.1 -0.2)
//! ```

/// Names with units of the time and of three components at each probe; OpenFOAM writes in SI units. None if the lines
/// above the numbers are not those of as many probes as the rows have.
pub(super) fn names<'a>(above: impl Iterator<Item = &'a str>, cells: usize) -> Option<Vec<String>> {
    let place = |line: &'a str| {
        let (number, place) = line.trim_start_matches(['#', ' ']).strip_prefix("Probe")?.split_once('(')?;
        let number: usize = number.trim().parse().ok()?;
        place.contains(')').then_some(number)
    };
    let probes: Vec<usize> = above.filter_map(place).collect();
    let components = |probe: &usize| {
        let at = if probes.len() > 1 { format!(" at probe {probe}") } else { String::new() };
        ["Ux", "Uy", "Uz"].map(|name| format!("{name}{at} [m/s]"))
    };
    let names = std::iter::once("Time [s]".to_owned()).chain(probes.iter().flat_map(components));
    (!probes.is_empty() && cells == 1 + 3 * probes.len()).then(|| names.collect())
}
