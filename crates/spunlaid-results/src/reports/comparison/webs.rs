//! Webs side by side, laid or scanned: their CV over patches, their clouds, their pictures and spectra.

use super::Found;
use super::fabric::in_common;
use super::figures::{ComparedPatch, overlaid_webs};
use super::files::{ComparedMeasure, Comparison};
use super::maps::maps;
use super::streaks::causes;
use super::web::{Patch, Web, WebNumber, are_alike, measure};
use crate::Failure;
use crate::numbers::significant;
use crate::reports::finished::read_summary;
use crate::reports::web::figures::clouds::SEEN;
use spunlaid_ground::{Error, Fault, PERCENT, RATIO};
use spunlaid_web::scan::shortest_sharp_wave;
use std::path::PathBuf;

/// Reads the folders if the first holds a web.
///
/// # Errors
/// If a folder cannot be read, or not all hold webs.
pub(super) fn read(folders: &[PathBuf], names: &[String]) -> Result<Option<Vec<Web>>, Failure> {
    let mut webs = Vec::new();
    for (folder, name) in folders.iter().zip(names) {
        match Web::new(folder, name, &read_summary(folder)?) {
            Some(web) => webs.push(web),
            None if webs.is_empty() => return Ok(None),
            None => {
                let message =
                    format!("cannot be compared: it holds no web, and {} does", folders[0].display());
                return Err(Error::folder(folder, Fault::new(message, "compare webs with webs")));
            }
        }
    }
    Ok(Some(webs))
}

/// Every web against the first, all curves in one picture each, and their pictures.
///
/// # Errors
/// If a web has no patches like those of the first.
pub(super) fn compared(webs: &[Web]) -> Result<Found, Failure> {
    let comparisons =
        webs.iter().skip(1).map(|other| compare_webs(&webs[0], other)).collect::<Result<_, _>>()?;
    let drawn = |patch: &Patch| ComparedPatch {
        side: patch.side,
        cv: patch.cv.value,
        standard_error: patch.cv.standard_error,
        interval: patch.cv.interval(),
    };
    let curves: Vec<_> =
        webs.iter().map(|web| (web.name.clone(), web.patches.iter().map(drawn).collect())).collect();
    let maps = maps(webs);
    let figures = std::iter::once(overlaid_webs(&curves)).chain(maps.spectra).collect();
    Ok(Found { comparisons, figures, pictures: maps.pictures, notes: maps.notes })
}

fn compare_webs(first: &Web, other: &Web) -> Result<Comparison, Failure> {
    let has = |web: &Web, side: f64| web.sides().any(|own| are_alike(own, side));
    if !first.sides().any(|side| has(other, side)) {
        let sides = |web: &Web| {
            let sides: Vec<String> = web.sides().map(|side| significant(side * 1e3, 3)).collect();
            format!("{} mm", sides.join(", "))
        };
        let message = format!(
            "cannot be compared: it has no patches of the same size as {}, which has {}; this one has {}",
            first.name,
            sides(first),
            sides(other)
        );
        let fault = Fault::new(message, "give both the same sizes with web.patches or --patches");
        return Err(Error::folder(&other.folder, fault));
    }
    let of_patch = |side: f64, [whose, end]: [&str; 2], values: [Result<WebNumber, String>; 2]| {
        let side = significant(side * 1e3, 3);
        let label = format!("{whose} over patches of {side} mm");
        let column = format!("cv_{side}_mm{end}");
        measure(label, column, PERCENT, values, None)
    };
    let mut sides: Vec<f64> = first.sides().collect();
    sides.extend(other.sides().filter(|side| !has(first, *side)));
    sides.sort_by(f64::total_cmp);
    let of_map = |side: f64| of_patch(side, ["CV", ""], [first.cv(side), other.cv(side)]);
    let mut measures: Vec<ComparedMeasure> = sides.into_iter().map(of_map).collect();
    let of_clouds = [
        ("cloudiness index", "cloudiness", PERCENT, blur_objection([first, other])),
        ("texture along MD", "texture_md", RATIO, wave_mismatch(first, other)),
    ];
    for (i, (label, column, unit, objection)) in of_clouds.into_iter().enumerate() {
        if let (Some(a), Some(b)) = (first.clouds[i].clone(), other.clouds[i].clone()) {
            measures.push(measure(label.to_owned(), column.to_owned(), unit, [Ok(a), Ok(b)], objection));
        }
    }
    measures.extend(in_common([first, other]));
    let weight = |web: &Web| {
        web.weight
            .map_or_else(|| "unknown".to_owned(), |weight| format!("{} g/m²", significant(weight * 1e3, 3)))
    };
    Ok(Comparison {
        run: other.name.clone(),
        against: first.name.clone(),
        pairs: None,
        reason: format!(
            "as independent pieces of web; basis weight {} against {}",
            weight(other),
            weight(first)
        ),
        errors: "CV of the basis weight over square patches, ± one standard error: from the waves of each piece of \
            web and, where a sample of filaments was simulated, from its small size.",
        measures,
        causes: causes([first, other]),
    })
}

