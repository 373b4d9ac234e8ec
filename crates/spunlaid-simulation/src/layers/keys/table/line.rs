//! The keys of the table `[line]`, with the defects of a line, `line.defects`.

use super::super::access::{
    Access, WebKey, defect, defect_mut, filament, filament_mut, given, in_rows, is_flown, layer, layer_mut,
    row, row_mut,
};
use super::{EITHER, MOST_FILAMENTS, positive};
use spunlaid_fibre::FilamentFeed;
use spunlaid_fibre::case::keys::row::{at, key, number, quantity, whole};
use spunlaid_fibre::case::keys::{EVEN, Kind, Sign, Value, row_of};
use spunlaid_ground::{Dimension, Fault};
use spunlaid_web::map::Filaments;

/// In the order of the file.
pub(super) const KEYS: &[WebKey] = &[
    row_of("feed.speed")
        .of_input(given!(feed, FilamentFeed::Speed))
        .called("line.feed_speed")
        .derived(is_flown)
        .gives_case(&["feed.speed"])
        .required("50 m/s")
        .meaning(
            "Speed at which each filament is fed: the spinning speed. It may replace `feed.speed` of a \
             simulated filament.",
        ),
    row_of("spinline.throughput")
        .of_input(given!(feed, FilamentFeed::Throughput))
        .named("line.throughput")
        .alternative_to(&["line.feed_speed"], EITHER)
        .in_other_words(|web| Some(filament(web)?.throughput().into()))
        .gives_case(&["feed.speed", "spinline.throughput"])
        .follows("`feed_speed` and the filament give it")
        .meaning(
            "Mass flow of a hole, instead of `line.feed_speed`, which is then throughput / linear \
             density. For a simulated filament it gives `feed.speed` or `spinline.throughput`.",
        ),
    row_of("belt.speed")
        .of_input(Access {
            get: |web| layer(web).filter(|_| web.basis_weight.is_none()).map(|_| web.belt_speed.into()),
            set: |web, value| {
                layer_mut(web)?;
                web.belt_speed = number(value)?;
                web.basis_weight = None;
                Ok(())
            },
        })
        .called("line.belt_speed")
        .above_zero()
        .derived(is_flown)
        .gives_case(&["belt.speed"])
        .of_all_layers("all layers lie on one belt")
        .required("3 m/s")
        .meaning(
            "Speed of the belt, written in one of the layers. It may replace `belt.speed` of a simulated filament.",
        ),
    positive("line.basis_weight", Dimension::BasisWeight, (1e-3, 2.0))
        .access(Access {
            get: |web| layer(web).and(web.basis_weight).map(Value::Number),
            set: |web, value| {
                layer_mut(web)?;
                let basis_weight = number(value)?;
                web.belt_speed = web.belt_speed_for(basis_weight);
                web.basis_weight = Some(basis_weight);
                Ok(())
            },
        })
        .alternative_to(&["line.belt_speed"], EITHER)
        .gives_case(&["belt.speed"])
        .read_last()
        .of_all_layers("it is the weight of all layers together")
        .follows("`belt_speed` and the filaments give it")
        .meaning(
            "Mass of the web per area, of all layers together, written in one of them. It replaces \
             `line.belt_speed`, which follows from it.",
        )
        .synonyms(&["grammage", "mass per area", "surface weight"])
        .label("Basis weight"),
    row_of("air.cabin_pressure")
        .of_input(Access {
            get: |web| layer(web)?.source.case()?.air.cabin_pressure.map(Value::Number),
            set: |_, _| Err(Fault::needs("a simulated filament", "leave it out")),
        })
        .unrelated()
        .called("line.cabin_pressure")
        .derived(is_flown)
        .gives_case(&["air.cabin_pressure"])
        .follows("the air of the case gives its speed")
        .meaning("The same as `air.cabin_pressure` of a simulated filament, which it may replace."),
    key("line.filaments_per_metre", Kind::Whole(1, MOST_FILAMENTS))
        .access(Access {
            get: |web| match layer(web)?.filaments {
                Filaments::AtRandom { per_metre } | Filaments::Slot { per_metre, .. } => {
                    Some(Value::Whole(per_metre.round() as u64))
                }
                Filaments::Rows(_) => None,
            },
            set: |web, value| {
                let filaments = &mut layer_mut(web)?.filaments;
                let per_metre = whole(value)? as f64;
                *filaments = match *filaments {
                    Filaments::Slot { depth, .. } => Filaments::Slot { per_metre, depth },
                    _ => Filaments::AtRandom { per_metre },
                };
                Ok(())
            },
        })
        .alternative_to(&["line.rows"], "filaments are at random positions or in rows; keep one")
        .follows("`rows`")
        .varies()
        .meaning(
            "Filaments per metre of width, at random positions, or with `slot_gap` at a uniform pitch. The \
             nearest whole number is laid.",
        )
        .synonyms(&["holes per metre", "capillaries per metre"])
        .label("Filaments per metre"),
    quantity("line.slot_gap", Dimension::Length, Sign::NotNegative, (1e-4, 1.0))
        .access(Access {
            get: |web| match layer(web)?.filaments {
                Filaments::Slot { depth, .. } => Some(depth.into()),
                _ => None,
            },
            set: |web, value| {
                let filaments = &mut layer_mut(web)?.filaments;
                *filaments = match *filaments {
                    Filaments::Slot { per_metre, .. } | Filaments::AtRandom { per_metre } => {
                        Filaments::Slot { per_metre, depth: number(value)? }
                    }
                    Filaments::Rows(_) => return Err(in_rows()),
                };
                Ok(())
            },
        })
        .follows("random positions in cross direction, all in the middle of the slot")
        .meaning(
            "Gap of the slot in machine direction. The `filaments_per_metre` then have a uniform pitch across the \
             web and random positions in the gap. The gap also gives the load of the filaments on the air.",
        )
        .label("Slot gap"),
    quantity("line.charge", Dimension::SpecificCharge, Sign::Any, (1e-5, 1e-2))
        .access(at!(layer, layer_mut, charge))
        .follows("none")
        .meaning(
            "Charge per mass of simulated filaments from a charging bar; they repel each other along the machine \
             direction. No measured charge of a spunbond line is known.",
        )
        .synonyms(&["charging", "electrostatic", "corona", "electret"])
        .label("Charge of the filaments"),
    positive("line.walls", Dimension::Length, (1e-3, 1.0))
        .access(Access {
            get: |web| layer(web)?.walls.map(Value::Number),
            set: |web, value| {
                let layer = layer_mut(web)?;
                if layer.charge.is_none() {
                    let remedy = "write the charge of the filaments, or leave it out";
                    return Err(Fault::needs("line.charge", remedy));
                }
                layer.walls = Some(number(value)?);
                Ok(())
            },
        })
        .follows("no plates")
        .meaning(
            "With `line.charge`: distance of two earthed plates from the middle of the slot, from inlet to belt. \
             The nearer one attracts the curtain. They stop no filament.",
        )
        .synonyms(&["plates", "images"])
        .label("Distance of earthed plates"),
    quantity("line.rows.offset", Dimension::Length, Sign::Any, (1e-6, 30.0))
        .access(at!(row, row_mut, offset))
        .value("0 mm")
        .meaning(
            "Position of the first hole of a row, from the edge of the web. Rows replace `filaments_per_metre`: \
             `rows = [{ offset = \"0 mm\", pitch = \"0.2 mm\", filaments = 5000 }, …]`.",
        )
        .label("Position of the first hole"),
    positive("line.rows.pitch", Dimension::Length, (1e-6, 1.0))
        .access(Access {
            get: |web| row(web).map(|row| if row.is_even { EVEN.into() } else { row.pitch.into() }),
            set: |web, value| {
                let (width, row) = (web.sheet.width, row_mut(web)?);
                row.is_even = matches!(value, Value::Text(word) if word == EVEN);
                row.pitch = if row.is_even { width / row.filaments as f64 } else { number(value)? };
                Ok(())
            },
        })
        .required("0.2 mm")
        .or_words(&[EVEN])
        .meaning(
            "Distance from hole to hole in a row, or `\"even\"`: the width of the web over their number. \
             With periodic edges, pitch times filaments is the width.",
        )
        .label("Pitch of the holes"),
    key("line.rows.filaments", Kind::Whole(1, MOST_FILAMENTS))
        .access(Access {
            get: |web| Some(row(web)?.filaments.into()),
            set: |web, value| {
                let (width, row) = (web.sheet.width, row_mut(web)?);
                row.filaments = whole(value)?;
                if row.is_even {
                    row.pitch = width / row.filaments as f64;
                }
                Ok(())
            },
        })
        .required("5000")
        .varies()
        .meaning("Number of holes in a row.")
        .synonyms(&["holes", "nozzles", "capillaries"])
        .label("Holes in a row"),
    quantity("line.rows.md", Dimension::Length, Sign::Any, (1e-5, 1.0))
        .access(at!(row, row_mut, md))
        .value("0 mm")
        .meaning(
            "Position of the row in machine direction, from the middle of the slot. It matters for \
             simulated filaments.",
        )
        .label("Position of the row in machine direction"),
];

