//! What a few filaments say of a web of many.

/// The CV of a web of many filaments over patches of one side, as a few of them give it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SubsampleCv {
    /// Side of the patches [m].
    pub patch: f64,
    /// CV of the web of all filaments; zero where the filaments take all of CV² for their own part.
    pub cv: f64,
    /// Its standard error by chance: the clouds on the sheet that was simulated are few. None if the sheet is too
    /// small to say.
    pub by_chance: Option<f64>,
    /// Its standard error because few filaments were simulated: from what every second one of them says.
    pub by_pitch: f64,
    /// How far every second filament is off, as a fraction of the CV, or of that of the map where they are filled in.
    pub of_halves: f64,
    /// How far it is off at least by what filling in leaves out of the filaments of a slot, as a fraction of the CV;
    /// zero where nothing is filled in. Counts where every second filament shows less.
    pub by_missing: f64,
    /// Part of CV² that filaments make each for itself, which falls with their number. Zero of rows.
    pub own: f64,
    /// CV of the few filaments alone.
    pub few: f64,
    /// What CV² of all has more than that of a map in which those between the few are filled in, each at its own place
    /// and without a defect; of filaments at random places, that of an even row. Zero where such a map gives it; in a
    /// slot what (83p) takes off the map, below zero.
    pub beyond_filling: f64,
    /// What CV² over a larger area, which was simulated coarsely, has more than that of the sheet; zero without.
    pub beyond_sheet: f64,
}

impl SubsampleCv {
    /// Nothing of it is known yet.
    pub(crate) const UNKNOWN: Self = Self {
        patch: f64::NAN,
        cv: f64::NAN,
        by_chance: None,
        by_pitch: 0.0,
        of_halves: 0.0,
        by_missing: 0.0,
        own: 0.0,
        few: f64::NAN,
        beyond_filling: 0.0,
        beyond_sheet: 0.0,
    };

    /// How far it may be off beyond what every second filament shows, as a fraction of the CV: where much is missing,
    /// two maps lack nearly all that small eddies do, and agree.
    ///
    /// * `of_halves` – as in [`SubsampleCv`]
    pub(crate) fn beyond_halves(&self, of_halves: f64) -> f64 {
        (self.by_missing - of_halves.abs()).max(0.0)
    }

    /// How far every second filament may be off, as a fraction of the CV.
    fn far_off(&self) -> f64 {
        if self.by_missing > 0.0 { FAR_OFF_THAT_IS_TAKEN_OFF } else { FAR_OFF }
    }

    /// With another square of the CV: the errors of the square stay.
    pub(crate) fn with_square(self, square: f64) -> Self {
        let cv = square.max(0.0).sqrt();
        let error = |error: f64| error * self.cv / cv;
        Self { cv, by_chance: self.by_chance.map(error), by_pitch: error(self.by_pitch), ..self }
    }
}

/// Patches that the few filaments of a web in shared turbulence must give well [m], and how far every second one may be
/// off if that matters beside chance.
const TOLD_WELL: f64 = 0.01;
const FAR_OFF: f64 = 0.05;
/// The same where what every second one adds is taken off, and half of it is in the error.
const FAR_OFF_THAT_IS_TAKEN_OFF: f64 = 0.1;
/// Correlation of the places where neighbours come down, at the pitch of the few, below which those between
/// them are not reported.
const TOGETHER: f64 = 0.7;
/// Filaments are left out only where there are so many for each that is simulated.
pub const LEAST_SAVING: f64 = 1.5;
/// A CV whose error by the few is a larger part of it is not distinguished from zero.
const UNCLEAR: f64 = 0.5;
/// How far a number may be above a whole one and still be it.
const WHOLE: f64 = 1e-6;
/// How many times as many filaments as in most airs are simulated, one after the other, where a file leaves their
/// number open.
pub const TRIED: [f64; 3] = [1.0, 2.0, 4.0];
/// How many times as many filaments are advised at least.
const MORE: f64 = 2.0;

/// Why a few filaments do not give the CV of all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SubsampleWarning {
    /// Every second one of them would give another CV over patches of 10 mm or more: side of the patch [m],
    /// and how far it is off as a share of the CV.
    Halves(f64, f64),
    /// Neighbours have too little in common: correlation of the places where they come down.
    Neighbours(f64),
    /// What each filament makes for itself takes nearly all of CV² over patches of a side [m]: what is left
    /// is not distinguished from zero.
    Own(f64),
}

