//! The words of those who buy fabric, and what there is for each.

/// Words, and what there is for them.
const WORDS: &[(&[&str], &str)] = &[
    (
        &["formation", "cloudiness", "evenness", "uniformity"],
        "Formation and cloudiness are results, not keys: `spunlaid web` tells the CV over patches, the \
        cloudiness and the formation number, 1 for straight fibres at random (docs/fabric.md).",
    ),
    (
        &["pinhole", "pin hole", "hole", "pore", "bare", "hydrohead", "hydrostatic head"],
        "Holes and hydrohead are not told, because bonds and the calender make them: `spunlaid web` tells the bare \
        area and thin places (docs/fabric.md).",
    ),
    (
        &["thin spot", "thin place", "thick place", "thick spot"],
        "Thin and thick places are results, not keys: `spunlaid web` tells patches per square metre that are \
        lighter than 50, 70 and 80 % or heavier than 130 % of the mean (docs/fabric.md).",
    ),
    (
        &["strength", "tensile", "tenacity", "elongation", "tear"],
        "The strength of the fabric is not known here: it is made by the bonds. `spunlaid web` tells the \
        weakest section of strips and the MD/CD ratio of stiffness of the directions alone (docs/fabric.md).",
    ),
    (
        &["permeability", "porosity", "breathability"],
        "The air permeability is a range that needs the thickness of the fabric (fabric.thickness); trust \
        the ratio of two webs, not the number (docs/fabric.md).",
    ),
    (
        &["softness", "drape", "handle", "hand feel", "linting", "abrasion", "shrinkage"],
        "There is nothing for this: in a fabric it depends on bonds, finish and polymer, of which the \
        program knows nothing.",
    ),
];

/// What there is for a word of those who buy fabric; None for any other word.
pub fn about(word: &str) -> Option<&'static str> {
    let word = word.trim().to_lowercase().replace('-', " ");
    let singular = word.strip_suffix('s').unwrap_or(&word);
    let is_named = |words: &&[&str]| words.iter().any(|one| *one == word || *one == singular);
    WORDS.iter().find(|(words, _)| is_named(words)).map(|(_, sentence)| *sentence)
}
