//! What leaves a solved spinline: `summary.json` and `spinline.parquet`.

mod stations;
mod summary;
mod words;

pub use stations::{COLUMNS, STATIONS, write as write_stations};
pub use summary::{part_of_case, summary};
pub use words::{filament, freezing, influence, model_error, numerical_error, remarks};

use spunlaid::case::Case;
use spunlaid::error::Error;
use spunlaid::input::{Influence, SpinFile};
use spunlaid::spinline::Solution;

/// A solved spinline, and what decides its diameter.
#[derive(Clone, Debug)]
pub struct SpinResults {
    /// The solution of each row of the curtain, the quenched side first; one if there is no curtain.
    pub rows: Vec<Solution>,
    /// The influences on the diameter, the largest first.
    pub influences: Vec<Influence>,
}

impl SpinResults {
    /// Solves a spinline.
    ///
    /// # Errors
    /// If it has no steady state that a line could run in.
    pub fn new(file: &SpinFile) -> Result<Self, Error> {
        let rows = file.solve()?;
        let influences = rows.first().map_or_else(Vec::new, |first| file.influences(first));
        Ok(Self { rows, influences })
    }

    /// The spinline from which a case is fed, solved again, which takes milliseconds; `None` if the case has none.
    pub fn from_case(case: &Case) -> Option<Self> {
        // The case could be read, so its spinline can be solved.
        Self::new(&SpinFile::from_case(case)?).ok()
    }
}
