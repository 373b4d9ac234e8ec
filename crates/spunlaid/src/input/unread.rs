//! What is handed back of a file that cannot be read to its end without flights. No reader flies fibres:
//! whoever reads the file does, with threads, progress and a stop of its own.

use super::fed_back_tension::FlownTension;
use super::lookup::Lookup;
use crate::ensemble::RunControl;
use crate::error::{Error, Fault};
use crate::threads::try_each;
use std::fmt;
use std::sync::atomic::Ordering;

/// Why a file is not read to its end. It is deliberately no [`Error`] of its own accord, so that nobody
/// forgets the second reason.
pub enum Unread<T> {
    /// The file is wrong, or cannot be read.
    Faulty(Error),
    /// Flights have to find tensions at the ends of spinlines first, `spinline.end_tension = "flown"`.
    Unflown(Box<Unflown<T>>),
}

/// A file that has been read but for tensions that flights have to find.
pub struct Unflown<T> {
    lookup: Lookup,
    read: Reading<T>,
    without: Result<T, Error>,
}

/// Reads a file with what has been looked up so far.
type Reading<T> = Box<dyn Fn(&Lookup) -> Result<T, Error> + Send>;

/// Where tensions outlive the process that has found them.
pub trait KeptTensions: Sync {
    /// The tension of the case with this identity, if it has been kept.
    fn recall(&self, identity: u64) -> Option<FlownTension>;

    /// Keeps the tension of a case.
    ///
    /// # Errors
    /// If it cannot be kept.
    fn keep(&self, identity: u64, found: FlownTension) -> Result<(), Error>;
}

/// Keeps nothing.
struct NothingKept;

impl KeptTensions for NothingKept {
    fn recall(&self, _: u64) -> Option<FlownTension> {
        None
    }

    fn keep(&self, _: u64, _: FlownTension) -> Result<(), Error> {
        Ok(())
    }
}

/// Reads a file as far as it goes without flights.
pub(super) fn read<T>(read: impl Fn(&Lookup) -> Result<T, Error> + Send + 'static) -> Result<T, Unread<T>> {
    go_on(Lookup::default(), Box::new(read))
}

fn go_on<T>(lookup: Lookup, read: Reading<T>) -> Result<T, Unread<T>> {
    let outcome = read(&lookup);
    // Other problems are told at once.
    if lookup.wanted() == 0 || outcome.is_err() && !lookup.is_in_doubt() {
        return outcome.map_err(Unread::Faulty);
    }
    Err(Unread::Unflown(Box::new(Unflown { lookup, read, without: outcome })))
}

impl<T> Unflown<T> {
    /// Number of tensions that have to be found.
    pub fn tensions(&self) -> usize {
        self.lookup.wanted()
    }

    /// Steps of all fibres that fly for them at most, which [`RunControl::fibre_steps`] counts; those that
    /// are not needed count as flown.
    pub fn most_steps(&self) -> u64 {
        self.lookup.most_steps()
    }

    /// The file with tensions of zero, which are not those of flights; each has a note that says so.
    ///
    /// # Errors
    /// If there are problems that may go away with the tensions.
    pub const fn without_flights(&self) -> Result<&T, &Error> {
        self.without.as_ref()
    }

    /// Flies the fibres and reads the file to its end. The tensions have the same bits for any number of threads.
    ///
    /// # Errors
    /// If a fibre is lost, if the flights are stopped, or if the file is wrong. Other flights may follow from these.
    pub fn fly(self, by: RunControl<'_>) -> Result<T, Unread<T>> {
        self.fly_and_keep(by, &NothingKept)
    }

    /// [`Unflown::fly`], where tensions that are kept are not flown again.
    ///
    /// # Errors
    /// As [`Unflown::fly`], and if a tension cannot be kept.
    pub fn fly_and_keep(self, by: RunControl<'_>, kept: &dyn KeptTensions) -> Result<T, Unread<T>> {
        let Self { mut lookup, read, .. } = self;
        let wanted = lookup.take_wanted();
        // The fibres of a case fly in one bundle.
        let each = RunControl { threads: 1, ..by };
        let found = try_each(by.threads, wanted.len(), |number| {
            let wanted = &wanted[number];
            if let Some(found) = kept.recall(wanted.identity) {
                by.fibre_steps.fetch_add(wanted.most_steps, Ordering::Relaxed);
                return Ok(Some(found));
            }
            let found = wanted.open.find_tension(each)?;
            found.map_or(Ok(()), |found| kept.keep(wanted.identity, found))?;
            Ok(found)
        });
        for (wanted, found) in wanted.iter().zip(found.map_err(Unread::Faulty)?) {
            lookup.add(wanted.identity, found);
        }
        go_on(lookup, read)
    }
}

impl<T> Unread<T> {
    /// Flies what has to be flown, and reads the file to its end.
    ///
    /// # Errors
    /// If a fibre is lost, if the flights are stopped, or if the file is wrong.
    pub fn fly(self, by: RunControl<'_>) -> Result<T, Error> {
        let mut unread = self;
        loop {
            unread = match unread {
                Self::Faulty(error) => return Err(error),
                Self::Unflown(unflown) => match unflown.fly(by) {
                    Ok(read) => return Ok(read),
                    Err(other) => other,
                },
            };
        }
    }

    /// The error where nothing is flown: a file that needs flights is refused.
    pub fn refuse(self) -> Error {
        match self {
            Self::Faulty(error) => error,
            Self::Unflown(_) => Fault::new(
                "spinline.end_tension = \"flown\" takes flights, and nothing flies here",
                "write the tension that a run of this case tells",
            )
            .into(),
        }
    }

    /// The file with tensions of zero in place of those of flights, each with a note that says so.
    ///
    /// # Errors
    /// If it is wrong; problems that may go away with the tensions are among them.
    pub fn without_flights(self) -> Result<T, Error> {
        match self {
            Self::Faulty(error) => Err(error),
            Self::Unflown(unflown) => unflown.without,
        }
    }
}

impl<T> fmt::Display for Unread<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Faulty(error) => error.fmt(f),
            Self::Unflown(unflown) => {
                write!(f, "flights have to find {} tensions at the ends of spinlines", unflown.tensions())
            }
        }
    }
}

impl<T> fmt::Debug for Unread<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Faulty(error) => f.debug_tuple("Faulty").field(error).finish(),
            Self::Unflown(unflown) => f.debug_tuple("Unflown").field(unflown).finish(),
        }
    }
}

impl<T> fmt::Debug for Unflown<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Unflown").field("tensions", &self.tensions()).finish_non_exhaustive()
    }
}

impl<T> std::error::Error for Unread<T> {}