/// What a few filaments of a layer say about all of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SubsampleEstimate {
    /// Number of filaments that were simulated and not lost.
    pub filaments: u64,
    /// Number of those that were lost.
    pub lost: u64,
    /// Size of the sheet that they laid, across and along [m].
    pub sheet: [f64; 2],
    /// Area whose clouds give the CV: of this sheet, and of others that were simulated more coarsely [m²].
    pub area: f64,
    /// The part of it that was simulated as finely as this sheet [m²].
    pub fine_area: f64,
    /// Number of filaments on other sheets that gave the CV and were not lost.
    pub on_other_sheets: u64,
    /// Number of those that were lost.
    pub lost_on_other_sheets: u64,
    /// The standard error of the CV that was wanted, as a fraction of it; None if one sheet is enough.
    pub wanted: Option<f64>,
    /// Distance of neighbours in a row [m].
    pub pitch: f64,
    /// The distance at which few filaments of such an air have been found to give all [m]; zero where it is
    /// not known.
    pub usual_pitch: f64,
    /// Distance of all filaments in a row [m]; zero where it is not known.
    pub pitch_of_all: f64,
    /// Correlation of the places where filaments at this distance and equal depth come down, in the direction
    /// in which it is smaller; None where it was not looked for.
    pub correlation: Option<f64>,
    /// Part of the variance of a filament between them that they do not give, in machine and in cross direction.
    pub missing: [f64; 2],
    /// CV over patches of each size.
    pub cvs: Vec<SubsampleCv>,
    /// What the places of all filaments, in place of usual ones, and their defects add to each CV² on a sheet of
    /// pieces; empty without them, and where the few have laid the whole sheet.
    pub by_places: Vec<f64>,
    /// Of octaves of wavelength [m], how far the variance of the map is off that is filled in from every second one, as
    /// a part of it.
    pub octaves: Vec<([f64; 2], f64)>,
    /// For each of these sizes, how much the blocks of the sheet vary: the mean square of the deviations of
    /// the patches of the few filaments in each block from the mean of all, over that mean. Two webs in the
    /// same air are compared block by block.
    pub blocks: Vec<Vec<f64>>,
    /// Number of blocks across; those beside each other across come one after the other.
    pub blocks_across: usize,
}

impl SubsampleEstimate {
    /// Whether coarse flights over a larger area say its CV too.
    pub fn is_of_two_levels(&self) -> bool {
        self.area > 1.01 * self.sheet[0] * self.sheet[1]
    }

    /// The CV over patches of a side of the sheet with its places and defects.
    pub(crate) fn on_sheet(&self, patch: f64) -> Option<SubsampleCv> {
        let number = self.cvs.iter().position(|cv| cv.patch == patch)?;
        let cv = self.cvs[number];
        Some(self.by_places.get(number).map_or(cv, |more| cv.with_square(cv.cv * cv.cv + more)))
    }

    /// Why they do not give the CV over patches of a side; None if they do.
    pub fn warning_over(&self, patch: f64) -> Option<SubsampleWarning> {
        if let Some(correlation) = self.correlation.filter(|correlation| *correlation < TOGETHER) {
            return Some(SubsampleWarning::Neighbours(correlation));
        }
        let cv = self.cvs.iter().find(|cv| cv.patch == patch)?;
        let is_clear = cv.by_pitch < UNCLEAR * cv.cv;
        if !is_clear {
            return Some(SubsampleWarning::Own(patch));
        }
        // Where chance leaves more open, more filaments would give hardly more.
        let matters = cv.by_chance.is_none_or(|by_chance| cv.by_pitch > by_chance);
        let is_off = patch >= TOLD_WELL && cv.of_halves.abs() > cv.far_off() && matters;
        is_off.then_some(SubsampleWarning::Halves(patch, cv.of_halves))
    }

    /// Why they do not give the CV over patches of every side; None if they do. Of several reasons the strongest.
    pub fn warning(&self) -> Option<SubsampleWarning> {
        let off = |warning: &SubsampleWarning| match warning {
            SubsampleWarning::Halves(_, off) => off.abs(),
            SubsampleWarning::Own(_) => f64::MAX,
            SubsampleWarning::Neighbours(_) => f64::INFINITY,
        };
        let all = self.cvs.iter().filter_map(|cv| self.warning_over(cv.patch));
        all.max_by(|a, b| off(a).total_cmp(&off(b)))
    }

