//! What a reader of the results must know about the picture.

use super::ScanWarning;
use super::findings::{PatchFindings, Settings};
use super::levels::per_cent;
use super::picture::Picture;
use super::spots::ForeignParts;
use super::weigh::{Light, WeighedPicture};
use spunlaid_ground::units::{rounded, shortest};
use spunlaid_ground::{Dimension, Fault};

/// A larger difference between two sides of a pixel is not one of rounding.
const OTHER: f64 = 0.01;
/// Dots per inch that programs write into files when they do not know the resolution.
const UNKNOWN: [f64; 2] = [72.0, 96.0];
/// A larger share of pixels changes the CV.
const MANY: f64 = 1e-3;

/// What was assumed, corrected or left out, in the order in which it was done, and what to do about it.
///
/// * `light` – what the levels mean, with the level of the lamp that was used
/// * `is_even` – whether a border around the web shows that the light is even
pub(super) fn notes(
    picture: &Picture,
    settings: &Settings,
    light: Light,
    is_even: bool,
    weighed: &WeighedPicture,
    patches: &[PatchFindings],
    aside: &ForeignParts,
) -> Vec<Fault> {
    let mut notes: Vec<Fault> = side_of_a_pixel(picture).into_iter().collect();
    if picture.colour {
        notes.push(Fault::plain("the image has colours, and only its luminance is used"));
    }
    if let Some(coding) = picture.coding.filter(|_| !matches!(settings.light, Light::Weight { .. })) {
        notes.push(Fault::new(
            format!(
                "the file says that its levels are coded for a screen ({coding}), and they are taken as proportional \
                 to light: if they are coded, every CV is wrong, often by a fifth"
            ),
            "scan and save it with linear levels (gamma 1), or without this mark if they are linear",
        ));
    }
    if picture.more {
        notes.push(Fault::plain("the file has several images, and only the first of the largest is used"));
    }
    notes.extend(numbers(picture.numbered));
    if let Light::Transmitted { .. } = settings.light {
        notes.extend(bits(picture, settings.lamp.as_ref()));
    }
    if settings.light_is_assumed && matches!(settings.light, Light::Transmitted { .. }) {
        let message = "the image is taken as light that has come through the web, so that heavy places are dark; if \
            light fibres lie on a dark ground, heavy places are light, and every CV is wrong";
        notes.push(Fault::new(message, "say which light it is").option("--light reflected"));
    }
    match (light, weighed.white) {
        (Light::Transmitted { white: None, .. }, Some(white)) => {
            notes.push(assumed_lamp(white));
        }
        (Light::Reflected { white: None, .. }, Some(white)) => {
            notes.push(assumed_thickest(white));
        }
        _ => {}
    }
    if matches!(settings.light, Light::Reflected { .. }) {
        notes.push(Fault::plain(
            "the basis weight follows from the reflected light by Kubelka’s law, for fibres that scatter \
            light and absorb none on a black ground. Colour, gloss and a grey ground make it wrong, and \
            the image cannot show that",
        ));
    }
    if !weighed.mean_known {
        let message = "the mean basis weight is not known, so all basis weights are given relative to it";
        notes.push(Fault::plain(message));
    }
    if settings.light == (Light::Weight { mean: None }) && picture.weight_of_black.is_none() {
        let mean = weighed.map.basis_weight();
        let shown = Dimension::BasisWeight.pretty(mean);
        let message = format!("the values are taken as basis weights in kg/m², with a mean of {shown}");
        notes.push(Fault::plain(message));
    }
    if let Some(shading) = &weighed.shading {
        notes.push(Fault::new(
            format!(
                "the lamp is brighter by {} in its brightest part than in its darkest. A polynomial of \
                second order was taken out. It also took out what the web itself varies as smoothly over \
                the whole image, and it left what a polynomial cannot follow, so no interval is given",
                per_cent(libm::expm1(shading.range()))
            ),
            "take an image of the lamp without web, or say that the lamp is uniform",
        ));
    }
    notes.extend(bare_lamp(aside, settings, light != settings.light));
    if is_even && !settings.keep_shading && settings.lamp.is_none() {
        notes.push(Fault::plain(
            "the border has the same level on all its sides, so the light is taken as uniform: no shading \
             is taken out",
        ));
    }
    notes.extend(dark_spots(aside));
    notes.extend(odd_pixels(picture, weighed));
    if patches.first().is_some_and(|patch| !patch.is_sharp()) {
        let sharp = patches.iter().find(|patch| patch.is_sharp());
        notes.push(Fault::new(
            "one more pixel of blur would lower the CV of small patches by more than 1 %, so the blur of the \
            camera has lowered it too, and no interval is given there",
            match sharp.map(|patch| Dimension::Length.pretty(patch.patch_cv.patch)) {
                Some(side) => format!("from patches of {side} on this does not matter"),
                None => "it matters at all sizes of patch here, so scan with smaller pixels".to_owned(),
            },
        ));
    }
    if let Some(few) = patches.iter().find(|patch| patch.interval == Err(ScanWarning::Few)) {
        let side = Dimension::Length.pretty(few.patch_cv.patch);
        let message =
            format!("this sheet holds too few patches of {side} or more, so no interval is given there");
        notes.push(Fault::new(message, "scan a larger piece of the web"));
    }
    notes
}

