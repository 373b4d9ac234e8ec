//! Reads profiles of the air and spectra: small tables with units in their headers.

use spunlaid_air::{Profile, SpectrumTable};
use spunlaid_fibre::case::keys::Kind;
use spunlaid_fibre::case::keys::Sign::{self, Any, NotNegative, Positive};
use spunlaid_fibre::{AirTable, DragTable, ZERO_CELSIUS};
use spunlaid_ground::Dimension::{Frequency, Length, Ratio, Temperature, Velocity};
use spunlaid_ground::error::listed;
use spunlaid_ground::table::scale;
use spunlaid_ground::units::excerpt;
use spunlaid_ground::{Diagnostic, Dimension, Fault, FileError, FileKind, Head, Table, Vec3};

/// Fewest rows of a table.
const LEAST_ROWS: usize = 2;

/// A column that a table may or must have.
struct ColumnRule {
    what: &'static str,
    /// Names in small letters, with a space between them.
    names: &'static str,
    dimension: Dimension,
    example: &'static str,
    sign: Sign,
    required: bool,
}

const fn column(
    what: &'static str,
    names: &'static str,
    dimension: Dimension,
    example: &'static str,
    sign: Sign,
) -> ColumnRule {
    ColumnRule { what, names, dimension, example, sign, required: true }
}

impl ColumnRule {
    const fn optional(self) -> Self {
        Self { required: false, ..self }
    }
}

const PROFILE: [ColumnRule; 5] = [
    column("of distances", "x distance position", Length, "x_mm", Any),
    column("of mean velocities", "velocity u mean_velocity speed", Velocity, "velocity_m_s", Any),
    column(
        "of turbulence intensities",
        "turbulence_intensity tu intensity",
        Ratio,
        "turbulence_intensity",
        NotNegative,
    )
    .optional(),
    column("of length scales", "length_scale l_t lt l", Length, "length_scale_mm", Positive).optional(),
    column(
        "of cut-off frequencies",
        "cutoff_frequency cutoff f frequency",
        Frequency,
        "cutoff_frequency_hz",
        Positive,
    )
    .optional(),
];
const SPINLINE_AIR: [ColumnRule; 4] = [
    column("of distances from the die", "z distance x", Length, "z_mm", NotNegative),
    column("of velocities along the filament", "velocity u speed", Velocity, "velocity_m_s", Any),
    column("of velocities across the filament", ACROSS, Velocity, "cross_velocity_m_s", NotNegative),
    column("of temperatures", "temperature air_temperature", Temperature, "temperature_c", Positive),
];
const ACROSS: &str = "cross_velocity quench_velocity v_c";
const SPECTRUM: [ColumnRule; 2] = [
    column("of frequencies", "frequency f", Frequency, "frequency_hz", NotNegative),
    column("of energies", "energy density psd e s", Ratio, ENERGY, NotNegative),
];
/// Only the shape of a spectrum counts, so that its energies may have any unit.
const ENERGY: &str = "energy";

const DRAG_LAW: [ColumnRule; 2] = [
    column("of Reynolds numbers", "reynolds re reynolds_number", Ratio, "reynolds", Positive),
    column(
        "of drag coefficients",
        "coefficient drag_coefficient c cd c_d cn c_n cf c_f",
        Ratio,
        "coefficient",
        Positive,
    ),
];

const POINTS: [ColumnRule; 3] = [
    column("of the coordinate x", "x", Length, "x [m]", Any),
    column("of the coordinate y", "y", Length, "y [m]", Any),
    column("of the coordinate z", "z", Length, "z [m]", Any),
];

/// Reads places: `x [m], y [m], z [m]`, in any order of the rows.
pub(crate) fn points(text: &[u8]) -> Result<Vec<Vec3<f64>>, FileError> {
    let [x, y, z] = rows(text, &POINTS, "x [m],y [m],z [m]", false)?;
    Ok(x.into_iter().zip(y).zip(z).map(|((x, y), z)| Vec3::new(x, y, z)).collect())
}

