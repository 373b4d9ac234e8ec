#![allow(clippy::unwrap_used)]

use super::*;
use proptest::prelude::*;

#[test]
fn identical_to_the_decimal_number_meant() {
    let cases: &[(Dimension, &str, f64)] = &[
        (Dimension::Length, "50 µm", 5e-5),
        (Dimension::Length, "50 μm", 5e-5),
        (Dimension::Length, "50um", 5e-5),
        (Dimension::Length, "0.3 mm", 3e-4),
        (Dimension::Length, "+2.5e1 cm", 0.25),
        (Dimension::Length, ".7 nm", 7e-10),
        (Dimension::Pressure, "2 GPa", 2e9),
        (Dimension::Pressure, "1.1 MPa", 1.1e6),
        (Dimension::Pressure, "1.1 N/mm^2", 1.1e6),
        (Dimension::Density, "950 kg/m³", 950.0),
        (Dimension::Density, "950 kg/m^3", 950.0),
        (Dimension::Density, "0.95 g/cm3", 950.0),
        (Dimension::KinematicViscosity, "15.1 mm²/s", 1.51e-5),
        (Dimension::KinematicViscosity, "15.1 cSt", 1.51e-5),
        (Dimension::MassFlow, "0.5 g/min", 0.5 / 60_000.0),
        (Dimension::MassFlow, "0.03 kg/h", 0.03 / 3600.0),
        (Dimension::DynamicViscosity, "221 Pa s", 221.0),
        (Dimension::MolarEnergy, "44 kJ/mol", 44e3),
        (Dimension::HeatCapacity, "2.1 J/(g K)", 2100.0),
        (Dimension::Acceleration, "-9.81 m/s^2", -9.81),
        (Dimension::Time, "1 µs", 1e-6),
        (Dimension::Time, "1.5 min", 90.0),
        (Dimension::Velocity, "36 km/h", 10.0),
        (Dimension::Velocity, "600\u{a0}m/min", 10.0),
        (Dimension::Frequency, "0.1 kHz", 100.0),
        (Dimension::Rate, "3 1/s", 3.0),
        (Dimension::Rate, "3 s^-1", 3.0),
        (Dimension::Rate, "3 s⁻¹", 3.0),
        (Dimension::Velocity, "3 m·s⁻¹", 3.0),
        (Dimension::Velocity, "3 m⋅s^-1", 3.0),
        (Dimension::Velocity, "3 m s**-1", 3.0),
        (Dimension::Velocity, "3 m.s-1", 3.0),
        (Dimension::Velocity, "3 m∕s", 3.0),
        (Dimension::Acceleration, "3 m/s/s", 3.0),
        (Dimension::Acceleration, "3 m·s⁻²", 3.0),
        (Dimension::Density, "3 kg·m⁻³", 3.0),
        (Dimension::HeatCapacity, "3 J/kg/K", 3.0),
        (Dimension::HeatCapacity, "3 J kg⁻¹ K⁻¹", 3.0),
        (Dimension::DynamicViscosity, "3 Pa*s", 3.0),
        (Dimension::Noise, "3 m**-0.5", 3.0),
        (Dimension::SpecificCharge, "2 µC/g", 2e-3),
        (Dimension::SpecificCharge, "-2 uC/g", -2e-3),
        (Dimension::SpecificCharge, "0.002 C/kg", 2e-3),
        (Dimension::SpecificCharge, "2 mC kg⁻¹", 2e-3),
        (Dimension::SpecificCharge, "300 nC/g", 3e-4),
        (Dimension::ElectricField, "0.43 MV/m", 4.3e5),
        (Dimension::Temperature, "293.15 K", 293.15),
        (Dimension::Temperature, "20 °C", 293.15),
        (Dimension::Temperature, "0°C", 273.15),
        (Dimension::Ratio, "10 %", 0.1),
        (Dimension::Ratio, "0.1", 0.1),
        (Dimension::MeltFlowRate, "35 g/10min", 35.0),
        (Dimension::MeltFlowRate, "35 g/10 min", 35.0),
        (Dimension::MeltFlowRate, "35", 35.0),
        // A comma that can only be a decimal sign, and a space that takes no room.
        (Dimension::Length, "1,5 m", 1.5),
        (Dimension::Length, "-0,125 mm", -1.25e-4),
        (Dimension::Velocity, "10 m/s\u{200b}", 10.0),
    ];
    for (dimension, text, value) in cases {
        let read = dimension.parse(text).map(f64::to_bits);
        assert_eq!(read, Ok(value.to_bits()), "{text}");
    }
}

