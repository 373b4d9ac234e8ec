//! The paragraph about methods in every report: by what the numbers were made, where the case stands, and what is
//! cited.

use super::document::{Part, Section};
use spunlaid_fibre::Case;
use spunlaid_simulation::WebSpec;

/// A paragraph to copy, and below it the works that it cites, each once, the program first.
///
/// * `command` – that made the results
/// * `cited` – the works on whose models they rest
/// * `input` – where everything stands with which the command gives them again; empty if it made nothing of a case
pub(crate) fn methods(command: &str, cited: Vec<Reference>, input: &str) -> Section<'static> {
    let mut works: Vec<Reference> = Vec::new();
    for work in cited {
        if !works.iter().any(|known| known.full == work.full) {
            works.push(work);
        }
    }
    let models = match &works[..] {
        [] => String::new(),
        works => {
            let names: Vec<&str> = works.iter().map(|work| work.short).collect();
            format!(", by the models of {}", names.join("; "))
        }
    };
    let case = match input {
        "" => String::new(),
        input => format!(" The complete input is {input}."),
    };
    let text = format!("The numbers come from {} (spunlaid {command}){models}.{case}", PROGRAM.short);
    let full = works.iter().map(|work| work.full.to_owned());
    let paragraphs = [text, PROGRAM.full.to_owned()].into_iter().chain(full).collect();
    Section::new("methods-paragraph", "Methods, for a paper")
        .with(Part::Prose { id: "methods-text", paragraphs })
}

/// A work that is cited. A law of the drag names its own.
pub(crate) use spunlaid_fibre::Source as Reference;

/// The program itself.
pub(crate) const PROGRAM: Reference = Reference {
    short: concat!("spunlaid ", env!("CARGO_PKG_VERSION")),
    full: concat!(
        "The spunlaid authors: spunlaid: a simulator of fibres in turbulent air. Version ",
        env!("CARGO_PKG_VERSION"),
        "."
    ),
};

/// The chain of beads in turbulent air.
pub(crate) const CHAIN: Reference = Reference {
    short: "Battocchio, Sutcliffe and Teschner 2015",
    full: "F. Battocchio, M. P. F. Sutcliffe, F. Teschner: Fibre behaviour in the spunbonding process. Part \
        II: Modelling fibre dynamics in turbulent flows. Proc. IMechE Part C: J. Mechanical Engineering \
        Science, 2015.",
};

/// The stochastic model of a laid fibre.
pub(crate) const SURROGATE: Reference = Reference {
    short: "Götz et al. 2007",
    full: "T. Götz, A. Klar, N. Marheineke, R. Wegener: A stochastic model and associated Fokker–Planck \
        equation for the fiber lay-down process in nonwoven production processes. SIAM Journal on Applied \
        Mathematics 67(6), 1704–1717, 2007.",
};

/// The way in which a fit finds values and intervals.
pub(crate) const MOMENTS: Reference = Reference {
    short: "McFadden 1989",
    full: "D. McFadden: A method of simulated moments for estimation of discrete response models without \
        numerical integration. Econometrica 57(5), 995–1026, 1989.",
};

/// What a simulated case rests on: the chain, and the laws of the drag.
pub(crate) fn of_case(case: &Case) -> Vec<Reference> {
    match case.air.density > 0.0 {
        true => vec![CHAIN, case.drag.along.source(), case.drag.across.source()],
        false => vec![CHAIN],
    }
}

/// What a web rests on: the surrogate where it lays the fibres, and the cases that fly.
pub(crate) fn of_web(spec: &WebSpec) -> Vec<Reference> {
    let surrogate = (!spec.flies()).then_some(SURROGATE);
    let cases = spec.cases().flat_map(of_case);
    surrogate.into_iter().chain(cases).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use spunlaid_fibre::{FrictionLaw, NormalLaw};

    fn file(name: &str) -> String {
        std::fs::read_to_string(format!("{}/../../{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
    }

    #[test]
    fn the_sources_of_models_are_those_of_the_theory() {
        let theory = file("docs/theory.md").replace('*', "").split_whitespace().collect::<Vec<_>>().join(" ");
        let laws = FrictionLaw::ALL
            .map(FrictionLaw::source)
            .into_iter()
            .chain(NormalLaw::ALL.map(NormalLaw::source));
        for reference in laws.chain([CHAIN, SURROGATE, MOMENTS]) {
            let known = reference.full.trim_end_matches(", 2015.").trim_end_matches('.');
            assert!(theory.contains(known), "{known}");
        }
    }

    #[test]
    fn program_and_paper_are_cited_as_citation_cff_asks_for() {
        let asked = file("CITATION.cff");
        let title = |start: &str| {
            let line = asked
                .lines()
                .map(|line| line.trim_start_matches([' ', '-']))
                .find(|line| line.starts_with(start));
            line.unwrap().split_once(": ").unwrap().1.trim_matches('"').to_owned()
        };
        assert!(PROGRAM.full.contains(&title("title: \"spunlaid")), "{}", PROGRAM.full);
        assert!(PROGRAM.full.contains(&title("name: ")) && PROGRAM.full.contains(&title("version: ")));
        assert!(CHAIN.full.contains(&title("title: \"Fibre behaviour")), "{}", CHAIN.full);
        for part in
            ["family-names: Battocchio", "family-names: Sutcliffe", "family-names: Teschner", "year: 2015"]
        {
            let name = part.split_once(": ").unwrap().1;
            assert!(asked.contains(part) && CHAIN.full.contains(name), "{part}");
        }
    }
}