/// The keys of a defect.
pub(super) const DEFECTS: &[WebKey] = &[
    quantity("line.defects.from", Dimension::Length, Sign::NotNegative, (1e-6, 30.0))
        .access(at!(defect, defect_mut, from))
        .follows("from the edge of the web on")
        .meaning(
            "Start of the holes with a defect, from the edge of the web: `defects = [{ from = \"0.5 m\" }, …]`. \
             `from` alone is the nearest hole, by default a blocked one; with `to`, all holes between.",
        )
        .synonyms(&["blocked hole", "blocked holes", "plugged hole", "defect", "streak", "stripe"])
        .label("Position where a defect begins"),
    quantity("line.defects.to", Dimension::Length, Sign::NotNegative, (1e-6, 30.0))
        .access(at!(defect, defect_mut, to))
        .follows("the one hole that is nearest to `from`; without `from`, all across the web")
        .meaning("Where the holes with the defect end.")
        .label("Position where a defect ends"),
    key("line.defects.row", Kind::Whole(1, MOST_FILAMENTS))
        .access(at!(defect, defect_mut, row))
        .follows("all rows")
        .meaning("Number of the row of `rows` that has the defect, from 1.")
        .label("Row with a defect"),
    quantity("line.defects.share", Dimension::Ratio, Sign::Share, (1e-4, 1.0))
        .access(at!(defect, defect_mut, share))
        .value("1")
        .meaning("Probability with which each of these holes has the defect, chosen by the seed of the web.")
        .label("Fraction of the holes with a defect"),
    quantity("line.defects.titre", Dimension::Ratio, Sign::NotNegative, (0.05, 2.0))
        .access(at!(defect, defect_mut, titre))
        .value("0")
        .meaning(
            "Mass per length of these filaments over that of the others, up to 2; 0 for blocked holes. They are \
             laid like the others.",
        )
        .label("Titre of filaments with a defect"),
    quantity("line.defects.after", Dimension::Time, Sign::NotNegative, (1e-6, 1e4))
        .access(at!(defect, defect_mut, after))
        .value("0 s")
        .meaning(
            "Time after the beginning of the sheet at which the defect begins: when a filament broke or a \
             hole was blocked.",
        )
        .label("Time of a defect"),
];
