//! The light of a picture, pixel by pixel: what is missing, the level of the lamp, and its shading.

use super::picture::Picture;
use super::shading::Shading;
use crate::error::Fault;
use crate::units::shortest;

/// One pixel in so many may be filled in.
pub(super) const FILLED: usize = 100;

/// Refuses a setting that is not above zero.
pub(super) fn above_zero(name: &'static str, value: Option<f64>) -> Result<(), Fault> {
    match value {
        Some(value) if !(value.is_finite() && value > 0.0) => Err(Fault::new(
            format!("cannot be read with {name} = {}", shortest(value)),
            "give a number above zero",
        )),
        _ => Ok(()),
    }
}

/// The logarithm of the light that comes through, over that of the lamp if there is a picture of it; NaN
/// where there is none.
pub(super) fn logs(picture: &Picture, lamp: Option<&Picture>) -> Vec<f64> {
    let log = |level: &f64| if level.is_finite() && *level > 0.0 { libm::log(*level) } else { f64::NAN };
    let mut logs: Vec<f64> = picture.values.iter().map(log).collect();
    if let Some(lamp) = lamp {
        let scale = lamp.scale_to(picture);
        logs.iter_mut().zip(&lamp.values).for_each(|(light, lamp)| *light -= log(&(scale * lamp)));
    }
    logs
}

/// Refuses a picture of the lamp of another size.
pub(super) fn same_size(picture: &Picture, lamp: Option<&Picture>) -> Result<(), Fault> {
    let (wanted, found) =
        (picture.whole().sides, lamp.map_or(picture.whole().sides, |lamp| lamp.whole().sides));
    if wanted == found {
        return Ok(());
    }
    let message = format!(
        "has {} × {} pixels, but the picture of the lamp without web has {} × {}",
        wanted[0], wanted[1], found[0], found[1]
    );
    Err(Fault::new(message, "take both with the same camera from the same place").option("--lamp"))
}

/// The grey level of the lamp without web, or of the thickest web in reflected light.
pub(super) fn white_level(
    picture: &Picture,
    white: Option<f64>,
    lamp: Option<&Picture>,
) -> Result<f64, Fault> {
    above_zero("a level of the lamp", white)?;
    if let (Some(white), Some(largest)) = (white, picture.full_scale)
        && white > largest
    {
        let [white, largest] = [white, largest].map(shortest);
        return Err(Fault::new(
            format!("holds grey levels up to {largest}, but the lamp without web is said to have the level {white}"),
            format!("give the level of the lamp in this file, at most {largest}"),
        )
        .option("--white"));
    }
    // Over a picture of the lamp, all light is one.
    if lamp.is_some() {
        return Ok(1.0);
    }
    white.map_or_else(|| largest_level(picture), Ok)
}

/// The largest level that the file can hold, if it is known.
fn largest_level(picture: &Picture) -> Result<f64, Fault> {
    let advice =
        "give the level of the lamp without web, in reflected light of a web too thick to see through";
    let Some(largest) = picture.full_scale else {
        let message = "holds numbers without a largest grey level, so the level of the lamp is not known, \
            and with a guess every CV would be wrong by the same factor";
        return Err(
            Fault::new(message, format!("{advice}, or a picture of the lamp")).option("--white, --lamp")
        );
    };
    let Some(bits) = picture.fewer_bits else { return Ok(largest) };
    let possible = (1u32 << bits) - 1;
    Err(Fault::new(
        format!(
            "has no level above {possible}, though the file has 16 bits, so it is not known whether a camera \
            of {bits} bits made it or the picture is dark, and with a wrong level of the lamp every CV would \
            be wrong by the same factor"
        ),
        format!("{advice}: {possible} if the camera has {bits} bits, else {largest}"),
    )
    .option("--white"))
}

/// Largest shading that is believed to be that of a lamp and a lens, brightest over darkest place. By the law
/// of the fourth power of the cosine a lens that sees 54° darkens so much towards its corners.
const MOST_SHADING: f64 = 1.6;

/// The shading that is to be taken out, if any.
pub(super) fn believed_shading(
    logs: &[f64],
    columns: usize,
    (lamp, keep_shading): (Option<&Picture>, bool),
) -> Result<Option<Shading>, Fault> {
    if keep_shading || lamp.is_some() {
        return Ok(None);
    }
    let shading = Shading::fit(logs, columns);
    if shading.range() > libm::log(MOST_SHADING) {
        let [found, most] =
            [libm::expm1(shading.range()), MOST_SHADING - 1.0].map(|share| (100.0 * share).round());
        return Err(Fault::new(
            format!(
                "becomes brighter by {found} % from its darkest to its brightest part, and a lamp and a lens \
                make {most} % at most: the bare lamp may be visible beside the web, or the web itself \
                changes, and the picture cannot tell which"
            ),
            "give a picture of the lamp without web, or cut out the web, or say that the lamp is even",
        )
        .option("--lamp, --keep-shading"));
    }
    Ok(Some(shading))
}

/// How many values are missing, if they are few enough to be filled in.
pub(super) fn unusable(values: &[f64], what: &'static str, advice: &'static str) -> Result<usize, Fault> {
    let unusable = values.iter().filter(|value| value.is_nan()).count();
    if unusable > values.len() / FILLED {
        return Err(Fault::new(
            format!("has {unusable} pixels of {} that are {what}", values.len()),
            format!("at most one in a hundred can be filled from its neighbours; {advice}"),
        ));
    }
    let first = values.iter().copied().find(|value| !value.is_nan());
    if values.iter().all(|value| value.is_nan() || Some(*value) == first) {
        return Err(Fault::new("has the same value everywhere", "is it the right file?"));
    }
    Ok(unusable)
}

/// The mean of the values that are there.
pub(super) fn mean_of(values: &[f64]) -> f64 {
    let finite = || values.iter().filter(|value| !value.is_nan());
    finite().sum::<f64>() / finite().count() as f64
}

/// `0.25 %`.
pub(super) fn per_cent(share: f64) -> String {
    let digits: f64 = format!("{:.1e}", 100.0 * share).parse().unwrap_or(f64::NAN);
    format!("{} %", shortest(digits))
}
