//! The units of values as they are kept, in words that other programs read.

use super::Dimension;
use super::spelling::plain_spelling;

/// The SI unit of a multiple of it, or of a quotient of such multiples: `m²/Hz` of `mm²/Hz`, `kg/m` of `dtex`.
pub fn si_unit_of(multiple: &str) -> String {
    const POWERS: &[char] = &['²', '³'];
    let known = |symbol: &str| Dimension::all().find(|d| d.units().iter().any(|unit| unit.shown == symbol));
    // Kilometres are shown, though no key takes them.
    let of_thousands = |symbol: &str| symbol.strip_prefix('k').and_then(known);
    let si = |symbol: &str| {
        // No key takes watts.
        if symbol == "kW" {
            return "W".to_owned();
        }
        let dimension = known(symbol).or_else(|| of_thousands(symbol));
        dimension.map_or_else(|| symbol.to_owned(), |d| d.si_unit().to_owned())
    };
    if known(multiple).is_some() {
        return si(multiple);
    }
    let part = |part: &str| {
        let symbol = part.trim_end_matches(POWERS);
        si(symbol) + &part[symbol.len()..]
    };
    multiple.split('/').map(part).collect::<Vec<_>>().join("/")
}

/// A unit in the spelling of UDUNITS, which the CF conventions ask for and programs read: `m2/Hz`, `degC`;
/// `1` of a plain number.
pub fn udunits(unit: &str) -> String {
    match unit {
        "" => "1".to_owned(),
        "%" => "percent".to_owned(),
        "°" => "degree".to_owned(),
        _ => plain_spelling(unit).replace('°', "deg").replace('½', "0.5"),
    }
}
