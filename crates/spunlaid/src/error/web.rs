//! Errors of the file of a web.

use super::words::{all_of, did_you_mean};
use crate::units::Dimension;

/// What is wrong with a value of the file of a web; the message continues after `key = value `.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WebFault {
    /// The file is a case.
    #[error(
        "belongs to a case, not to a web; a web names its case, as in [laydown] case = \"spunbond.toml\""
    )]
    IsCase,
    /// The file is a study.
    #[error("belongs to a study, not to a web")]
    IsStudy,
    /// No key or table has this name.
    #[error("is unknown in the file of a web; {}", did_you_mean(nearest, || format!("{where_} takes {}", all_of(known))))]
    Unknown {
        /// The most similar name.
        nearest: Option<String>,
        /// The table, or the top of the file.
        where_: String,
        /// The names that are known there.
        known: Vec<&'static str>,
    },
    /// A table of a layer stands beside `[[layer]]`.
    #[error(
        "is of the only layer of a web, and this file has [[layer]]; write it as [layer.{table}] below its [[layer]]"
    )]
    BesideLayers {
        /// Name of the table.
        table: &'static str,
    },
    /// An override does not say which layer it is for.
    #[error("does not say of which layer; write layer.1.{key}, or the layer's name in place of 1")]
    WhichLayer {
        /// The key.
        key: String,
    },
    /// There is no such layer.
    #[error("is of a layer that the file does not have; {}", layers_there(*layers))]
    NoSuchLayer {
        /// Number of layers in `[[layer]]` tables.
        layers: usize,
    },
    /// Two layers have the same name.
    #[error("is also the name of layer {other}; give each layer a name of its own")]
    NameTwice {
        /// Number of the other layer, from 1.
        other: usize,
    },
    /// Nothing says how the fibres lie.
    #[error(
        "says nothing of how the fibres lie; write in it case = \"spunbond.toml\" (a case to fly), results = \
         \"results/spunbond\" (a finished run), or sigma_md, sigma_cd and noise"
    )]
    NoLaydown,
    /// The folder holds no results of a run.
    #[error(
        "does not hold the results of a run ({missing} is not there); name a folder that `spunlaid run` has written"
    )]
    NotARun {
        /// The file that is missing.
        missing: &'static str,
    },
    /// The case has a fibre of fixed length.
    #[error("is the case of a fibre of fixed length, which lays nothing; name a case with [feed] and [belt]")]
    NotFed,
    /// The case's belt stands still.
    #[error(
        "has a belt that stands still (belt.speed = 0 m/s), on which no web is laid; give the belt of the case a speed"
    )]
    StillBelt,
    /// The value differs from that with which the fibres are flown.
    #[error(
        "differs from {key} = {value} of {case}, with which the fibres are flown, and they would lie otherwise; leave \
         it out here, and set it in the case"
    )]
    OtherThanFlown {
        /// The key in the case.
        key: &'static str,
        /// The value there.
        value: String,
        /// Path of the case.
        case: String,
    },
    /// The belt is faster than the fibre.
    #[error("is more than line.feed_speed = {}, which would tear the fibre; slow the belt, or feed faster", Dimension::Velocity.pretty(*feed))]
    BeltTooFast {
        /// Speed of the feed [m/s].
        feed: f64,
    },
    /// Layers with belts of different speeds.
    #[error("differs from the belt speed of layer 1, {}; all layers lie on one belt", Dimension::Velocity.pretty(*first))]
    TwoBelts {
        /// Belt speed of the first layer [m/s].
        first: f64,
    },
    /// Nothing says how many filaments there are.
    #[error(
        "is missing; add filaments_per_metre = 5000 to [{table}], or rows = [{{ offset = \"0 mm\", pitch = \"0.2 mm\", \
         filaments = 5000 }}]"
    )]
    NoFilaments {
        /// The table it belongs in.
        table: &'static str,
    },
    /// There is no such row of nozzles.
    #[error("is of a row of nozzles that is not there: line.rows has {rows}; write the whole list of rows")]
    NoSuchRow {
        /// Number of rows.
        rows: u64,
    },
    /// The number of filaments rounds to none.
    #[error("lays no filament on a web of web.width = {}; write {least} or more", Dimension::Length.pretty(*width))]
    LaysNothing {
        /// Width of the web [m].
        width: f64,
        /// Least number of filaments per metre that lays one.
        least: u64,
    },
    /// A row whose width is not that of a periodic web.
    #[error(
        "at a pitch of {} make a row of {}, and with web.edges = \"periodic\" a row must be as wide as the web, {}; write \
         web.width = \"{}\"; or write web.edges = \"cut\", and the edges, where the web is thin, are left out of the CV",
        Dimension::Length.pretty_to(*pitch, 8), Dimension::Length.pretty_to(*beam, 8),
        Dimension::Length.pretty_to(*width, 8), Dimension::Length.pretty_to(*beam, 12)
    )]
    RowNotPeriodic {
        /// Distance from nozzle to nozzle [m].
        pitch: f64,
        /// Pitch times number of nozzles [m].
        beam: f64,
        /// Width of the web [m].
        width: f64,
    },
    /// A row that lies beside the web.
    #[error(
        "begins a row from {} to {}, beside the web, which goes from 0 mm to {}; move the row, or widen the web",
        Dimension::Length.pretty(*from), Dimension::Length.pretty(*to), Dimension::Length.pretty(*width)
    )]
    RowBeside {
        /// Place of the first nozzle [m].
        from: f64,
        /// Place of the last nozzle [m].
        to: f64,
        /// Width of the web [m].
        width: f64,
    },
    /// A size that is not a whole number of cells.
    #[error("is not a whole number of cells of {}; write {}, or another web.cell", Dimension::Length.pretty(*cell), nearest(*size, *cell))]
    NotWholeCells {
        /// The size [m].
        size: f64,
        /// Side of a cell [m].
        cell: f64,
    },
    /// A patch that is not a whole number of cells.
    #[error(
        "has {}, which is not a whole number of cells of {}; write {}, or another web.cell",
        Dimension::Length.pretty(*patch), Dimension::Length.pretty(*cell), nearest(*patch, *cell)
    )]
    PatchNotWholeCells {
        /// Side of the patch [m].
        patch: f64,
        /// Side of a cell [m].
        cell: f64,
    },
    /// A patch that does not fit twice.
    #[error(
        "has {}, which is more than half of the web's smaller side, {}, so that there is nothing to compare; leave it \
         out, or make the web larger",
        Dimension::Length.pretty(*patch), Dimension::Length.pretty(*side)
    )]
    PatchTooLarge {
        /// Side of the patch [m].
        patch: f64,
        /// Smaller side of the web [m].
        side: f64,
    },
    /// None of the usual patches fits.
    #[error(
        "is missing, and none of the usual patches, 1, 2, 5, 10, 20 and 50 mm, is a whole number of cells of {} and at most \
         half as large as the web; add patches = [\"{}\"] to [web], or change web.cell",
        Dimension::Length.pretty(*cell), Dimension::Length.pretty_to(*cell, 12)
    )]
    NoPatches {
        /// Side of a cell [m].
        cell: f64,
    },
    /// More patches than are compared.
    #[error("lists {patches} patches; at most {most} are compared")]
    TooManyPatches {
        /// Number of patches.
        patches: usize,
        /// The most allowed.
        most: usize,
    },
    /// More cells than are allowed.
    #[error(
        "makes {cells:.1e} cells of {} in the web; at most {most:e} are possible; make the cells larger, or the web smaller",
        Dimension::Length.pretty(*cell)
    )]
    TooManyCells {
        /// Number of cells.
        cells: f64,
        /// The most allowed.
        most: f64,
        /// Side of a cell [m].
        cell: f64,
    },
    /// A sheet on which a filament meets itself.
    #[error(
        "is shorter than 8 times {sigma} = {}, and a filament that leaves the web at one end comes in at the other and \
         would meet itself; write {} or more",
        Dimension::Length.pretty(*spread), Dimension::Length.pretty(8.0 * spread)
    )]
    TooSmall {
        /// The key of the spread.
        sigma: &'static str,
        /// The spread [m].
        spread: f64,
    },
    /// Flown fibres are wanted where there are none.
    #[error(
        "lays the curves of flown fibres, and {laydown} gives numbers; write method = \"surrogate\", or name a case or \
         results there"
    )]
    NothingFlown {
        /// The table of the numbers.
        laydown: String,
    },
    /// A window that is larger than the web.
    #[error("is larger than the web's smaller side, {}; write a smaller one", Dimension::Length.pretty(*side))]
    WindowTooLarge {
        /// Smaller side of the web [m].
        side: f64,
    },
}

/// The whole numbers of cells nearest to a size: `333 mm or 333.5 mm`.
fn nearest(size: f64, cell: f64) -> String {
    let below = (size / cell).floor();
    let shown = |cells: f64| Dimension::Length.pretty_to(cells * cell, 12);
    if below < 1.0 { shown(1.0) } else { format!("{} or {}", shown(below), shown(below + 1.0)) }
}

fn layers_there(layers: usize) -> String {
    match layers {
        0 => "it has no [[layer]], so write the key without layer".to_owned(),
        1 => "it has one, layer.1".to_owned(),
        _ => format!("it has layer.1 to layer.{layers}, which may also be called by their names"),
    }
}
