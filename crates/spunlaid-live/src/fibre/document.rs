//! The case as text: keys are changed in it, comments stay, and it is saved.

use crate::message::{PageDiagnostic, diagnostic, diagnostics};
use spunlaid::fibre::Case;
use spunlaid::fibre::case::keys::{self, Key, Kind};
use spunlaid::ground::{Diagnostic, Dimension, Error};
use spunlaid::input::{CaseWithNotes, LARGEST_FILE, Overrides, Resources, read_case, write_case};
use spunlaid_results::command::{beside_of, quoted};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use toml_edit::{DocumentMut, Item, TableLike, Value, value};

/// Most memory of a flight [bytes]. A larger one would answer too slowly.
const MOST_MEMORY: f64 = 256e6;

/// A case as text, and where it came from.
#[derive(Clone, Debug)]
pub(crate) struct Document {
    text: String,
    /// The file as it is on disk, and its text there; none if the program itself had the case.
    file: Option<(PathBuf, String)>,
    /// What messages call it, and from where the paths in it are read.
    name: PathBuf,
    /// The files that the case named when the program was started. No page can make it name others.
    files: BTreeSet<String>,
}

/// A case that has been read, with warnings about it.
pub(super) struct LoadedCase {
    pub(super) case: Case,
    pub(super) warnings: Vec<String>,
}

impl Document {
    /// * `file` – the file that the text was read from
    pub(crate) fn new(text: String, file: Option<PathBuf>) -> Self {
        let files = text.parse().map_or_else(|_| BTreeSet::new(), files_of);
        let name = file.clone().unwrap_or_else(|| PathBuf::from("live.toml"));
        Self { file: file.map(|path| (path, text.clone())), text, name, files }
    }

    /// The filament of a line, which no file has, under a name.
    pub(crate) fn of_filament(case: &Case, name: PathBuf) -> Self {
        let document = Self { name, ..Self::new(write_case(case), None) };
        // The page of the line has found the tension.
        document.with_tension_of_flights(case).unwrap_or(document)
    }

    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// The name of the case, for headings.
    pub(super) fn title(&self) -> String {
        self.name.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    }

    /// Reads the case.
    ///
    /// # Errors
    /// What is wrong with it, by line.
    pub(super) fn read(&self) -> Result<LoadedCase, Vec<PageDiagnostic>> {
        if self.text.len() as u64 > LARGEST_FILE {
            return Err(diagnostic("the case is larger than a case file may be"));
        }
        if let Ok(document) = self.text.parse::<DocumentMut>()
            && let Some(other) = files_of(document).difference(&self.files).next()
        {
            let text = format!(
                "\"{other}\": a page can use only the files of the case with which the program was started; start \
                 `spunlaid live` with a case that names this file"
            );
            return Err(diagnostic(text));
        }
        let (case, notes) = self.case(&Resources::default()).map_err(|error| diagnostics(&error))?;
        let memory = case.flight_memory();
        let memory = memory.chain + memory.turbulence + memory.synthesis;
        if memory > MOST_MEMORY {
            return Err(diagnostic(format!(
                "eight fibres of this case take {:.0} MB of memory, and a page can use {:.0} MB; give longer \
                 elements, longer eddies or fewer harmonics",
                memory * 1e-6,
                MOST_MEMORY * 1e-6
            )));
        }
        let warnings = notes.iter().filter(|note| note.is_warning()).map(Diagnostic::without_place);
        Ok(LoadedCase { case, warnings: warnings.collect() })
    }

    /// The case, and what is said of it.
    pub(super) fn case(&self, resources: &Resources) -> Result<CaseWithNotes, Error> {
        read_case((&self.text, &self.name.to_string_lossy()), Overrides::from(&[]).with(resources))
    }

    /// Whether the text gives a value for a key of a table.
    pub(super) fn gives(&self, table: &str, key: &str) -> bool {
        let document = self.text.parse::<DocumentMut>();
        document.is_ok_and(|document| table_of(&document, table).is_some_and(|table| table.contains_key(key)))
    }

    /// The same document with another text.
    pub(super) fn with_text(&self, text: String) -> Self {
        Self { text, ..self.clone() }
    }