/// Reads a profile of the air: `x_m, velocity_m_s, turbulence_intensity, length_scale_m, cutoff_frequency_hz`; the
/// last three are optional.
pub(super) fn profile(text: &[u8]) -> Result<Profile, FileError> {
    let [x, velocity, turbulence_intensity, length_scale, cutoff_frequency] =
        read(text, &PROFILE, "x_mm,velocity_m_s")?;
    Ok(Profile { x, velocity, turbulence_intensity, length_scale, cutoff_frequency })
}

/// Reads the air along a spinline: `z_mm, velocity_m_s, cross_velocity_m_s, temperature_c`.
pub(super) fn spinline_air(text: &[u8]) -> Result<AirTable, FileError> {
    let [distance, velocity, cross_velocity, temperature] =
        read(text, &SPINLINE_AIR, "z_mm,velocity_m_s,cross_velocity_m_s,temperature_c")?;
    Ok(AirTable { distance, velocity, cross_velocity, temperature })
}

/// Reads a spectrum: `frequency_hz, energy`, the energies in any unit, or in decibels.
pub(super) fn spectrum(text: &[u8]) -> Result<SpectrumTable, FileError> {
    let [frequency, energy] = read(text, &SPECTRUM, "frequency_hz,energy")?;
    if energy.iter().all(|e| *e == 0.0) {
        return Err(Fault::new("is zero at every frequency", "at least one value must be positive").into());
    }
    refuse_mean(&frequency, &energy)?;
    Ok(SpectrumTable { frequency, energy })
}

/// Reads a drag law: `reynolds, coefficient`.
pub(super) fn drag_law(text: &[u8]) -> Result<DragTable, FileError> {
    let [reynolds, coefficients] = read(text, &DRAG_LAW, "reynolds,coefficient")?;
    Ok(DragTable::new(&reynolds, &coefficients))
}

/// What is said of the interpolation between the rows of a drag law.
pub(super) fn interpolation(law: &DragTable) -> Diagnostic {
    /// Change without every second row from which on more rows are asked for [-].
    const LARGE: f64 = 0.05;
    let rows = law.rows().len();
    let Some(change) = law.change_without_every_second_row() else {
        return Diagnostic::note("has two rows, between which the drag is a power of the Reynolds number");
    };
    let [error, shown] = [change / 3.0, change].map(|share| Ratio.pretty_to(100.0 * share, 2));
    let text = format!(
        "is interpolated between its {rows} rows to about {error} %: without every second row its coefficients \
         change by up to {shown} %"
    );
    if change > LARGE {
        Diagnostic::warning(format!("{text}; add rows, or smooth them"))
    } else {
        Diagnostic::note(text)
    }
}

/// Refuses a spectrum with the mean of the velocity in its row of 0 Hz, from which windows spread it to the next ones.
fn refuse_mean(frequency: &[f64], energy: &[f64]) -> Result<(), FileError> {
    /// The mean is so many times the density behind it, and has this share of all energy, within this part of all
    /// frequencies: of a table of few rows these may be the turbulence itself.
    const HIGHER: f64 = 50.0;
    const MOST: f64 = 0.5;
    const PART: f64 = 0.1;
    let ([0.0, ..], Some(behind)) = (frequency, energy.get(3)) else { return Ok(()) };
    let part = |i: usize| 0.5 * (energy[i] + energy[i + 1]) * (frequency[i + 1] - frequency[i]);
    let share = (0..3).map(part).sum::<f64>() / (0..energy.len() - 1).map(part).sum::<f64>();
    let is_narrow = frequency[3] < PART * frequency[frequency.len() - 1];
    if !is_narrow || energy[0] <= HIGHER * behind || share < MOST {
        return Ok(());
    }
    let fault = Fault::new(
        format!(
            "has {:.0} % of its energy at 0 Hz, which is the mean velocity and not turbulence",
            100.0 * share
        ),
        "subtract the mean before the spectrum is made, or leave out the first rows",
    );
    Err(fault.into())
}