#[test]
fn units_of_the_united_states_are_read() {
    for (dimension, text, value) in [
        // The solidification and the boiling point of water, and 446 °F, which are 230 °C.
        (Dimension::Temperature, "32 °F", 273.15),
        (Dimension::Temperature, "212°F", 373.15),
        (Dimension::Temperature, "446 °F", 503.15),
        // NIST SP 811: an ounce per square yard is 33.90575 g/m².
        (Dimension::BasisWeight, "0.5 osy", 0.5 * 33.90575e-3),
        (Dimension::BasisWeight, "2 oz/yd²", 2.0 * 33.90575e-3),
    ] {
        let read = dimension.parse(text).unwrap();
        assert!((read / value - 1.0).abs() < 1e-7, "{text}: {read} for {value}");
    }
    assert_eq!(Dimension::MeltFlowRate.parse("35 %").unwrap_err().message, "is a ratio");
}

#[test]
fn rejects_what_is_no_quantity() {
    for (dimension, text, message) in [
        (
            Dimension::Length,
            "",
            "does not start with a number; write a length with its unit: m, cm, mm, µm or nm",
        ),
        (
            Dimension::Length,
            "mm",
            "does not start with a number; write a length with its unit: m, cm, mm, µm or nm",
        ),
        (
            Dimension::Length,
            "-.e5 m",
            "does not start with a number; write a length with its unit: m, cm, mm, µm or nm",
        ),
        (Dimension::Rate, "inf 1/s", "is not a finite number; write a rate with its unit: 1/s or s⁻¹"),
        (
            Dimension::Ratio,
            "-NaN",
            "is not a finite number; write a plain number like 0.1, or a percentage like \"10 %\"",
        ),
        (Dimension::Length, "1e400 m", "is too large; write a length with its unit: m, cm, mm, µm or nm"),
        (Dimension::Time, "1e308 min", "is too large; write a time with its unit: s, ms, µs, ns, min or h"),
        (
            Dimension::Length,
            "1_000 m",
            "has an underscore; write the number without separators, like \"1000 m\"",
        ),
        (Dimension::Length, "1.5", "has no unit; write a length with its unit: m, cm, mm, µm or nm"),
        (
            Dimension::Velocity,
            "1.5 m·s",
            "has the unknown unit \"m·s\"; write a velocity with its unit: m/s, cm/s, mm/s, km/h or m/min",
        ),
        (
            Dimension::Velocity,
            "1.5 s/m",
            "has the unknown unit \"s/m\"; write a velocity with its unit: m/s, cm/s, mm/s, km/h or m/min",
        ),
        (
            Dimension::Velocity,
            "1.5 m/s²",
            "is an acceleration; write a velocity with its unit: m/s, cm/s, mm/s, km/h or m/min",
        ),
        (Dimension::Length, "1.5 s", "is a time; write a length with its unit: m, cm, mm, µm or nm"),
        (
            Dimension::Length,
            "1.5 inch",
            "has the unknown unit \"inch\"; write a length with its unit: m, cm, mm, µm or nm",
        ),
        // An exponent has digits; without them its letter begins a unit.
        (
            Dimension::Length,
            "5em",
            "has the unknown unit \"em\"; write a length with its unit: m, cm, mm, µm or nm",
        ),
        (
            Dimension::Length,
            "5e-m",
            "has the unknown unit \"e-m\"; write a length with its unit: m, cm, mm, µm or nm",
        ),
        (
            Dimension::Length,
            "1.5 MM",
            "has the unknown unit \"MM\"; write a length with its unit: m, cm, mm, µm or nm",
        ),
    ] {
        let fault = dimension.parse(text).map_err(|fault| fault.to_string());
        assert_eq!(fault, Err(message.to_owned()), "{text}");
    }
}

#[test]
fn people_read_handy_units() {
    for (dimension, value, text) in [
        (Dimension::Length, 5e-5, "50 µm"),
        (Dimension::Length, 0.05, "50 mm"),
        (Dimension::Length, 1.0, "1 m"),
        (Dimension::Length, 0.99999, "1 m"),
        (Dimension::Length, 5e-11, "0.05 nm"),
        (Dimension::Length, 1.5e-12, "1.5e-12 m"),
        (Dimension::Time, 3.446e-5, "34.46 µs"),
        (Dimension::Time, 0.0, "0 s"),
        (Dimension::Time, 3600.0, "3600 s"),
        (Dimension::Pressure, 2e9, "2 GPa"),
        (Dimension::Pressure, -2e9, "-2 GPa"),
        (Dimension::Density, 1.204, "1.204 kg/m³"),
        (Dimension::KinematicViscosity, 1.51e-5, "1.51e-5 m²/s"),
        (Dimension::MassFlow, 0.5e-3 / 60.0, "0.5 g/min"),
        (Dimension::SpecificCharge, 2e-3, "2 µC/g"),
        (Dimension::ElectricField, 4.26e5, "426 kV/m"),
        (Dimension::Force, 1.345e-3, "1.345 mN"),
        (Dimension::Temperature, 293.15, "20 °C"),
        (Dimension::Temperature, 260.5, "-12.65 °C"),
        (Dimension::Ratio, 1.0 / 3.0, "0.3333"),
        (Dimension::Length, f64::INFINITY, "inf m"),
        (Dimension::Pressure, f64::INFINITY, "inf Pa"),
    ] {
        assert_eq!(dimension.pretty(value), text);
    }
}

