//! The keys of a study file: a row for each. A key named `*` stands for any name in its table: of keys of
//! what varies, or of results.

use super::{Design, Spacing, Study};
use spunlaid_fibre::case::keys::row::{choose, key};
use spunlaid_fibre::case::keys::{Key, KeyTable, Kind, Sign, Value};
use spunlaid_ground::Dimension;

/// Largest number of points of a study, and of values of a range.
pub const MOST_POINTS: u64 = 10_000_000;
/// Largest number of replicates of a point.
pub const MOST_REPLICATES: u64 = 1_000_000;
/// The table of a range of values, which stands in place of a list.
pub const RANGE: &str = "range";

/// The keys of a study.
pub static STUDY: KeyTable<Study> = KeyTable {
    rows: KEYS,
    tables: &["set", "vary", "link", "replicates", "replicates.until", "claims"],
    lists: &[],
    noun: "a study",
    file: "a study file",
};

const ONE_BASE: &str = "a study varies a case, a web or a spinline, so keep one of them";

/// In the order of the file.
const KEYS: &[Key<Study>] = &[
    key("case", Kind::Text("table1.toml"))
        .reported(|study: &Study| base(study, "case.toml"))
        .required("\"table1.toml\"")
        .meaning(
            "The file of the case to vary, relative to the study. Keys that are neither varied nor linked \
             keep its values.",
        ),
    key("web", Kind::Text("web.toml"))
        .reported(|study: &Study| base(study, "web.toml"))
        .alternative_to(&["case"], ONE_BASE)
        .follows("a case varies")
        .meaning("The file of a web to vary, instead of a case."),
    key("spinline", Kind::Text("spinline.toml"))
        .reported(|study: &Study| base(study, "spinline.toml"))
        .alternative_to(&["case", "web"], ONE_BASE)
        .follows("a case varies")
        .meaning("The file of a spinline to vary alone, instead of a case."),
    choose("design", || Design::all(1).map(Design::name).to_vec())
        .reported(|study: &Study| Some(study.design.name().into()))
        .fixed()
        .required("\"grid\"")
        .meaning(
            "How the values are combined: every combination; one key at a time around the base; first \
             values of all lists, then second ones; or points drawn at random in slices of the ranges.",
        ),
    key("points", Kind::Whole(1, MOST_POINTS))
        .reported(|study: &Study| match study.design {
            Design::LatinHypercube(points) => Some(points.into()),
            _ => None,
        })
        .follows("that of the values; required for `latin-hypercube`, like `64`")
        .meaning("Number of points that `latin-hypercube` draws."),
    key("seed", Kind::Whole(0, u64::MAX))
        .reported(|study: &Study| Some(study.seed.into()))
        .follows("that of the case or web")
        .meaning("Master seed of the random phases, and of a Latin hypercube."),
    key("common_phases", Kind::Switch)
        .reported(|study: &Study| Some(study.common_phases.to_string().into()))
        .value("true")
        .meaning("Whether all points have turbulence of the same random phases."),
    key("replicates", Kind::Whole(1, MOST_REPLICATES))
        .reported(|study: &Study| study.replicates.until.is_empty().then(|| study.replicates.at_most.into()))
        .follows("that of the case; one web")
        .meaning("Fibres or webs at each point; or, as a table, until their results are as exact as asked."),
    key("set.*", Kind::Other("a value of that key, or \"auto\""))
        .reported(|_: &Study| None)
        .follows("every key has the value of the case or web")
        .meaning("A key with the same value at all points. `auto` takes the key out."),
    key("vary.*", Kind::Other("a list of values, or { from, to, steps }; a formula belongs in [link]"))
        .reported(|_: &Study| None)
        .required("\"air.velocity\" = [\"5 m/s\", \"10 m/s\"]")
        .meaning("A key that varies: any that its page does not mark as *fixed*."),
    key("link.*", Kind::Text("air.velocity / (4 * air.length_scale)"))
        .reported(|_: &Study| None)
        .follows("none is linked")
        .meaning("A key that follows from others by a formula."),
    key("claims.*", Kind::Text("amplitude_y: air.velocity > 5 * fibre.density"))
        .reported(|_: &Study| None)
        .follows("nothing is judged")
        .meaning(
            "A claim in a sentence, and how it is judged: `RESULT: KEY > 5 * OTHER KEY` compares the \
             effects of two keys over their ranges; `RESULT: KEY rises`, `falls` or `turns` states how \
             the result follows a key, the others as at the first point.",
        ),
    key("replicates.at_least", Kind::Whole(2, MOST_REPLICATES))
        .reported(|study: &Study| {
            (!study.replicates.until.is_empty()).then(|| study.replicates.at_least.into())
        })
        .follows("8, or `at_most` if that is less")
        .meaning("Replicates that every point gets."),
    key("replicates.at_most", Kind::Whole(2, MOST_REPLICATES))
        .reported(|study: &Study| {
            (!study.replicates.until.is_empty()).then(|| study.replicates.at_most.into())
        })
        .value("100")
        .meaning("Most replicates of a point."),
    key("replicates.until.*", Kind::Quantity(Dimension::Ratio, Sign::Positive))
        .reported(|_: &Study| None)
        .follows("required next to `at_least` and `at_most`, like `amplitude_y = \"5 %\"`")
        .meaning(
            "A result, as its column is called, and the standard error, as a fraction of its mean, \
             below which a point gets no more replicates.",
        ),
    key("range.from", Kind::Other("a value of the key"))
        .reported(|_: &Study| None)
        .required("\"5 m/s\"")
        .meaning("The first value of a range, `{ from = \"5 m/s\", to = \"30 m/s\", steps = 6 }`."),
    key("range.to", Kind::Other("a value of the key"))
        .reported(|_: &Study| None)
        .required("\"30 m/s\"")
        .meaning("The last value of a range."),
    key("range.steps", Kind::Whole(2, MOST_POINTS))
        .reported(|_: &Study| None)
        .follows("the design draws the values; required for the others, like `5`")
        .meaning("Number of values, both ends included."),
    choose("range.spacing", || [Spacing::Linear, Spacing::Logarithmic].map(Spacing::name).to_vec())
        .reported(|_: &Study| None)
        .fixed()
        .value("linear")
        .meaning("Equal differences between the values, or equal ratios."),
];

impl Study {
    /// The file of what its points vary, in the folder of its results.
    pub fn base_file(&self) -> &'static str {
        match self.noun() {
            "web" => "web.toml",
            "spinline" => "spinline.toml",
            _ => "case.toml",
        }
    }
}

/// The file of what varies, if it is this one.
fn base(study: &Study, file: &str) -> Option<Value> {
    (study.base_file() == file).then(|| file.into())
}
