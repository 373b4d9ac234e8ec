//! A line that begins at the die: the air along its spinline, and the drag with which it has the measured titre.

use super::line::{GIVEN, NewLine, length};
use crate::args::{MeltNumbers, value};
use crate::failure::Failure;
use crate::say;
use spunlaid::fibre::Polymer;
use spunlaid::fibre::case::keys;
use spunlaid::ground::Dimension;
use spunlaid::input::read_spinline;
use spunlaid_results::numbers::significant;
use std::path::Path;

/// What is assumed of a line where it is not given: melt flow rate of polypropylene for spunbond [g/10 min], diameter
/// of a hole [m], velocity of the quench air [m/s], distance from the die to the end of the slot [m].
const MELT_FLOW_RATE: f64 = 35.0;
const HOLE: f64 = 0.6e-3;
const QUENCH: f64 = 1.0;
const LENGTH: f64 = 2.2;
/// The air along the filaments: places as parts of that distance, and velocities over that at the end of the slot. The
/// filaments drag the air of the quench along, and a channel that narrows makes it faster.
const SHAPE: [(f64, f64); 6] =
    [(0.0, 0.1), (0.136, 0.4), (0.145, 0.42), (0.205, 0.7), (0.273, 1.0), (1.0, 1.0)];
/// How many of these places the quench air crosses, and the temperature of the air [°C].
const QUENCHED: usize = 2;
const AIR_TEMPERATURE: f64 = 20.0;

/// The line from the die to the slot.
pub(super) struct NewMelt<'a> {
    given: &'a MeltNumbers,
    length: f64,
}

impl<'a> NewMelt<'a> {
    /// None of a line of which nothing above the slot is given.
    pub(super) fn of(line: &NewLine<'a>) -> Option<Self> {
        let given = &line.given.melt;
        given.given().next()?;
        Some(Self { given, length: value(&given.spinline_length).unwrap_or(LENGTH) })
    }

    /// The table of the air from the die to the end of the slot.
    pub(super) fn air(&self, line: &NewLine<'_>) -> String {
        let quench = value(&self.given.quench).unwrap_or(QUENCH);
        let row = |(number, (place, along)): (usize, (f64, f64))| {
            let [place, along] =
                [1e3 * place * self.length, along * line.air_speed].map(|n| significant(n, GIVEN));
            let across = if number < QUENCHED { quench } else { 0.0 };
            format!("{place},{along},{across},{AIR_TEMPERATURE}\n")
        };
        let rows: String = SHAPE.into_iter().enumerate().map(row).collect();
        format!(
            "# Air from the die to the end of the slot: assumed, of the usual shape.\n\
             z_mm,velocity_m_s,cross_velocity_m_s,temperature_c\n{rows}"
        )
    }

    /// The file of a line whose filament has the titre that was measured.
    ///
    /// * `path` – of the file, beside which the tables are
    /// * `file` – the text of the file with the text of its spinline
    ///
    /// # Errors
    /// If the line cannot run with the air as it is, or if no drag gives the titre.
    pub(super) fn calibrated(
        &self,
        line: &NewLine<'_>,
        path: &Path,
        file: impl Fn(&str) -> String,
    ) -> Result<String, Failure> {
        let name = path.display().to_string();
        let air = format!("{}_spinline.csv", super::super::stem(path, "line"));
        let text = file(&self.text(line, &air, 1.0));
        let spinline = read_spinline((text.as_str(), name.as_str()), &[])?;
        let factor = spinline.drag_factor_of_titre(line.filament.linear_density())?;
        let [least, most] = usual_drag();
        if !(least..=most).contains(&factor) {
            say::warning(&format!(
                "the drag of the air would have to be {} times that of its law, where {least} to {most} are usual: \
                check titre, throughput, melt and air",
                significant(factor, 2)
            ));
        }
        Ok(file(&self.text(line, &air, factor)))
    }

    /// The tables of the spinline.
    fn text(&self, line: &NewLine<'_>, air: &str, drag_factor: f64) -> String {
        let MeltNumbers {
            die_temperature, melt_flow_rate, viscosity, hole_diameter, spinline_length, ..
        } = self.given;
        let assumed = |is_assumed: bool| if is_assumed { "   # assumed" } else { "" };
        let material = line.polymer.material(false);
        let melt = match (value(melt_flow_rate), value(viscosity)) {
            (_, Some(viscosity)) => {
                let viscosity = Dimension::DynamicViscosity.pretty_to(viscosity, GIVEN as usize);
                let at = Dimension::Temperature.pretty(material.viscosity_temperature);
                format!("material.viscosity = \"{viscosity}\"   # at {at}")
            }
            (Some(rate), _) => format!("melt_flow_rate = {}", significant(rate, GIVEN)),
            (None, None) if line.polymer == Polymer::Pp => {
                format!("melt_flow_rate = {MELT_FLOW_RATE}   # assumed")
            }
            (None, None) => {
                let viscosity = Dimension::DynamicViscosity.pretty(material.viscosity);
                format!("# melt_flow_rate = …   # not given: {viscosity}, usual of this polymer")
            }
        };
        let temperature = value(die_temperature).unwrap_or(material.viscosity_temperature);
        format!(
            include_str!("spinline.toml"),
            polymer = line.polymer.name(),
            melt = melt,
            die_temperature = Dimension::Temperature.pretty_to(temperature, GIVEN as usize),
            assumed_temperature = assumed(die_temperature.is_none()),
            hole_diameter = length(value(hole_diameter).unwrap_or(HOLE)),
            assumed_hole = assumed(hole_diameter.is_none()),
            length = length(self.length),
            assumed_length = if spinline_length.is_none() { ", assumed" } else { "" },
            air = air,
            drag_factor = significant(drag_factor, 6),
            titre = significant(line.filament.linear_density() * 1e7, 4),
            least = usual_drag()[0],
            most = usual_drag()[1],
        )
    }
}

/// The usual range of the factor on the drag.
fn usual_drag() -> [f64; 2] {
    let usual = keys::find("spinline.drag_factor").and_then(|key| key.usual);
    usual.map_or([0.0, f64::INFINITY], |(least, most)| [least, most])
}