/// The columns in SI units; an optional column that is not there is empty. The first column must rise.
fn read<const N: usize>(
    text: &[u8],
    rules: &[ColumnRule; N],
    example: &'static str,
) -> Result<[Vec<f64>; N], FileError> {
    let values = rows(text, rules, example, true)?;
    let found = values[0].len();
    if found < LEAST_ROWS {
        return Err(Fault::new(
            format!("has {found} {} of numbers", if found == 1 { "row" } else { "rows" }),
            format!("at least {LEAST_ROWS} are needed for interpolation"),
        )
        .into());
    }
    Ok(values)
}

/// * `rising` – whether the first column must rise
fn rows<const N: usize>(
    text: &[u8],
    rules: &[ColumnRule; N],
    example: &'static str,
    rising: bool,
) -> Result<[Vec<f64>; N], FileError> {
    let mut table = Table::open(text, FileKind::Table, 0)?;
    if !table.named() {
        return Err(Fault::no_header(example).into());
    }
    let mut columns = [None; N];
    for (column, rule) in columns.iter_mut().zip(rules) {
        *column = find(table.heads(), rule).map_err(|error| error.at(table.header()))?;
    }
    let mut values: [Vec<f64>; N] = std::array::from_fn(|_| Vec::new());
    while table.next_row()? {
        for (i, (column, rule)) in columns.iter().zip(rules).enumerate() {
            let Some((index, unit)) = *column else { continue };
            let value = match table.number(index) {
                Ok(number) => number * unit.factor + unit.zero,
                Err(_) if !table.is_number(index) => f64::NAN,
                Err(error) => return Err(error),
            };
            let text = excerpt(table.text(index), 40);
            if !value.is_finite() {
                let message = format!("\"{text}\" is not a finite number");
                return Err(table.blame(index, Fault::new(message, "every cell of the table needs one")));
            }
            if let Some(Fault { message, remedy, .. }) =
                Kind::Quantity(rule.dimension, if unit.is_decibel { Any } else { rule.sign })
                    .fault(&value.into())
            {
                return Err(table.blame(index, Fault::new(format!("{text} {message}"), remedy)));
            }
            if rising
                && i == 0
                && let Some(before) = values[0].last().copied().filter(|before| *before >= value)
            {
                return Err(table.blame(index, Fault::not_increasing(before, value)));
            }
            values[i].push(value);
        }
    }
    for (values, unit) in values.iter_mut().zip(&columns).filter_map(|(v, column)| Some((v, (*column)?.1))) {
        if unit.is_decibel {
            from_decibels(values);
        } else if unit.is_root {
            values.iter_mut().for_each(|value| *value *= *value);
        }
    }
    Ok(values)
}

/// How the numbers of a column become SI units: times the factor, plus the zero of the scale.
#[derive(Clone, Copy)]
struct ColumnUnit {
    factor: f64,
    zero: f64,
    /// Whether they are ten times the decadic logarithm of what is meant.
    is_decibel: bool,
    /// Whether they are the roots of energies, per root of a hertz.
    is_root: bool,
}

impl ColumnUnit {
    const PLAIN: Self = Self { factor: 1.0, zero: 0.0, is_decibel: false, is_root: false };
}

/// What the unit of an energy says: m/s/√Hz is that of its root.
///
/// # Errors
/// If it is that of a velocity, which is no density.
fn is_root(head: &Head, unit: Option<&str>) -> Result<bool, FileError> {
    let text: String = head.text.to_lowercase().chars().filter(|c| !c.is_whitespace()).collect();
    let roots = [
        "√",
        "sqrt",
        "rthz",
        "roothz",
        "hz^0.5",
        "hz^-0.5",
        "hz^(-0.5)",
        "hz^(1/2)",
        "hz^-1/2",
        "hz^(-1/2)",
        "hz⁻½",
    ];
    if roots.iter().any(|root| text.contains(root)) {
        return Ok(true);
    }
    let is_velocity = |unit: &str| scale(unit, Velocity).is_some();
    if unit.is_some_and(is_velocity) {
        let message = format!(
            "has the unit {}, of an amplitude at each frequency",
            excerpt(unit.unwrap_or_default(), 20)
        );
        let fault = Fault::new(message, "write a density, in (m/s)²/Hz, m/s/√Hz or dB");
        return Err(FileError::from(fault).column(&head.text));
    }
    Ok(false)
}

