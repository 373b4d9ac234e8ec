//! The command line as results remember it.

use super::{Arguments, is_standard};
use clap::parser::ValueSource;
use clap::{ArgMatches, CommandFactory};
use spunlaid_results::files::origin::Origin;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Options that do not decide what results are: they say where and how fast they are made, how they are
/// shown, and what is made of them besides.
const NOT_OF_RESULTS: [&str; 11] = [
    "out",
    "threads",
    "quiet",
    "json",
    "force",
    "formats",
    "figure_width",
    "tables",
    "advice",
    "no_advice",
    "sheet",
];
/// With another number of replicates, a study goes on.
const GOES_ON: (&str, &str) = ("sweep", "replicates");

/// The command and its options, which decide whether it may replace results.
#[derive(Debug)]
pub(crate) struct Invocation {
    command: String,
    words: Vec<OsString>,
    /// Each as it is written, `--frames 30`.
    options: Vec<String>,
}

impl Invocation {
    /// The command of a command line and the options that are written there.
    ///
    /// * `words` – the command line itself
    pub(crate) fn new(matches: &ArgMatches, words: &[OsString]) -> Self {
        let (name, matches) = matches.subcommand().unwrap_or(("", matches));
        let (program, words) = (Arguments::command(), words.to_vec());
        let known = program.find_subcommand(name).into_iter().flat_map(clap::Command::get_arguments);
        let written = known.filter(|argument| {
            let id = argument.get_id().as_str();
            !argument.is_positional()
                && !NOT_OF_RESULTS.contains(&id)
                && (name, id) != GOES_ON
                && matches.value_source(id) == Some(ValueSource::CommandLine)
        });
        let option = |argument: &clap::Arg| {
            let id = argument.get_id().as_str();
            let values = matches.get_raw(id).into_iter().flatten().map(|value| value.to_string_lossy());
            format!("--{id} {}", values.collect::<Vec<_>>().join(" "))
        };
        Self { command: name.to_owned(), words, options: written.map(option).collect() }
    }

    /// The command line.
    pub(crate) fn words(&self) -> &[OsString] {
        &self.words
    }

    /// Whether an option is written, `belt-speed`.
    pub(crate) fn has(&self, option: &str) -> bool {
        let begin = format!("--{} ", option.replace('-', "_"));
        self.options.iter().any(|option| option.starts_with(&begin))
    }

    /// The first option of these that is written, `--keep-shading`.
    pub(crate) fn first_option<O: clap::Args>(&self) -> Option<String> {
        let options = O::augment_args(clap::Command::new(""));
        let found = options.get_arguments().find(|option| self.has(option.get_id().as_str()))?;
        Some(format!("--{}", found.get_long()?))
    }

    /// What its results in a folder are made from: the files or folders that it reads. None for standard input, which
    /// may differ each time.
    pub(crate) fn origin_of<'a>(
        &self,
        files: impl IntoIterator<Item = &'a PathBuf>,
        folder: &Path,
    ) -> Option<Origin> {
        let files: Vec<&Path> = files.into_iter().map(PathBuf::as_path).collect();
        let is_known = !files.iter().any(|file| is_standard(file));
        is_known.then(|| Origin::new(&self.command, &files, &self.options, folder))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{RecordOptions, Scan};
    use super::*;

    fn invocation(words: &str) -> Invocation {
        Invocation::new(&Arguments::command().get_matches_from(words.split(' ')), &[])
    }

    #[test]
    fn only_options_that_decide_the_results_count() {
        let bare = invocation("spunlaid air a.toml");
        assert!(bare.command == "air" && bare.options.is_empty(), "{bare:?}");
        let shown = "--out r --threads 2 --quiet --force --figures pdf --figure-width one-column";
        assert_eq!(invocation(&format!("spunlaid air a.toml {shown}")).options, bare.options);
        let other = invocation("spunlaid air a.toml --frames 3 --set run.seed=2 --set run.spin_up=0s");
        assert_eq!(other.options, ["--set run.seed=2 run.spin_up=0s", "--frames 3"]);
        assert_eq!(invocation("spunlaid sweep s.toml --replicates 9 --json").options, [""; 0]);
        assert_eq!(invocation("spunlaid run a.toml --replicates 9 --json").options, ["--replicates 9"]);
        assert_eq!(invocation("spunlaid analyse s.png --keep-shading").options, ["--keep_shading true"]);
    }

    #[test]
    fn the_first_option_of_a_kind_is_found_by_its_name() {
        let written = invocation("spunlaid analyse s.png --noise 3 --out r --keep-shading");
        assert_eq!(written.first_option::<Scan>().as_deref(), Some("--keep-shading"));
        assert_eq!(written.first_option::<RecordOptions>(), None);
    }

    /// Otherwise an option of another name would count.
    #[test]
    fn options_that_do_not_count_exist() {
        let program = Arguments::command();
        let all: Vec<&str> = program
            .get_subcommands()
            .flat_map(|command| command.get_arguments())
            .map(|one| one.get_id().as_str())
            .collect();
        assert!(NOT_OF_RESULTS.iter().all(|name| all.contains(name)), "{all:?}");
    }
}