    /// How many filaments fly for each metre of a row where the number is left open: as many as do in most
    /// airs, or two or four times as many, and more than now. None if all of them have to fly, or if the simulated
    /// ones give it.
    pub fn enough_per_metre(&self) -> Option<f64> {
        let times = match self.warning()? {
            SubsampleWarning::Halves(patch, off) => {
                let of_patch = self.cvs.iter().find(|cv| cv.patch == patch);
                (off.abs() / of_patch.map_or(FAR_OFF, SubsampleCv::far_off)).max(MORE)
            }
            SubsampleWarning::Own(_) | SubsampleWarning::Neighbours(_) => MORE,
        };
        let enough = TRIED.map(|tried| (tried / self.usual_pitch - WHOLE).ceil());
        let is_enough = |number: &f64| *number * self.pitch > times - WHOLE;
        let saves = |number: &f64| *number * self.pitch_of_all * LEAST_SAVING <= 1.0;
        enough.into_iter().find(is_enough).filter(saves)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cv(patch: f64, of_halves: f64) -> SubsampleCv {
        SubsampleCv {
            patch,
            cv: 0.2,
            by_chance: Some(0.01),
            by_pitch: 0.011,
            of_halves,
            by_missing: 0.0,
            own: 0.0,
            few: 0.2,
            beyond_filling: 0.0,
            beyond_sheet: 0.0,
        }
    }

    /// Small patches may know the pitch; larger ones must not.
    #[test]
    fn a_few_give_what_every_second_one_gives_too() {
        let cvs = vec![cv(0.002, 0.3), cv(0.01, -0.06), cv(0.02, 0.08), cv(0.05, 0.049)];
        let estimate = SubsampleEstimate { correlation: Some(0.9), cvs, ..SubsampleEstimate::default() };
        let warnings = [0.002, 0.01, 0.02, 0.05].map(|patch| estimate.warning_over(patch).is_some());
        assert_eq!(warnings, [false, true, true, false]);
        assert_eq!(estimate.warning(), Some(SubsampleWarning::Halves(0.02, 0.08)));
        let within_chance = |cv: &SubsampleCv| SubsampleCv { by_chance: Some(0.012), ..*cv };
        let cvs = estimate.cvs.iter().map(within_chance).collect();
        assert_eq!(SubsampleEstimate { cvs, ..estimate.clone() }.warning(), None);
        // What is taken off may be twice as much.
        let filled = |of_halves: f64| {
            let cvs = vec![SubsampleCv { by_missing: 0.01, ..cv(0.01, of_halves) }];
            SubsampleEstimate { cvs, ..estimate.clone() }.warning().is_some()
        };
        assert!(!filled(0.09) && filled(0.11) && filled(-0.11));
    }

    #[test]
    fn neighbours_with_little_in_common_tell_nothing_of_those_between_them() {
        let estimate = SubsampleEstimate {
            correlation: Some(0.69),
            cvs: vec![cv(0.002, 0.0), cv(0.01, 0.2)],
            ..SubsampleEstimate::default()
        };
        assert_eq!(estimate.warning_over(0.002), Some(SubsampleWarning::Neighbours(0.69)));
        assert_eq!(estimate.warning(), Some(SubsampleWarning::Neighbours(0.69)));
        assert_eq!(
            SubsampleEstimate { correlation: Some(0.7), cvs: vec![cv(0.002, 0.0)], ..estimate }.warning(),
            None
        );
    }

    /// Twenty filaments of three thousand left zero of the CV, and its error was not a number.
    #[test]
    fn a_cv_that_is_not_distinguished_from_zero_is_doubted_over_patches_of_any_size() {
        let own = |cv: f64, by_pitch: f64| {
            let cvs = vec![SubsampleCv { cv, by_pitch, ..self::cv(0.002, 0.0) }];
            SubsampleEstimate { correlation: Some(0.9), cvs, ..SubsampleEstimate::default() }
                .warning_over(0.002)
        };
        assert_eq!(own(0.2, 0.09), None);
        for (cv, by_pitch) in [(0.2, 0.11), (0.0, 0.0), (0.0, f64::NAN), (f64::NAN, 0.01), (0.1, f64::NAN)] {
            assert_eq!(own(cv, by_pitch), Some(SubsampleWarning::Own(0.002)), "{cv} {by_pitch}");
        }
    }

    /// The advised number does what was found to do, and is never that of nearly all.
    #[test]
    fn so_many_are_advised_as_tell_it() {
        let few = |pitch: f64, correlation: f64, off: f64| SubsampleEstimate {
            pitch,
            usual_pitch: 0.002,
            pitch_of_all: 1.0 / 6000.0,
            correlation: Some(correlation),
            cvs: vec![cv(0.01, off)],
            ..SubsampleEstimate::default()
        };
        // Far from enough: not twice as many, but what the air asks for.
        assert_eq!(few(0.025, 0.2, 0.0).enough_per_metre(), Some(500.0));
        assert_eq!(few(0.002, 0.6, 0.0).enough_per_metre(), Some(1000.0));
        assert_eq!(few(0.002, 0.9, 0.2).enough_per_metre(), Some(2000.0));
        // More than are simulated without being asked.
        assert_eq!(few(0.0005, 0.6, 0.0).enough_per_metre(), None);
        assert_eq!(few(0.002, 0.9, 0.01).enough_per_metre(), None);
        // Five sixths of all save nothing.
        assert_eq!(
            SubsampleEstimate { pitch_of_all: 1.0 / 1200.0, ..few(0.002, 0.6, 0.0) }.enough_per_metre(),
            None
        );
    }
}