/// Where the side of a pixel comes from. A map contains its cells.
fn side_of_a_pixel(picture: &Picture) -> Option<Fault> {
    let (given, in_file) = (picture.pixel, picture.pixel_of_file?);
    let [shown, shown_in_file] = [given, in_file].map(|side| Dimension::Length.pretty_to(side, 4));
    if (given / in_file - 1.0).abs() > OTHER {
        let message =
            format!("a pixel is taken to be {shown} wide, as you said, but the file says {shown_in_file}");
        return Some(Fault::plain(message));
    }
    if given != in_file || !picture.holds_light() {
        return None;
    }
    let dots = 25.4e-3 / given;
    let message = format!(
        "a pixel is {shown} wide, as the file says ({} dots per inch)",
        shortest((dots * 10.0).round() / 10.0)
    );
    let is_default = UNKNOWN.iter().any(|unknown| (dots / unknown - 1.0).abs() < OTHER);
    let remedy =
        "many programs write this when they do not know it, so measure it and give the side of a pixel";
    Some(Fault::new(message, if is_default { remedy } else { "" }))
}

/// The numbers of rows and columns that stood beside a map.
fn numbers(numbered: [bool; 2]) -> Option<Fault> {
    let left_out = match numbered {
        [false, false] => return None,
        [true, false] => "the first column numbers the rows, and was",
        [false, true] => "the first row numbers the columns, and was",
        [true, true] => "the first row and the first column number the columns and the rows, and were",
    };
    Some(Fault::plain(format!("{left_out} left out of the map")))
}

/// The doubt that a file of 16 bits holds the levels of a camera with fewer, where the picture of the lamp
/// has another depth.
fn bits(picture: &Picture, lamp: Option<&Picture>) -> Option<Fault> {
    let lamp = lamp.filter(|lamp| lamp.full_scale != picture.full_scale)?;
    let bits = picture.fewer_bits.or(lamp.fewer_bits)?;
    let largest = (1u32 << bits) - 1;
    Some(Fault::new(
        format!(
            "no level lies above {largest}, though the file has 16 bits; if the camera has {bits} bits and \
            its largest level is {largest}, every CV is wrong by the same factor"
        ),
        "take an image of the lamp with the same number of bits",
    ))
}

fn assumed_lamp(white: f64) -> Fault {
    Fault::new(
        format!(
            "the lamp without web is assumed to have the grey level {}, the largest that the file can hold. If that \
            is wrong, every CV is wrong by the same factor, and the image cannot show it, so no interval is given",
            shortest(white)
        ),
        "take an image of the lamp at the same exposure",
    )
}

fn assumed_thickest(white: f64) -> Fault {
    Fault::new(
        format!(
            "a web so thick that the ground is not visible is assumed to have the grey level {}, the largest \
            that the file can hold. If that is wrong, every CV is wrong, so no interval is given",
            shortest(white)
        ),
        "take an image of a thick stack of the web at the same exposure, and give its grey level",
    )
    .option("--white")
}

/// What is said of the bare lamp beside the web, if it is visible.
///
/// * `is_used` – whether its level there is used
fn bare_lamp(aside: &ForeignParts, settings: &Settings, is_used: bool) -> Option<Fault> {
    let level = aside.bare?;
    let message = format!(
        "the bare lamp is visible next to the web, so the largest rectangle of web was cut out, without {}",
        square(aside.cut_off)
    );
    // Over a picture of the lamp the level is relative to it.
    let remedy = if settings.lamp.is_none() {
        let level = shortest((level * 10.0).round() / 10.0);
        let use_ = if is_used { ", which is used" } else { "" };
        format!("there the lamp has the grey level {level}{use_}")
    } else if (level - 1.0).abs() > OTHER {
        format!(
            "there it is {} {} than in its own image, so take both images at the same exposure",
            per_cent((level - 1.0).abs()),
            if level > 1.0 { "brighter" } else { "darker" }
        )
    } else {
        "there it is as bright as in its own image".to_owned()
    };
    Some(Fault::new(message, remedy))
}

fn dark_spots(aside: &ForeignParts) -> Option<Fault> {
    let largest = aside.spots.first()?;
    let [right, down] = largest.place.map(|place| Dimension::Length.pretty_to(place, 3));
    Some(Fault::plain(format!(
        "dark spots such as dust or blots were left out: {}, {} in all; the largest, {}, is {right} from the \
        left and {down} from the upper edge of the web. If they belong to the web, say so",
        aside.spots.len(),
        square(aside.masked),
        square(largest.area)
    )))
}

/// Pixels without a value, as light as can be, or lighter than the lamp.
fn odd_pixels(picture: &Picture, weighed: &WeighedPicture) -> Vec<Fault> {
    let share = |pixels: usize| pixels as f64 / picture.values.len() as f64;
    let shown = |pixels: usize| format!("{pixels} ({})", per_cent(share(pixels)));
    let remedy = |pixels: usize, remedy| if share(pixels) > MANY { remedy } else { "" };
    let mut notes = Vec::new();
    let pixels = weighed.pixels;
    if pixels.filled > 0 {
        notes.push(Fault::plain(format!(
            "pixels that are black or have no value: {}; they were filled in along their row",
            pixels.filled
        )));
    }
    if pixels.saturated > 0 {
        notes.push(Fault::new(
            format!("pixels of the largest grey level: {}", shown(pixels.saturated)),
            remedy(
                pixels.saturated,
                "what is lighter than that looks the same, so choose a shorter exposure",
            ),
        ));
    }
    if pixels.lighter > 0 {
        let count = shown(pixels.lighter);
        notes.push(Fault::new(
            format!("pixels lighter than the lamp without web: {count}; they count as empty"),
            remedy(pixels.lighter, "is the level of the lamp right?"),
        ));
    }
    notes
}

/// `12 mm²`.
fn square(area: f64) -> String {
    format!("{} mm²", shortest(rounded(1e6 * area, 2)))
}
