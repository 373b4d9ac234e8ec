//! The files that a case names.

use super::{Case, Run};
use crate::body::Fibre;
use crate::drag::{Drag, FrictionLaw, NormalLaw};
use crate::spinline::{PolymerSource, SpinSpec, Spinline, Surroundings};
use spunlaid_air::{Air, FileContent};
use std::path::{Path, PathBuf};

impl Case {
    /// The files that the case was read from, each with the parts that it names, relative to its folder.
    pub fn files(&self) -> Vec<(&Path, &[PathBuf])> {
        let of_spinline = self.spinline.iter().flat_map(|spinline| spinline.files());
        self.air.files().into_iter().chain(of_spinline).chain(self.drag.files()).collect()
    }

    /// The same case with its files at other paths.
    pub fn with_files_at(&self, place: impl Fn(&Path) -> PathBuf) -> Self {
        let spinline = self.spinline.as_ref().map(|spinline| Box::new(spinline.with_files_at(&place)));
        let drag = self.drag.with_files_at(&place);
        Self { air: self.air.with_files_at(place), spinline, drag, ..self.clone() }
    }
}

impl SpinSpec {
    /// The files that it was read from, each with the parts that it names, relative to its folder.
    pub fn files(&self) -> Vec<(&Path, &[PathBuf])> {
        let of_air = self.air.iter().flat_map(|air| air.files());
        of_air.chain(self.spinline.files()).chain(self.drag.files()).collect()
    }

    /// The same spinline with its files at other paths.
    pub fn with_files_at(&self, place: impl Fn(&Path) -> PathBuf) -> Self {
        let air = self.air.as_ref().map(|air| Box::new(air.with_files_at(&place)));
        Self { spinline: self.spinline.with_files_at(&place), drag: self.drag.with_files_at(&place), air }
    }
}

impl Drag {
    /// The files of its laws, which name no parts.
    fn files(&self) -> Vec<(&Path, &[PathBuf])> {
        let laws = self.tables().into_iter().flatten();
        laws.map(|law| (law.file().path(), law.file().parts())).collect()
    }

    /// The same laws with their files at other paths.
    fn with_files_at(&self, place: impl Fn(&Path) -> PathBuf) -> Self {
        let mut moved = *self;
        if let FrictionLaw::Table(law) = &mut moved.along {
            *law = law.at(&place);
        }
        if let NormalLaw::Table(law) = &mut moved.across {
            *law = law.at(&place);
        }
        moved
    }
}

impl Spinline {
    /// The files that it was read from, each with the parts that it names: none.
    pub(crate) fn files(&self) -> Vec<(&Path, &[PathBuf])> {
        let mut files = Vec::new();
        if let PolymerSource::File(file) = &self.polymer {
            files.push((file.path(), file.parts()));
        }
        if let Surroundings::Table(table) = &self.air {
            files.push((table.path(), table.parts()));
        }
        files
    }

    /// The same spinline with its files at other paths.
    pub(crate) fn with_files_at(&self, place: impl Fn(&Path) -> PathBuf) -> Self {
        fn moved<T>(file: &mut FileContent<T>, place: impl Fn(&Path) -> PathBuf) {
            *file = file.moved_to(place(file.path()));
        }
        let mut spinline = self.clone();
        if let PolymerSource::File(file) = &mut spinline.polymer {
            moved(file, &place);
        }
        if let Surroundings::Table(table) = &mut spinline.air {
            moved(table, &place);
        }
        spinline
    }
}

impl From<&SpinSpec> for Case {
    /// A case with nothing but a spinline, its drag laws and its field of air, whose keys can be read and set.
    fn from(spec: &SpinSpec) -> Self {
        let unset = Self::unset();
        let air = spec.air.as_ref().map_or_else(|| unset.air.clone(), |air| (**air).clone());
        Self { spinline: Some(Box::new(spec.spinline.clone())), drag: spec.drag, air, ..unset }
    }
}

impl Case {
    /// A case of which nothing is known yet; its keys are set one after another.
    pub fn unset() -> Self {
        let nan = f64::NAN;
        Self {
            fibre: Fibre::UNKNOWN,
            air: Air::uniform(nan, nan, nan, nan),
            drag: Drag { along: FrictionLaw::ALL[0], across: NormalLaw::ALL[0] },
            line: None,
            spinline: None,
            run: Run::UNKNOWN,
        }
    }
}