/// Why the cloudiness of webs cannot be compared, if blur has lowered the shortest of its waves.
fn blur_objection(webs: [&Web; 2]) -> Option<String> {
    let is_below = |cell: f64| SEEN[0] < shortest_sharp_wave(cell);
    let blurred = webs.iter().filter(|web| web.has_camera && web.cell.is_some_and(is_below));
    let names: Vec<&str> = blurred.map(|web| web.name.as_str()).collect();
    let wave = significant(SEEN[0] * 1e3, 3);
    (!names.is_empty())
        .then(|| format!("waves of {wave} mm are below the blur of the scan ({})", names.join(", ")))
}

/// Why the texture of two webs cannot be compared: it is that of waves of four to sixteen cells, and says
/// nothing about other waves.
fn wave_mismatch(first: &Web, other: &Web) -> Option<String> {
    let (a, b) = (first.cell?, other.cell?);
    let shown = |cell: f64| significant(cell * 1e3, 3);
    (!are_alike(a, b)).then(|| {
        format!("in waves of 4 to 16 cells, and the cells are {} and {} mm wide", shown(a), shown(b))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reports::comparison::web::tests::number;

    #[test]
    fn the_ends_that_face_each_other_decide_and_a_doubt_leaves_no_verdict() {
        let compared =
            |values: [WebNumber; 2]| measure(String::new(), String::new(), RATIO, values.map(Ok), None);
        // Upwards the first reaches 13, downwards the second 11.1; the logarithms have this distance together.
        let [a, b] = [number(10.0, Some([9.9, 13.0])), number(15.1, Some([11.1, 30.0]))];
        let far = (13.0_f64 / 10.0).ln().hypot((15.1_f64 / 11.1).ln());
        for values in [[a.clone(), b.clone()], [b.clone(), a.clone()]] {
            let difference = compared(values).difference.unwrap();
            let share = difference.half_width() / difference.value.abs();
            assert!((share - far / 1.51_f64.ln()).abs() < 1e-6 && difference.is_significant());
        }
        let mut doubtful = a;
        doubtful.doubt = Some("below the blur".to_owned());
        let found = compared([doubtful, b]);
        assert_eq!((found.difference, found.cells()[3].as_str()), (None, "below the blur"));
    }

    /// A CV of few waves, whose interval reaches up to the other one. Its square, its root and its inverse are judged
    /// as it is, and the interval stands beside the verdict, because the standard errors alone would say the contrary.
    #[test]
    fn invariant_a_number_and_its_powers_have_one_verdict() {
        let cv = |value: f64, error: f64, ends: Option<[f64; 2]>| WebNumber {
            standard_error: Some(error),
            ..number(value, ends)
        };
        for (first, second, is_beyond) in [
            (cv(19.8, 1.3, None), cv(8.6, 1.2, Some([7.45, 23.8])), false),
            (cv(19.8, 1.3, Some([17.4, 22.6])), cv(8.6, 1.2, Some([7.45, 11.4])), true),
            (cv(0.198, 0.013, None), cv(0.086, 0.012, None), true),
        ] {
            let of = |power: i32| {
                let power_of = |web: &WebNumber| WebNumber {
                    value: web.value.powi(power),
                    standard_error: web.error_of_power(power),
                    ends: web.ends_of_power(power),
                    doubt: None,
                };
                let values = [power_of(&first), power_of(&second)];
                measure(String::new(), String::new(), RATIO, values.map(Ok), None)
            };
            let distance = |power: i32| {
                let difference = of(power).difference.unwrap();
                assert_eq!(difference.is_significant(), is_beyond, "{power}: {difference:?}");
                difference.value.abs() / difference.half_width()
            };
            for power in [2, -1] {
                assert!((distance(power) / distance(1) - 1.0).abs() < 1e-9, "{power}");
            }
            let verdict = of(1).cells()[3].clone();
            let expected = if first.value > 1.0 && !is_beyond {
                "not significant: 8.6 has the 95 % interval 7.45 to 23.8"
            } else {
                "significant"
            };
            assert_eq!(verdict, expected);
        }
    }
}
