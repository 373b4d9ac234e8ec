//! How large the pixels of a scan are, as programs for pictures write it.

use crate::scan_files::{SIDE, levels};
use crate::scans::{png_of_resolution, tiff_of_program, tiff_of_resolution};
use png::Unit;
use spunlaid_web::scan::parse;
use tiff::tags::ResolutionUnit;

fn side(text: &[u8], unit: Option<u16>, resolution: [u32; 2]) -> Result<f64, String> {
    let file = tiff_of_program(SIDE, &levels(|x| x), text, unit, resolution);
    parse(&file, "a", None).map(|picture| picture.pixel).map_err(|error| error.to_string())
}

#[test]
fn the_unit_of_imagej_goes_before_the_tag() {
    for (text, unit, resolution) in [
        ("ImageJ=1.53t\nunit=mm\n", Some(2), [10, 1]),
        ("ImageJ=1.11a\nunit=mm\n", None, [10, 1]),
        ("ImageJ=1.53t\nimages=1\nunit=um\nmin=0.0\n", Some(3), [1, 100]),
        ("ImageJ=1.53t\nunit=micron\n", Some(2), [1, 100]),
        ("ImageJ=1.53t\nunit=microns\n", Some(1), [1, 100]),
        ("ImageJ=1.53t\nunit=\\u00B5m\n", Some(1), [1, 100]),
        ("ImageJ=1.53t\nunit=µm\n", Some(1), [1, 100]),
        ("ImageJ=1.53t\nunit=cm\n", Some(1), [100, 1]),
        ("ImageJ=1.53t\nunit=millimeters\n", Some(1), [10, 1]),
        ("ImageJ=1.53t\nunit=nm\n", Some(1), [1, 100_000]),
        ("ImageJ=1.53t\nunit=m\n", Some(1), [10_000, 1]),
        ("ImageJ=1.53t\nunit=inch\n", Some(1), [254, 1]),
        ("ImageJ=1.53t\r\nunit=Inches\r\n", Some(3), [254, 1]),
        ("ImageJ=1.53t\nunit=mm\nyunit=mm\n", Some(2), [10, 1]),
        // Without a unit of its own, the tag has it.
        ("ImageJ=1.53t\nmin=0.0\n", Some(2), [254, 1]),
        ("a scan with unit=mm", Some(2), [254, 1]),
        (
            "<?xml version=\"1.0\"?><OME><Pixels PhysicalSizeX=\"100\" PhysicalSizeY=\"100\"/></OME>",
            Some(2),
            [72, 1],
        ),
        (
            "<OME><Pixels PhysicalSizeX=\"0.1\" PhysicalSizeXUnit=\"mm\" PhysicalSizeY=\"0.1\" \
             PhysicalSizeYUnit=\"mm\"/></OME>",
            None,
            [1, 1],
        ),
    ] {
        let found = side(text.as_bytes(), unit, resolution).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert!((found / 0.1e-3 - 1.0).abs() < 1e-9, "{text}: {found}");
    }
    // Latin-1.
    let found = side(b"ImageJ=1.53t\nunit=\xb5m\n", Some(1), [1, 100]).unwrap();
    assert!((found / 0.1e-3 - 1.0).abs() < 1e-9, "{found}");
}

#[test]
fn rejects_pixels_of_no_size_and_of_an_absurd_one() {
    let asks = "does not say how large its pixels are; give the side of a pixel";
    let absurd = "wide, which no pixel of a scanned web is; give the side of a pixel";
    for (text, unit, resolution, said) in [
        ("ImageJ=1.53t\nunit=pixel\n", Some(1), [1, 1], asks),
        ("ImageJ=1.53t\nunit=pixels\n", Some(2), [300, 1], asks),
        ("ImageJ=1.53t\nunit=furlong\n", Some(2), [300, 1], asks),
        ("ImageJ=1.53t\n", Some(1), [300, 1], asks),
        ("", Some(2), [1, 100], "says that its pixels are 2.54 m wide"),
        ("", Some(3), [1, 1], absurd),
        ("", Some(2), [4, 1], absurd),
        ("ImageJ=1.53t\nunit=m\n", Some(2), [10, 1], absurd),
        ("ImageJ=1.53t\nunit=nm\n", Some(2), [1, 50], absurd),
    ] {
        let found = side(text.as_bytes(), unit, resolution).unwrap_err();
        assert!(found.contains(said), "{text:?} {unit:?} {resolution:?}: {found}");
        let file = tiff_of_program(SIDE, &levels(|x| x), text.as_bytes(), unit, resolution);
        assert!(parse(&file, "a", 0.1e-3).is_ok());
    }
    let levels = levels(|x| x);
    let file = png_of_resolution(SIDE, &levels, [1; 2], Unit::Meter);
    let said = parse(&file, "a", None).unwrap_err().to_string();
    assert!(said.contains("1 m wide, which no pixel"), "{said}");
    // From 5 dots per inch to those of a microscope.
    for resolution in [[6, 1], [250_000, 1]] {
        assert!(
            parse(&tiff_of_resolution(SIDE, &levels, ResolutionUnit::Inch, resolution), "a", None).is_ok()
        );
    }
}
