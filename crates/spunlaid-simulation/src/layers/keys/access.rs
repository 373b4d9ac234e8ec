//! How keys read and change a web.

use crate::layers::{LayerSpec, WebSpec};
use spunlaid_fibre::FedFilament;
use spunlaid_fibre::case::keys::Key;
use spunlaid_fibre::case::keys::row::AccessTo;
use spunlaid_ground::Fault;
use spunlaid_web::map::Filaments;
use spunlaid_web::{Defect, Row};

/// A key of a web.
pub type WebKey = Key<WebSpec>;
/// Access to a web.
pub type Access = AccessTo<WebSpec>;

/// Access to a known number of the surrogate.
macro_rules! of_surrogate {
    ($field:ident) => {
        spunlaid_fibre::case::keys::row::within!(
            |web| &layer(web)?.source,
            &mut layer_mut(web)?.source,
            LaydownSource::Surrogate(surrogate) => surrogate.$field,
            Fault::needs("laydown without a case", "leave it out, or leave this out")
        )
    };
}

pub(super) use of_surrogate;

/// Access to a number of the filament where it is given in this way.
macro_rules! given {
    ($field:ident, $way:path) => {
        Access {
            get: |web| match filament(web)?.$field {
                $way(number) => Some(number.into()),
                _ => None,
            },
            set: |web, value| {
                filament_mut(web)?.$field = $way(number(value)?);
                Ok(())
            },
        }
    };
}

pub(super) use given;

/// The fault of a depth beside rows.
pub fn in_rows() -> Fault {
    Fault::excludes(
        "line.rows",
        "rows have their own positions in machine direction, rows.md; keep one of them",
    )
}

/// Whether the case of simulated fibres gives the value.
pub(super) fn is_flown(web: &WebSpec) -> bool {
    layer(web).is_some_and(|layer| layer.source.case().is_some())
}

pub(super) fn layer(web: &WebSpec) -> Option<&LayerSpec> {
    web.layers.first()
}

pub(super) fn layer_mut(web: &mut WebSpec) -> Result<&mut LayerSpec, Fault> {
    web.layers.first_mut().ok_or_else(|| Fault::needs("[line]", "write the tables of a layer"))
}

/// The filament of the first layer.
pub(super) fn filament(web: &WebSpec) -> Option<&FedFilament> {
    layer(web).map(|layer| &layer.filament)
}

pub(super) fn filament_mut(web: &mut WebSpec) -> Result<&mut FedFilament, Fault> {
    layer_mut(web).map(|layer| &mut layer.filament)
}

/// The first row of holes.
pub(super) fn row(web: &WebSpec) -> Option<&Row> {
    match &layer(web)?.filaments {
        Filaments::Rows(rows) => rows.first(),
        Filaments::AtRandom { .. } | Filaments::Slot { .. } => None,
    }
}

pub(super) fn row_mut(web: &mut WebSpec) -> Result<&mut Row, Fault> {
    let row = match &mut layer_mut(web)?.filaments {
        Filaments::Rows(rows) => rows.first_mut(),
        Filaments::AtRandom { .. } | Filaments::Slot { .. } => None,
    };
    row.ok_or_else(|| Fault::needs("line.rows", "leave it out"))
}

/// The first defect of the first layer.
pub(super) fn defect(web: &WebSpec) -> Option<&Defect> {
    layer(web)?.defects.first()
}

pub(super) fn defect_mut(web: &mut WebSpec) -> Result<&mut Defect, Fault> {
    let defect = layer_mut(web)?.defects.first_mut();
    defect.ok_or_else(|| Fault::needs("line.defects", "write a list of defects"))
}