    /// The same document with another value of a key; with none, the default applies.
    ///
    /// # Errors
    /// The text is not TOML.
    pub(super) fn with(&self, key: &Key, to: Option<Value>) -> Result<Self, Vec<PageDiagnostic>> {
        // Where the text is not TOML, reading it says why, in the words of all commands.
        let invalid =
            |error: toml_edit::TomlError| diagnostic(format!("not valid TOML: {}", error.message()));
        let parsed = self.text.parse::<DocumentMut>();
        let mut document = parsed.map_err(|error| self.read().err().unwrap_or_else(|| invalid(error)))?;
        let mut table: &mut dyn TableLike = document.as_table_mut();
        for name in key.table().split('.') {
            let inner = table.entry(name).or_insert(toml_edit::table());
            let not_a_table = || diagnostic(format!("{} is not a table", key.table()));
            table = inner.as_table_like_mut().ok_or_else(not_a_table)?;
        }
        match (to, table.get_mut(key.short()).and_then(Item::as_value_mut)) {
            (Some(new), Some(old)) => {
                // The comment at the end of the line stays.
                let around = old.decor().clone();
                *old = new;
                *old.decor_mut() = around;
            }
            (Some(new), None) => drop(table.insert(key.short(), value(new))),
            (None, _) => drop(table.remove(key.short())),
        }
        Ok(self.with_text(document.to_string()))
    }

    /// The document with the tension at the end of the spinline that flights have found in place of `simulated`,
    /// so that a change of a key need not wait for flights; `None` if it says nothing of flights.
    ///
    /// * `case` – as it was read from this document
    pub(super) fn with_tension_of_flights(&self, case: &Case) -> Option<Self> {
        let key = keys::find("spinline.end_tension")?;
        let document = self.text.parse::<DocumentMut>().ok()?;
        let written = table_of(&document, key.table())?.get(key.short())?.as_str()?;
        let tension = key.get(case)?.number()?;
        (written.trim() == "simulated")
            .then(|| self.with(key, Some(Dimension::Force.exact(tension).into())).ok())?
    }

    /// The command that does the same run.
    pub(super) fn command(&self, replicates: usize) -> String {
        let Some((path, original)) = &self.file else {
            return "save the case first; this command then runs it".to_owned();
        };
        let changed = differences(original, &self.text);
        let set: String = changed
            .iter()
            .map(|(key, value)| format!(" --set {}", quoted(&format!("{key}={value}"))))
            .collect();
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let settings = changed.iter().map(|(key, value)| (&**key, &**value));
        let out = beside_of(&format!("results/{stem}-live{replicates}"), settings);
        let file = quoted(&path.to_string_lossy());
        format!("spunlaid run {file}{set} --replicates {replicates} --out {}", quoted(&out))
    }

    /// The text for a file in the present folder: the paths in it are read from there.
    pub(super) fn to_save(&self) -> String {
        let folder = self.name.parent().unwrap_or(Path::new(""));
        let Ok(mut document) = self.text.parse::<DocumentMut>() else {
            return self.text.clone();
        };
        if folder == Path::new("") {
            return self.text.clone();
        }
        for_each_file(&mut document, &mut |text| {
            let path = folder.join(text.value());
            *text = toml_edit::Formatted::new(path.to_string_lossy().into_owned());
        });
        document.to_string()
    }

    /// The document after it has been saved under a name in the present folder.
    pub(super) fn saved(name: &str, text: String) -> Self {
        Self::new(text, Some(PathBuf::from(name)))
    }
}

/// A table of the document, `spinline.material` within `spinline`.
fn table_of<'d>(document: &'d DocumentMut, name: &str) -> Option<&'d dyn TableLike> {
    let top: &dyn TableLike = document.as_table();
    name.split('.').try_fold(top, |table, name| table.get(name)?.as_table_like())
}

/// The texts of a value or of the list that it is.
fn for_each_text(value: &mut Value, act: &mut impl FnMut(&mut toml_edit::Formatted<String>)) {
    match value {
        Value::String(text) => act(text),
        Value::Array(all) => all.iter_mut().for_each(|one| for_each_text(one, act)),
        _ => {}
    }
}

