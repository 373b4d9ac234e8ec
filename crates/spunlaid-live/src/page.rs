//! The page and its files, which are part of the program.

use super::http::Response;

const HTML: &str = "text/html; charset=utf-8";
const CSS: &str = "text/css; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";

/// Which page is served.
#[derive(Clone, Copy, Debug)]
pub(super) enum Page {
    /// Fibres that fly.
    Fibre,
    /// The web of a line.
    Line,
}

/// Name, kind and text of a file. The page itself has no name.
type PageFile = (&'static str, &'static str, &'static str);

/// How the text of every page begins, in place of `{{ head }}`.
const HEAD: &str = include_str!("../assets/head.html");

/// Files of all pages.
const SHARED: [PageFile; 2] = [
    ("base.css", CSS, include_str!("../assets/base.css")),
    ("link.js", SCRIPT, include_str!("../assets/link.js")),
];

/// Files of the page of a fibre.
const FIBRE: [PageFile; 10] = [
    ("", HTML, include_str!("../assets/live.html")),
    ("live.css", CSS, include_str!("../assets/live.css")),
    ("uPlot.min.css", CSS, include_str!("../assets/uplot/uPlot.min.css")),
    ("uPlot.iife.min.js", SCRIPT, include_str!("../assets/uplot/uPlot.iife.min.js")),
    ("camera.js", SCRIPT, spunlaid_results::reports::run::CAMERA),
    ("scene.js", SCRIPT, spunlaid_results::reports::run::SCENE),
    ("view.js", SCRIPT, include_str!("../assets/view.js")),
    ("plots.js", SCRIPT, include_str!("../assets/plots.js")),
    ("controls.js", SCRIPT, include_str!("../assets/controls.js")),
    ("live.js", SCRIPT, include_str!("../assets/live.js")),
];

/// Files of the page of a line.
const LINE: [PageFile; 5] = [
    ("", HTML, include_str!("../assets/line.html")),
    ("line.css", CSS, include_str!("../assets/line.css")),
    ("belt_live.js", SCRIPT, include_str!("../assets/belt_live.js")),
    ("knobs.js", SCRIPT, include_str!("../assets/knobs.js")),
    ("line.js", SCRIPT, include_str!("../assets/line.js")),
];

impl Page {
    const fn files(self) -> &'static [PageFile] {
        match self {
            Self::Fibre => &FIBRE,
            Self::Line => &LINE,
        }
    }
}

/// What every answer says: nothing is stored, nothing from elsewhere is loaded, no other page may show this one.
pub(super) const HEADERS: [(&str, &str); 5] = [
    ("cache-control", "no-store"),
    ("x-content-type-options", "nosniff"),
    ("referrer-policy", "no-referrer"),
    ("cross-origin-resource-policy", "same-origin"),
    (
        "content-security-policy",
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data: blob:; \
         base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
];

/// The answer with a file.
///
/// * `tabs` – leads to the other pages
pub(super) fn file(page: Page, tabs: &str, name: &str) -> Response {
    match page.files().iter().chain(&SHARED).find(|(other, ..)| *other == name) {
        Some((_, kind, text)) => Response { status: "200 OK", kind, body: whole(text, tabs) },
        None => not_there(),
    }
}

/// The text of a file with what is the same in several. Page and program are of one version.
fn whole(text: &str, tabs: &str) -> String {
    let parts = [("{{ head }}\n", HEAD), ("{{ tabs }}", tabs), ("{{ version }}", env!("CARGO_PKG_VERSION"))];
    parts.iter().fold(text.to_owned(), |text, (name, part)| text.replace(name, part))
}

/// The answer to a request for a file that is not there.
pub(super) fn not_there() -> Response {
    Response::plain("404 Not Found", "There is no such file.\n")
}

/// A page that others lead to.
pub(super) struct Tab {
    pub(super) label: String,
    /// Its address below that of the server: `fibre/`, or nothing.
    pub(super) at: String,
}

impl Tab {
    /// The page at the address of the server.
    pub(super) fn first(label: &str) -> Self {
        Self { label: label.to_owned(), at: String::new() }
    }
}

/// The links of each page to all of them, as HTML, the first page first; nothing where there is one only.
pub(super) fn links(all: &[&Tab]) -> Vec<String> {
    let to = |own: &Tab, Tab { label, at }: &Tab| {
        let up = if own.at.is_empty() { "./" } else { "../" };
        let current = if *at == own.at { " aria-current=\"page\"" } else { "" };
        format!("<a href=\"{up}{at}\"{current}>{label}</a>")
    };
    let (others, first): (Vec<&Tab>, Vec<&Tab>) = all.iter().partition(|tab| !tab.at.is_empty());
    let of_page = |own: &&Tab| {
        let links: Vec<String> = first.iter().chain(&others).map(|tab| to(own, tab)).collect();
        format!("<nav aria-label=\"Pages\">{}</nav>", links.join(" "))
    };
    all.iter().map(|own| if all.len() > 1 { of_page(own) } else { String::new() }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_asks_for_files_that_are_there_and_for_nothing_elsewhere() {
        for page in [Page::Fibre, Page::Line] {
            let html = whole(page.files()[0].2, "");
            assert!(html.starts_with("<!doctype html>") && !html.contains("{{"), "{html}");
            let of_page = || page.files().iter().chain(&SHARED);
            for part in html.split(['"']).filter(|part| part.ends_with(".js") || part.ends_with(".css")) {
                assert!(of_page().any(|(name, ..)| *name == part), "{part}");
            }
            for (name, _, text) in of_page() {
                // uPlot's licence line names its place.
                let foreign = text.match_indices("://").filter(|(at, _)| !text[..*at].ends_with("ws"));
                let allowed = if name.starts_with("uPlot") { 1 } else { 0 };
                assert!(foreign.count() <= allowed, "{name}");
            }
        }
    }
}
