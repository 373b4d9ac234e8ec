//! The keys of a defect of a line, `line.defects`.

use super::super::access::{Access, WebKey, defect, defect_mut};
use super::MOST_FILAMENTS;
use crate::case::keys::row::{at, key, quantity};
use crate::case::keys::{Kind, Sign};
use crate::units::Dimension;

/// The keys of a defect.
pub(super) const KEYS: &[WebKey] = &[
    quantity("line.defects.from", Dimension::Length, Sign::NotNegative)
        .access(at!(defect, defect_mut, from))
        .follows("from the edge of the web on")
        .meaning(
            "Holes that feed more or less than the others: `defects = [{ from = \"0.5 m\" }, …]`, with where \
             they begin, from the edge of the web. `from` alone is the one hole that is nearest to it, by default a \
             blocked one; with `to`, all holes between.",
        )
        .synonyms(&["blocked hole", "blocked holes", "plugged hole", "defect", "streak"])
        .label("Place where a defect begins")
        .usual(1e-6, 30.0),
    quantity("line.defects.to", Dimension::Length, Sign::NotNegative)
        .access(at!(defect, defect_mut, to))
        .follows("the one hole that is nearest to `from`; without `from`, all across the web")
        .meaning("Where the holes with the defect end, from the edge of the web.")
        .label("Place where a defect ends")
        .usual(1e-6, 30.0),
    key("line.defects.row", Kind::Whole(1, MOST_FILAMENTS))
        .access(at!(defect, defect_mut, row))
        .follows("all rows")
        .meaning("Number of the row of nozzles of `rows` that has the defect, from 1.")
        .label("Row with a defect"),
    quantity("line.defects.share", Dimension::Ratio, Sign::Share)
        .access(at!(defect, defect_mut, share))
        .value("1")
        .meaning("Each of these holes has the defect with this probability, chosen by the seed of the web.")
        .label("Share of the holes with a defect")
        .usual(1e-4, 1.0),
    quantity("line.defects.titre", Dimension::Ratio, Sign::NotNegative)
        .access(at!(defect, defect_mut, titre))
        .value("0")
        .meaning(
            "Mass per length of the filaments from these holes over that of the others, up to 2; 0 of \
            blocked holes. The filaments are taken to lie as the others do.",
        )
        .label("Titre of filaments with a defect")
        .usual(0.05, 2.0),
    quantity("line.defects.after", Dimension::Time, Sign::NotNegative)
        .access(at!(defect, defect_mut, after))
        .value("0 s")
        .meaning(
            "Time from which on it is so, after the sheet began to be laid: a filament that broke, a hole that was \
             blocked then.",
        )
        .label("Time of a defect")
        .usual(1e-6, 1e4),
];
