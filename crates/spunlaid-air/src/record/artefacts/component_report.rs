//! What is reported of the samples of a component that are no velocities.

use super::super::{hertz, number, time};
use super::apart::Apart;
use super::{Record, Robust};
use spunlaid_ground::Fault;
use spunlaid_ground::error::{counted, listed};
use std::ops::Range;

/// Number of stretches whose place is reported.
const MOST_PLACES: usize = 3;
const EMPTY: &str = "leave these cells empty and run the analysis again";

/// Reports of a component.
pub(super) struct ComponentReport<'a> {
    pub(super) record: &'a Record,
    pub(super) name: &'a str,
    pub(super) values: &'a [f64],
}

impl ComponentReport<'_> {
    fn fault(&self, message: &str, remedy: impl Into<std::borrow::Cow<'static, str>>) -> Fault {
        Fault::new(format!("{}: {message}", self.name), remedy)
    }

    /// `data row 12 (at 11 ms)`.
    fn place(&self, sample: usize) -> String {
        let row = self.record.reading.cut_off_start + sample + 1;
        format!("data row {row} (at {})", time(sample as f64 * self.record.interval))
    }

    fn share(&self, samples: usize) -> String {
        number(100.0 * samples as f64 / self.values.len() as f64)
    }

    /// The fault of a number that stands for a missing value, without the name of the component.
    pub(super) fn sentinel(&self, samples: &[usize], written: &str) -> Fault {
        let count = samples.len() as u64;
        let (be, first) = if count == 1 { ("is", "in") } else { ("are", "the first in") };
        let place = self.place(samples.first().copied().unwrap_or(0));
        Fault::new(
            format!(
                "{} {be} {written}, {first} {place}: this number means a missing value and is not a velocity",
                counted(count, "sample")
            ),
            "leave these cells empty",
        )
    }

    pub(super) fn dropouts(&self, apart: &Apart) -> Fault {
        let (low, high) = apart.values;
        let values =
            if low == high { number(low) } else { format!("between {} and {}", number(low), number(high)) };
        let message = format!(
            "{} samples ({} %), the first in {}, are all {values} m/s, apart from all others: these are \
             dropouts and not velocities, and make the rms too large",
            apart.samples.len(),
            self.share(apart.samples.len()),
            self.place(apart.samples.first().copied().unwrap_or(0)),
        );
        self.fault(&message, EMPTY)
    }

    pub(super) fn clipping(&self, samples: usize, extreme: f64) -> Fault {
        let message = format!(
            "{samples} samples are all {} m/s, the extreme of the record: the instrument seems to clip at this value, \
             which makes the rms too small",
            number(extreme)
        );
        self.fault(&message, "measure with a wider range")
    }

    pub(super) fn frozen(&self, stretches: &[Range<usize>]) -> Fault {
        let samples: usize = stretches.iter().map(ExactSizeIterator::len).sum();
        let one = |stretch: &Range<usize>| {
            let length = time(stretch.len() as f64 * self.record.interval);
            format!(
                "{} from {} on, {length} long",
                counted(stretch.len() as u64, "sample"),
                self.place(stretch.start)
            )
        };
        let mut places: Vec<String> = stretches.iter().take(MOST_PLACES).map(one).collect();
        match stretches.len().saturating_sub(MOST_PLACES) {
            0 => {}
            more => places.push(format!("{more} more")),
        }
        let message = format!(
            "the value is frozen in {} of equal samples, {} % of the record ({}): this is not turbulence, \
             and rms and integral time are not those of the air",
            if stretches.len() == 1 {
                "one stretch".to_owned()
            } else {
                format!("{} stretches", stretches.len())
            },
            self.share(samples),
            listed(&places),
        );
        self.fault(&message, "cut the record before and after them")
    }

    pub(super) fn held(&self, times: f64) -> Fault {
        let written = 1.0 / self.record.interval;
        let rate = 1.0 / (self.record.interval * times);
        let on_average = if times.fract() == 0.0 { "" } else { " on average" };
        let message = format!(
            "each value occurs {} times in a row{on_average}, so the true sampling rate is {} and not {}: \
             a staircase has another spectrum and another integral time than the air",
            number(times),
            hertz(rate),
            hertz(written),
        );
        self.fault(&message, format!("keep each value once, with a sampling rate of {}", hertz(rate)))
    }

    pub(super) fn irregular(&self, share: f64, explained: f64) -> Fault {
        let message = format!(
            "{} % of the samples are equal to the one before, where the resolution of the values explains \
             {} %. Values are held until the next one comes, and a staircase has another spectrum and \
             another integral time than the air",
            number(100.0 * share),
            number(100.0 * explained),
        );
        self.fault(&message, "write only the samples that were measured, evenly in time")
    }

    pub(super) fn spikes(&self, samples: &[usize], robust: &Robust) -> Option<Fault> {
        let distance = |i: usize| robust.distance(self.values[i]);
        let farthest = samples.iter().copied().max_by(|a, b| distance(*a).total_cmp(&distance(*b)))?;
        let nearest = samples.iter().map(|i| distance(*i)).fold(f64::INFINITY, f64::min);
        let at = format!("{} m/s in {}", number(self.values[farthest]), self.place(farthest));
        let far = number(distance(farthest));
        let message = match samples.len() {
            1 => format!(
                "{at} is {far} standard deviations from the median; such a spike is not turbulence and spoils every \
                 result"
            ),
            count => format!(
                "{count} spikes ({} %): samples that jump away and back, {} to {far} standard deviations \
                 from the median, the farthest {at}. They are not turbulence, make the rms too large and \
                 the integral time too short, and raise the end of the spectrum",
                self.share(count),
                number(nearest),
            ),
        };
        Some(self.fault(&message, EMPTY))
    }
}