/// Whether a header says that its column is in decibels: `psd_dB`, `E (dB)`, `PSD [dB re 1 (m/s)²/Hz]`.
fn is_decibel(head: &Head) -> bool {
    let mut words = head.text.split(|c: char| !c.is_alphabetic());
    words.any(|word| ["db", "decibel", "decibels", "dezibel"].contains(&word.to_lowercase().as_str()))
}

/// Makes energies of decibels; the largest is 1, for only their shape counts.
fn from_decibels(values: &mut [f64]) {
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    values.iter_mut().for_each(|value| *value = libm::exp10(0.1 * (*value - largest)));
}

/// Index of the column, and its unit.
fn find(heads: &[Head], rule: &ColumnRule) -> Result<Option<(usize, ColumnUnit)>, FileError> {
    let names: Vec<&str> = rule.names.split(' ').collect();
    let is_energy = rule.example == ENERGY;
    let named = || heads.iter().enumerate();
    let mut matching: Vec<(usize, Option<&str>)> =
        named().filter_map(|(i, head)| Some((i, head.named(&names)?))).collect();
    if matching.is_empty() && is_energy {
        // Decibels may stand without a name.
        matching.extend(named().filter(|(_, head)| is_decibel(head)).map(|(i, _)| (i, None)));
    }
    let text = |i: usize| excerpt(&heads[i].text, 60);
    let (index, unit) = match matching[..] {
        [] if rule.required => {
            let (name, example) = (rule.what, rule.example);
            let found: Vec<String> = (0..heads.len()).map(text).collect();
            return Err(Fault::new(
                format!("has no column {name} (it has {})", listed(&found)),
                format!("name one like {example}"),
            )
            .into());
        }
        [] => return Ok(None),
        [one] => one,
        [(first, _), (second, _), ..] => {
            let (first, second) = (text(first), text(second));
            return Err(Fault::new(
                format!("the columns \"{first}\" and \"{second}\" both are columns {}", rule.what),
                "keep one",
            )
            .into());
        }
    };
    if is_energy || unit.is_none() && rule.dimension == Dimension::Ratio {
        let is_decibel = is_energy && is_decibel(&heads[index]);
        let is_root = is_energy && !is_decibel && is_root(&heads[index], unit)?;
        return Ok(Some((index, ColumnUnit { is_decibel, is_root, ..ColumnUnit::PLAIN })));
    }
    if rule.dimension == Dimension::Temperature
        && let Some(unit) = unit.map(|unit| unit.trim_matches(['[', ']', '(', ')', ' ']))
    {
        let celsius = ["c", "C", "°C", "degc", "degC", "deg_c", "celsius"].contains(&unit);
        if celsius || unit.eq_ignore_ascii_case("k") {
            let zero = if celsius { ZERO_CELSIUS } else { 0.0 };
            return Ok(Some((index, ColumnUnit { zero, ..ColumnUnit::PLAIN })));
        }
    }
    let head = Head { unit: unit.map(str::to_owned), ..heads[index].clone() };
    // Options that give the units of a record are none of these tables.
    let factor = head.factor(rule.dimension, rule.example).map_err(|error| {
        let cause = Fault { option: "".into(), ..error.cause.clone() };
        FileError::new(Diagnostic { cause, ..*error })
    })?;
    Ok(Some((index, ColumnUnit { factor, ..ColumnUnit::PLAIN })))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_a_spectrum_are_read_and_the_mean_is_refused() {
        let energies = [1.0, 0.9, 0.5, 0.2, 0.1, 0.02];
        let text = |head: &str, of: &dyn Fn(usize) -> f64| {
            let rows = (0..energies.len()).map(|i| format!("{i},{:.9}\n", of(i)));
            format!("f_hz,{head}\n{}", rows.collect::<String>())
        };
        for head in ["psd [m/s/√Hz]", "PSD (m/s/sqrt(Hz))", "e [mm/s/rtHz]", "psd [m s^-1 Hz^-1/2]"] {
            let found = spectrum(text(head, &|i| f64::sqrt(energies[i])).as_bytes()).unwrap();
            for (found, right) in found.energy.iter().zip(energies) {
                assert!((found - right).abs() < 1e-8, "{head}: {found} {right}");
            }
        }
        let refused = |text: &str| spectrum(text.as_bytes()).unwrap_err().to_string();
        let amplitude = refused(&text("psd [m/s]", &|i| energies[i]));
        assert!(amplitude.contains("has the unit m/s, of an amplitude at each frequency"), "{amplitude}");
        // With the mean in the first row, which a window has spread to the second.
        let of_turbulence = |i: usize| 1.0 / (1.0 + (0.1 * i as f64).powi(2));
        let long = |of_mean: [f64; 2]| {
            let rows =
                (0..60).map(|i| format!("{i},{}\n", of_turbulence(i) + of_mean.get(i).unwrap_or(&0.0)));
            format!("f_hz,psd_m2_s\n{}", rows.collect::<String>())
        };
        let mean = refused(&long([400.0, 200.0]));
        assert!(mean.contains("% of its energy at 0 Hz, which is the mean velocity"), "{mean}");
        assert!(spectrum(long([0.0, 0.0]).as_bytes()).is_ok());
        assert!(spectrum(text("psd_m2_s", &|i| energies[i]).as_bytes()).is_ok());
    }

    #[test]
    fn rejects_a_drag_law_that_is_no_law() {
        for (text, said) in [
            ("re,c\n1,2\n", "has 1 row of numbers"),
            ("re,c\n1,2\n1,3\n", "must"),
            ("re,c\n0,2\n1,3\n", "is not positive"),
            ("re,c\n1,2\n2,-3\n", "is not positive"),
            ("re,c\n1,2\n2,nan\n", "is not a finite number"),
            ("re,velocity\n1,2\n2,3\n", "has no column of drag coefficients (it has"),
            ("1,2\n2,3\n", "reynolds,coefficient"),
        ] {
            let error = drag_law(text.as_bytes()).unwrap_err().to_string();
            assert!(error.contains(said), "{text}: {error}");
        }
        let law = drag_law("Reynolds; Coefficient\n1; 8\n10; 2\n100; 1\n".as_bytes()).unwrap();
        assert_eq!(law.rows().collect::<Vec<_>>(), [(1.0, 8.0), (10.0, 2.0), (100.0, 1.0)]);
        assert!(interpolation(&law).is_warning() && interpolation(&law).to_string().contains("add rows"));
    }

    #[test]
    fn analytic_decibels_are_ten_times_the_logarithm() {
        let energies = [0.99751, 0.5, 0.03, 2e-4];
        let text = |head: &str, of: &dyn Fn(f64) -> f64| {
            let rows = energies.iter().enumerate().map(|(i, e)| format!("{i};{:.6}\n", of(*e)));
            format!("f_hz;{head}\n{}", rows.collect::<String>())
        };
        let read = |text: &str| spectrum(text.as_bytes()).unwrap().energy;
        let linear = read(&text("energy", &|e| e));
        for head in [
            "energy_dB",
            "psd_dB",
            "PSD [dB/Hz]",
            "PSD [dB]",
            "E(dB)",
            "E (dB re 1 (m/s)²/Hz)",
            "dB re 1 (m/s)²/Hz",
            "level dB",
            "PSD dB",
            "psd_decibel",
        ] {
            for reference in [60.0, -40.0] {
                let energy = read(&text(head, &|e| 10.0 * e.log10() + reference));
                for (found, right) in energy.iter().zip(&linear) {
                    // The sixth decimal of a decibel.
                    assert!(
                        (found / energy[0] / (right / linear[0]) - 1.0).abs() < 3e-7,
                        "{head}: {energy:?}"
                    );
                }
            }
        }
        for head in ["energy", "e_m2_s2", "density"] {
            assert_eq!(read(&text(head, &|e| e)), linear, "{head}");
        }
        let said = spectrum(text("energy", &|e| 10.0 * e.log10()).as_bytes()).unwrap_err().to_string();
        assert!(said.contains("-0.010827"), "{said}");
    }
}