/// The texts of a document that name files.
fn for_each_file(document: &mut DocumentMut, act: &mut impl FnMut(&mut toml_edit::Formatted<String>)) {
    for key in keys::all().iter().filter(|key| matches!(key.kind, Kind::File(_))) {
        let top: &mut dyn TableLike = document.as_table_mut();
        let table =
            key.table().split('.').try_fold(top, |table, name| table.get_mut(name)?.as_table_like_mut());
        if let Some(found) = table.and_then(|table| table.get_mut(key.short())).and_then(Item::as_value_mut) {
            for_each_text(found, &mut |text| {
                if !key.kind.words().contains(&text.value().as_str()) {
                    act(text);
                }
            });
        }
    }
}

/// The files that a case names.
fn files_of(mut document: DocumentMut) -> BTreeSet<String> {
    let mut files = BTreeSet::new();
    for_each_file(&mut document, &mut |text| files.extend([text.value().clone()]));
    files
}

/// Keys whose values differ between two cases, with the new value as an option takes it; `auto` for one that is gone.
fn differences(old: &str, new: &str) -> Vec<(&'static str, String)> {
    let (Ok(old), Ok(new)) = (old.parse::<DocumentMut>(), new.parse::<DocumentMut>()) else {
        return Vec::new();
    };
    let written = |document: &DocumentMut, key: &Key| {
        let table = table_of(document, key.table())?;
        let mut found = table.get(key.short())?.as_value()?.clone();
        found.decor_mut().clear();
        Some(found.as_str().map_or_else(|| found.to_string(), str::to_owned))
    };
    let differs = |key: &'static Key| match (written(&old, key), written(&new, key)) {
        (old, Some(new)) => (old.as_ref() != Some(&new)).then_some((key.name, new)),
        (Some(_), None) => Some((key.name, "auto".to_owned())),
        (None, None) => None,
    };
    keys::all().iter().filter_map(differs).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = "# a case\n[fibre]\nlength = \"1 m\"\ndiameter = \"50 µm\" # fine\n\
        density = \"950 kg/m³\"\nyoungs_modulus = \"2 GPa\"\n\n[air]\nvelocity = \"10 m/s\"\n\
        turbulence_intensity = 0.1\nlength_scale = \"50 mm\"\ncutoff_frequency = \"100 Hz\"\n\n[run]\n\
        duration = \"1 s\"\n";

    fn document() -> Document {
        Document::new(CASE.to_owned(), Some(PathBuf::from("some where/a.toml")))
    }

    fn key(name: &str) -> &'static Key {
        keys::find(name).unwrap()
    }

    #[test]
    fn a_key_changes_in_its_line_and_comments_stay() {
        let new = document().with(key("fibre.diameter"), Some("20 µm".into())).unwrap();
        assert_eq!(new.text(), CASE.replace("50 µm", "20 µm"));
        let new = new.with(key("run.seed"), Some(7.into())).unwrap();
        assert!(new.text().ends_with("duration = \"1 s\"\nseed = 7\n"), "{}", new.text());
        assert_eq!(new.read().ok().unwrap().case.run.seed, 7);
        let back = new.with(key("run.seed"), None).unwrap().with(key("fibre.diameter"), Some("50 µm".into()));
        assert_eq!(back.unwrap().text(), CASE);
    }

    #[test]
    fn the_command_names_what_differs_from_the_file() {
        assert_eq!(
            document().command(8),
            "spunlaid run 'some where/a.toml' --replicates 8 --out results/a-live8"
        );
        let new = document().with(key("fibre.diameter"), Some("20 µm".into())).unwrap();
        let new = new.with(key("air.turbulence_intensity"), Some(0.2.into())).unwrap();
        let new = new.with(key("run.duration"), None).unwrap();
        let command = new.command(8);
        let (settings, folder) = command.split_once(" --out ").unwrap();
        assert_eq!(
            settings,
            "spunlaid run 'some where/a.toml' --set 'fibre.diameter=20 µm' --set air.turbulence_intensity=0.2 \
             --set run.duration=auto --replicates 8"
        );
        // A long name is cut, and still that of these settings alone.
        assert!(folder.starts_with("results/a-live8-diameter-20um-turbulence-intensity-0.2-"), "{folder}");
        let other = new.with(key("run.duration"), Some("2 s".into())).unwrap().command(8);
        assert_ne!(other.split_once(" --out ").unwrap().1, folder);
        let saved = Document::saved("b.toml", new.to_save());
        assert_eq!(saved.command(8), "spunlaid run b.toml --replicates 8 --out results/b-live8");
        assert!(Document::new(CASE.to_owned(), None).command(8).starts_with("save the case first"));
    }

    #[test]
    fn keys_of_a_table_within_a_table_are_changed_and_named_in_the_command() {
        const LINE: &str = "[spinline]\npolymer = \"pp\"\nprofile = \"air.csv\"\n[spinline.material]\n\
            viscosity = \"200 Pa s\" # mine\n";
        let document = Document::new(LINE.to_owned(), Some(PathBuf::from("cases/x.toml")));
        let new = document.with(key("spinline.material.viscosity"), Some("180 Pa s".into())).unwrap();
        let new = new.with(key("spinline.material.mobility"), Some(0.3.into())).unwrap();
        assert!(new.text().contains("viscosity = \"180 Pa s\" # mine\nmobility = 0.3\n"), "{}", new.text());
        assert!(
            new.gives("spinline.material", "mobility") && !document.gives("spinline.material", "mobility")
        );
        let command = new.command(8);
        assert!(
            command.contains(
                "--set 'spinline.material.viscosity=180 Pa s' --set spinline.material.mobility=0.3"
            ),
            "{command}"
        );
        assert!(document.to_save().contains("profile = \"cases/air.csv\""), "{}", document.to_save());
        let other = document.with_text(LINE.replace("\"pp\"", "\"../secret.toml\""));
        assert!(other.read().is_err_and(|problems| problems[0].text.contains("can use only the files")));
    }

    #[test]
    fn rejects_by_line() {
        let Err(wrong) = document().with_text(CASE.replace("50 mm", "50 mms")).read() else {
            panic!("it is read");
        };
        assert_eq!((wrong.len(), wrong[0].line), (1, Some(11)));
        assert!(wrong[0].text.starts_with("air.length_scale = \"50 mms\" "), "{}", wrong[0].text);
        let Err(wrong) = document().with_text("[fibre\n".to_owned()).read() else {
            panic!("it is read");
        };
        assert_eq!(wrong[0].line, Some(1));
    }

    #[test]
    fn rejects_what_is_too_large_for_a_page() {
        let Err(wrong) = document().with_text(CASE.replace("50 mm", "0.1 mm")).read() else {
            panic!("it is read");
        };
        assert!(wrong[0].text.contains(" MB of memory, and a page can use 256 MB"), "{}", wrong[0].text);
    }

    #[test]
    fn rejects_files_that_the_case_did_not_name() {
        for (line, file) in [
            ("velocity = \"10 m/s\"", "profile = '/etc/passwd'"),
            ("velocity = \"10 m/s\"", "record = ['probe.csv', '/etc/passwd']"),
            ("turbulence_intensity = 0.1", "spectrum = '../../etc/passwd'"),
        ] {
            let Err(wrong) = document().with_text(CASE.replace(line, file)).read() else {
                panic!("{file} is read");
            };
            assert!(wrong[0].text.contains("can use only the files"), "{}", wrong[0].text);
        }
        // Written another way.
        let inline = CASE.replace("[air]\n", "[air]\n\"field\" = \"\"\"/etc/passwd\"\"\"\n");
        assert!(document().with_text(inline).read().is_err_and(|e| e[0].text.contains("can use only")));
        let word = CASE.replace("length_scale", "spectrum = 'von-karman'\nlength_scale");
        assert!(document().with_text(word).read().is_ok());
    }

    #[test]
    fn saved_paths_are_read_from_the_present_folder() {
        let text = "[air]\nrecord = [\"a.csv\", \"b/c.csv\"]\nspectrum = \"von-karman\"\n";
        let document = Document::new(text.to_owned(), Some(PathBuf::from("cases/x.toml")));
        let expected = "[air]\nrecord = [\"cases/a.csv\", \"cases/b/c.csv\"]\nspectrum = \"von-karman\"\n";
        assert_eq!(document.to_save(), expected);
    }
}
