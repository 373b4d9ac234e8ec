//! Finds the rate of a clock, and the rows that are missing, from the times of the rows.

use super::grid::{JITTER, Known, TimeGrid};
use spunlaid_ground::units::shortest;
use spunlaid_ground::{Dimension, Fault};

/// Largest deviation that the rounding of written times may explain, as a share of a step.
const ROUNDING: f64 = 0.25;
/// Rounding above this share of a step lets no single step show whether a sample is missing.
const COARSE: f64 = 0.45;
/// Rows over which the usual step is found.
const WINDOW: usize = 256;

/// Where the rows stand in an even record.
#[derive(Debug, Default)]
pub(super) struct Spacing {
    /// Time between samples [s]; none if fewer than two times are known.
    pub(super) interval: Option<f64>,
    /// Rows before which samples are missing, and how many.
    pub(super) lost: Vec<(usize, usize)>,
    /// Largest deviation of a step from the usual one, as a share of it.
    pub(super) jitter: f64,
    /// What the times leave open.
    pub(super) doubt: Option<Fault>,
}

/// What is wrong with the times, and at which row.
pub(super) type Trouble = (usize, Fault);

/// Places rows by their times [s], which are NaN where they are missing.
///
/// * `unit` – unit of the last digit as the times are written [s]
pub(super) fn place(times: &[f64], unit: f64) -> Result<Spacing, Trouble> {
    let known = || times.iter().copied().enumerate().filter(|(_, time)| !time.is_nan());
    for ((_, last), (row, time)) in known().zip(known().skip(1)) {
        let step = time - last;
        if !step.is_finite() || step <= 0.0 {
            return Err((row, not_in_order(last, time)));
        }
    }
    let Some(usual) = usual_step(known) else { return Ok(Spacing::default()) };
    let grid = TimeGrid::of(known(), unit, usual);
    let step_by_step = |slack: f64| by_steps(known(), usual, slack);
    match grid {
        Some(grid) if grid.size >= COARSE * usual => {
            let known: Known = known().collect();
            match grid.place(&known) {
                Some(lost) => {
                    let placed = spacing(&known, lost, 0.0);
                    let doubt = placed.interval.and_then(|interval| grid.regular(&known, interval));
                    Ok(Spacing { doubt, ..placed })
                }
                None => Err(step_by_step(unit).err().unwrap_or_else(|| (known[1].0, grid.doubt()))),
            }
        }
        Some(grid) => step_by_step(grid.size.max(2.0 * unit)),
        None => step_by_step((2.0 * unit).min(ROUNDING * usual)),
    }
}

/// The spacing of rows that are known to be placed so.
fn spacing(known: &[(usize, f64)], lost: Vec<(usize, usize)>, jitter: f64) -> Spacing {
    let all: usize = lost.iter().map(|(_, lost)| lost).sum();
    let interval = match known {
        [(first_row, first), .., (row, time)] => Some((time - first) / (row + all - first_row) as f64),
        _ => None,
    };
    Spacing { interval, lost, jitter, doubt: None }
}

/// The median of the step over stretches of the record; none if fewer than two times are known.
fn usual_step<I: Iterator<Item = (usize, f64)>>(known: impl Fn() -> I) -> Option<f64> {
    let stride = (known().count() / 8).clamp(1, WINDOW);
    let ends: Known = known().step_by(stride).collect();
    let mut steps: Vec<f64> =
        ends.windows(2).map(|ends| (ends[1].1 - ends[0].1) / (ends[1].0 - ends[0].0) as f64).collect();
    let middle = steps.len().checked_sub(1)? / 2;
    Some(*steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Places rows whose every step reports by itself how many samples it spans.
///
/// * `slack` – how much rounding may change a step [s]
fn by_steps(known: impl Iterator<Item = (usize, f64)>, usual: f64, slack: f64) -> Result<Spacing, Trouble> {
    let mut ends = None;
    let mut lost = Vec::new();
    let mut jitter = 0.0f64;
    let bound = JITTER * usual + slack;
    let mut before: Option<(usize, f64)> = None;
    for (row, time) in known {
        let Some((last_row, last)) = before.replace((row, time)) else {
            ends = Some((row, time));
            continue;
        };
        let (step, rows) = (time - last, (row - last_row) as f64);
        let off = (step - rows * usual).abs();
        if off <= bound {
            jitter = jitter.max(off / usual);
            continue;
        }
        let whole = (step / usual).round();
        let skips = whole > rows && (step - whole * usual).abs() <= bound + JITTER * (whole - rows) * usual;
        if !skips {
            return Err((row, uneven(usual, step / rows)));
        }
        lost.push((row, (whole - rows) as usize));
    }
    let known: Known = ends.into_iter().chain(before).collect();
    Ok(spacing(&known, lost, jitter))
}

fn not_in_order(last: f64, time: f64) -> Fault {
    Fault::new(
        format!("time goes from {} s to {} s", shortest(last), shortest(time)),
        "rows must be in order of time. If the times are only written with too few digits, give the sampling rate",
    )
    .option("--rate")
}

fn uneven(usual: f64, step: f64) -> Fault {
    Fault::new(
        format!(
            "the time step changes from {} to {}",
            Dimension::Time.pretty(usual),
            Dimension::Time.pretty(step)
        ),
        "samples must be evenly spaced to within 1 %. Resample the record, or give the sampling rate if \
        you know that the clock was uniform",
    )
    .option("--rate")
}
