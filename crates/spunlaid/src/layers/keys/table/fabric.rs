//! The keys of the table `[fabric]`.

use super::super::access::{Access, WebKey};
use super::positive;
use crate::case::keys::Sign;
use crate::case::keys::row::{at, quantity};
use crate::units::Dimension;

/// In the order of the file.
pub(super) const KEYS: &[WebKey] = &[
    positive("fabric.thickness", Dimension::Length)
        .access(at!(fabric.thickness))
        .follows("no air permeability is told")
        .meaning(
            "Thickness of the finished fabric, between its bonds. The program does not know it: it follows \
             from the calender.",
        )
        .synonyms(&["caliper", "gauge", "loft"])
        .label("Thickness")
        .usual(1e-5, 0.1),
    positive("fabric.saleable_width", Dimension::Length)
        .access(at!(fabric.saleable_width))
        .follows("all of the web between its edges")
        .meaning(
            "Width in the middle of the web that is sold; what lies beside it is trimmed. What is told of \
             the fabric is that of this width.",
        )
        .synonyms(&["trim", "slit width", "net width"])
        .label("Saleable width")
        .usual(1e-2, 30.0),
    quantity("fabric.tolerance", Dimension::Ratio, Sign::Share)
        .access(at!(fabric.tolerance))
        .value("5 %")
        .meaning(
            "How far the weight may be from that of the middle half of the web to be sold, with \
             `web.edges = \"cut\"`: the width that is within it is told, and its trim.",
        )
        .label("Tolerance of the weight")
        .usual(1e-3, 0.5),
    positive("fabric.strip_width", Dimension::Length)
        .access(at!(fabric.strip.width))
        .value("50 mm")
        .meaning("Width of a strip of the tensile test, as in ISO 9073-3.")
        .synonyms(&["tensile", "specimen"])
        .label("Width of a strip")
        .usual(1e-3, 1.0),
    positive("fabric.strip_length", Dimension::Length)
        .access(at!(fabric.strip.length))
        .value("200 mm")
        .meaning("Length of a strip between the jaws of the tensile test, as in ISO 9073-3.")
        .synonyms(&["tensile", "gauge length"])
        .label("Length of a strip")
        .usual(1e-2, 10.0),
    positive("fabric.section", Dimension::Length)
        .access(at!(fabric.strip.section))
        .value("5 mm")
        .meaning(
            "Length of a section of a strip. Of each strip the lightest section is looked for, where it \
             would tear if its strength were that of its fibres.",
        )
        .synonyms(&["tensile", "weakest link"])
        .label("Section of a strip")
        .usual(1e-4, 0.1),
    positive("fabric.pressure", Dimension::Pressure)
        .access(at!(fabric.pressure))
        .value("200 Pa")
        .meaning("Pressure that drives air through the fabric in the test, as in ISO 9073-15.")
        .synonyms(&["air permeability", "porosity"])
        .label("Pressure of the air")
        .usual(1.0, 1e4),
    quantity("fabric.measured_opacity", Dimension::Ratio, Sign::Share)
        .access(at!(fabric.measured_opacity))
        .follows("no opacity is told")
        .meaning(
            "Opacity (ISO 2471) that was measured of a fabric of the same filaments. Pigment and titre are \
             in it; the program adds what the basis weight and its clouds do.",
        )
        .synonyms(&["cover", "whiteness"])
        .label("Measured opacity")
        .usual(0.01, 0.99),
    positive("fabric.opacity_weight", Dimension::BasisWeight)
        .access(at!(fabric.opacity_weight))
        .follows("that of this web")
        .meaning("Basis weight of the fabric whose opacity was measured.")
        .label("Basis weight of the measured opacity")
        .usual(1e-3, 1.0),
];