#[test]
fn what_people_wrote_is_written_as_they_wrote_it() {
    for (dimension, text) in [(Dimension::MassFlow, "0.6 g/min"), (Dimension::Velocity, "7 m/min")] {
        assert_eq!(dimension.exact(dimension.parse(text).unwrap()), text);
    }
    assert_eq!(Dimension::MassFlow.exact(1e-5), "1e-5 kg/s");
    // No unit takes few digits.
    assert_eq!(Dimension::Length.exact(1.0 / 3.0), "0.3333333333333333 m");
}

#[test]
fn a_value_is_written_with_as_few_digits_as_read_it_back() {
    for (dimension, text) in [
        (Dimension::LinearDensity, "1.6 dtex"),
        (Dimension::MassFlow, "0.6 g/min"),
        (Dimension::Length, "12.3456 mm"),
    ] {
        assert_eq!(dimension.written(dimension.parse(text).unwrap()), text);
    }
    let third = Dimension::Length.written(1.0 / 3.0);
    assert!((Dimension::Length.parse(&third).unwrap() * 3.0 - 1.0).abs() < 1e-15, "{third}");
}

#[test]
fn a_value_in_a_wrong_unit_is_what_was_meant_in_another() {
    assert_eq!(Dimension::Length.in_other_units(0.018, 1e-6, 1e-3), ["18 µm"]);
    assert_eq!(Dimension::Length.in_other_units(-0.018, 1e-9, 20.0), ["-18 m", "-18 cm", "-18 µm", "-18 nm"]);
    assert_eq!(Dimension::Ratio.in_other_units(0.5, 0.0, 100.0), [""; 0]);
    let meant = |unit: &str, value: f64| Dimension::Length.meant_in(unit, value, [0.5, 5.0]);
    assert_eq!(meant("mm", 1.5), Some(1.5));
    assert_eq!(meant("m", 1.5e-3), Some(1.5));
    // Of the unit itself, with more than three digits, and out of what is usual.
    assert_eq!([meant("m", 1.5), meant("mm", 1.2345), meant("cm", 6.0), meant("cm", 0.4)], [None; 4]);
    assert_eq!(Dimension::MassFlow.meant_in("kg/s", 0.5 / 60_000.0, [0.05, 5.0]), Some(0.5));
}

proptest! {
    #[test]
    fn identical_after_writing_and_reading(
        value in any::<f64>().prop_filter("finite", |v| v.is_finite()),
        dimension in prop::sample::select(Dimension::all().collect::<Vec<_>>()),
    ) {
        let text = dimension.exact(value);
        prop_assert_eq!(dimension.parse(&text).map(f64::to_bits), Ok(value.to_bits()), "{}", text);
    }

    #[test]
    fn identical_in_every_power_of_ten(digits in 1u64..1_000_000_000, exponent in -30i32..30) {
        for (unit, power) in [("m", 0), ("cm", -2), ("mm", -3), ("µm", -6), ("nm", -9)] {
            let meant: f64 = format!("{digits}e{}", exponent + power).parse().unwrap();
            let text = format!("{digits}e{exponent} {unit}");
            prop_assert_eq!(Dimension::Length.parse(&text).map(f64::to_bits), Ok(meant.to_bits()));
        }
    }

    #[test]
    fn any_text_is_read_or_refused(text in "\\PC{0,20}|[-+0-9.eE_,]{0,12} ?[a-zA-Zµμ%/^²³⁻¹]{0,5}") {
        for dimension in Dimension::all() {
            if let Ok(value) = dimension.parse(&text) {
                prop_assert!(value.is_finite());
            }
        }
    }
}

/// What columns and messages are made of: the ending of a name, which texts are a unit, and what is said where one is
/// missing.
#[test]
fn units_are_known_by_their_spellings_and_make_endings_of_names() {
    for (dimension, suffix, plain) in [
        (Dimension::Length, "_m", false),
        (Dimension::Acceleration, "_m_s2", false),
        (Dimension::Frequency, "_hz", false),
        (Dimension::Ratio, "", true),
    ] {
        assert_eq!(dimension.suffix(), suffix);
        assert_eq!(dimension.takes_plain_numbers(), plain, "{dimension:?}");
    }
    for (unit, is_one) in
        [("mm", true), (" µm ", true), ("um", true), ("MM", true), ("m/s", false), ("", false), (" ", false)]
    {
        assert_eq!(Dimension::Length.has_unit(unit), is_one, "{unit:?}");
    }
    // A number alone is a ratio, and no unit of it.
    assert!(!Dimension::Ratio.has_unit("") && Dimension::Ratio.has_unit("%"));
    let said = Dimension::Length.no_unit();
    assert_eq!(said.message, "has no unit");
    assert!(said.remedy.contains("mm"), "{}", said.remedy);
}
