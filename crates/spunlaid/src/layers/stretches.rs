//! A sheet in stretches along the belt, which any machines lay from one flight and which are joined to the same bits.

use super::flown_curtain::{DrawnCurtains, FlownCurtains, FlownLayers};
use super::flyer::web_to_lay;
use super::shared_air::canvas;
use super::{FlownWeb, Flyer, Method, WebSpec};
use crate::error::{Error, Fault};
use crate::sort::sort_by_key;
use crate::units::Dimension;
use crate::web::{LaidWeb, LayControl};
use std::ops::Range;

/// A web in one air of which a few filaments have been flown, and nothing has been laid yet.
#[derive(Clone, Debug)]
pub struct WebFlight {
    spec: WebSpec,
    flown: FlownLayers,
}

/// A stretch of the sheet along the belt, with all that lies on it.
#[derive(Clone, Debug)]
pub struct LaidStretch {
    /// Its rows of cells on the sheet.
    pub rows: Range<usize>,
    /// What lies there; `shared_air` is that of the flight.
    pub laid: LaidWeb,
    /// What was found on the way.
    pub drawn: DrawnCurtains,
}

impl Flyer<'_> {
    /// Flies a few filaments of a web in one air.
    ///
    /// # Errors
    /// If its filaments are independent, or if all of them would fly; and as [`Flyer::web`].
    pub fn flight(&self, spec: &WebSpec) -> Result<WebFlight, Error> {
        if spec.method != Method::SharedAir {
            return Err(Fault::new(
                "the filaments of this web are independent, and each of them lies along the whole sheet; \
                stretches are laid of a web in one air",
                "lay it at once, or write web.method = \"shared-air\"",
            )
            .into());
        }
        Ok(WebFlight { spec: spec.clone(), flown: self.fly_few(spec)? })
    }
}

impl WebFlight {
    /// What was flown, from which every stretch is laid.
    pub const fn curtains(&self) -> &FlownCurtains {
        &self.flown.curtains
    }

    /// The rows of as many stretches, of nearly equal length.
    ///
    /// # Errors
    /// If there are fewer rows of cells, or none is asked for.
    pub fn stretches(&self, count: usize) -> Result<Vec<Range<usize>>, Fault> {
        let rows = self.spec.sheet.cells()[1];
        if !(1..=rows).contains(&count) {
            return Err(Fault::new(
                format!("a sheet of {rows} rows of cells has no {count} stretches of one row or more"),
                format!("ask for 1 to {rows} of them"),
            ));
        }
        Ok((0..count).map(|i| rows * i / count..rows * (i + 1) / count).collect())
    }

    /// Joins stretches of this flight, in any order, to the sheet as it is laid at once.
    ///
    /// # Errors
    /// If a part of the sheet is missing or there twice.
    pub fn join(&self, mut stretches: Vec<LaidStretch>) -> Result<FlownWeb, Error> {
        sort_by_key(&mut stretches, |stretch| stretch.rows.start);
        let [_, rows] = self.spec.sheet.cells();
        let mut end = 0;
        let ends = stretches.iter().map(|stretch| stretch.rows.clone()).chain(std::iter::once(rows..rows));
        for next in ends {
            let from_to = |rows: Range<usize>| {
                [rows.start, rows.end]
                    .map(|row| Dimension::Length.pretty(row as f64 * self.spec.sheet.cell))
                    .join(" to ")
            };
            if next.start > end {
                return Err(Fault::new(
                    format!("the stretch of the sheet from {} is missing", from_to(end..next.start)),
                    "lay it as well: stretches of the same flight fit together",
                )
                .into());
            }
            if next.start < end {
                return Err(Fault::new(
                    format!("the sheet from {} is in two stretches", from_to(next.start..end.min(next.end))),
                    "give each part of the sheet once",
                )
                .into());
            }
            end = next.end;
        }
        let mut flown = self.flown.clone();
        let mut laid = Vec::new();
        for stretch in stretches {
            flown.add(stretch.drawn);
            laid.push(stretch.laid);
        }
        let FlownLayers { layers, pieces, shared_air, .. } = flown;
        let laid = LaidWeb::joined(laid).map(|laid| LaidWeb { pieces, shared_air: Some(shared_air), ..laid });
        Ok(FlownWeb {
            web: web_to_lay(&self.spec, &layers),
            layers,
            laid,
            windows: self.spec.windows().counted,
        })
    }
}

impl FlownCurtains {
    /// Lays a stretch of the sheet.
    ///
    /// * `spec` – the web that was flown
    /// * `rows` – of cells on the sheet
    ///
    /// # Errors
    /// If the web cannot be laid, or if it is stopped.
    pub fn lay(&self, spec: &WebSpec, rows: Range<usize>, by: LayControl<'_>) -> Result<LaidStretch, Error> {
        let canvas = canvas(spec, rows.clone())?;
        let drawn = self.draw(spec, &canvas, (by.threads, by.stop))?;
        Ok(LaidStretch { rows, laid: canvas.finish()?, drawn })
    }
}
