"""Lays the pages of the site out in a folder, from the Markdown of the repository, for MkDocs to build.

    python pages.py NPM WORK

* NPM: the folder with the npm packages `katex` and `iframe-worker`
* WORK: gets `mkdocs.yml` and `pages`

What differs from the Markdown as it stands: the long pages are cut into their sections, equations are drawn, links to files that are no
pages lead to copies of them, and a mention of an equation of the theory leads there. A link that leads nowhere ends it.
"""

from __future__ import annotations

import ast
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

from pymdownx.slugs import slugify

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent

# The pages in their order: name on the site, and the file if it is another one than that of the same name in docs.
ORDER: dict[str, list[str]] = {
    "": ["index", "first_hour", "gallery"],
    "Guides": ["tour", "line", "web", "fabric", "fit", "laydown", "spinline", "air", "analyse", "studies", "live", "python", "cluster"],
    "Reference": ["results", "measures", "keys", "web_keys", "study_keys", "api", "glossary"],
    "Theory": ["theory"],
    "Validation": ["validation", "performance"],
    "Project": ["contributing", "changelog", "security"],
}
FILES = {"index": "README.md", "contributing": "CONTRIBUTING.md", "changelog": "CHANGELOG.md", "security": "SECURITY.md"}
# Pages that are cut at their headings of the second level.
CUT = ("theory", "validation")
# Made here, or by the gallery.
MADE = ("api", "gallery")

API = """# The library in Rust and Python

- [The library in Rust](rust/spunlaid/index.html), crate `spunlaid`: cases, flights, ensembles, webs, fits.
- [Fields of air in Rust](rust/spunlaid_field/index.html), crate `spunlaid-field`: files of CFD, and the air at any place.
- [Charts in Rust](rust/spunlaid_charts/index.html), crate `spunlaid-charts`.
- [The package in Python](python.md), by examples; its functions and classes follow.

"""

SLUG = slugify(case="lower")
HEADING = re.compile(r"^(#{1,6}) +(.*?) *$")
LINK = re.compile(r"(\]\()([^)\s]+)(\))")
CODE = re.compile(r"(^```.*?^```|^ {4}.*?$|`[^`\n]*`)", re.MULTILINE | re.DOTALL)
EQUATION = re.compile(r"^\$\$\n(.*?)\n\$\$$", re.MULTILINE | re.DOTALL)


def outside_of_code(text: str, change: object) -> str:
    """The text with its parts changed that are no code."""
    parts = CODE.split(text)
    return "".join(part if number % 2 else change(part) for number, part in enumerate(parts))  # type: ignore[operator]


def anchors(text: str) -> list[str]:
    """The anchors of the headings of a page, as the builder makes them."""
    found: list[str] = []
    is_code = False
    for line in text.splitlines():
        is_code ^= line.startswith("```")
        if not is_code and (heading := HEADING.match(line)):
            words = re.sub(r"[*`]|\]\([^)]*\)|\[", "", heading[2])
            slug = SLUG(words, "-")
            # The second of the same words has a number behind it.
            same = sum(re.fullmatch(re.escape(slug) + r"(_\d+)?", other) is not None for other in found)
            found.append(f"{slug}_{same}" if same else slug)
    return found


def sections(name: str, text: str) -> dict[str, str]:
    """The pages into which a long one is cut."""
    parts: list[list[str]] = [[]]
    is_code = False
    for line in text.splitlines():
        is_code ^= line.startswith("```")
        if line.startswith("## ") and not is_code:
            parts.append([])
        parts[-1].append(line)
    pages = {}
    for part in parts[1:]:
        slug = SLUG(part[0][3:], "-").replace("-", "_")
        raised = [line[1:] if re.match(r"##+ ", line) else line for line in part]
        pages[f"{name}_{slug}"] = "\n".join(raised) + "\n"
    listed = [f"- [{text[2:].splitlines()[0]}]({page}.md)" for page, text in pages.items()]
    return {name: "\n".join([*parts[0], "", "## Sections", "", *listed, ""]), **pages}


def target(link: str, file: Path, sites: dict[Path, str], homes: dict[tuple[Path, str], str], pages: Path) -> str:
    """Where a link of a file leads on the site."""
    path, _, anchor = link.partition("#")
    to = (file.parent / path).resolve() if path else file
    if to in sites:
        home = homes.get((to, anchor), sites[to]) if anchor else sites[to]
        if anchor and (to, anchor) not in homes:
            raise SystemExit(f"error: {file.relative_to(ROOT)}: {link} names no heading of {to.relative_to(ROOT)}")
        return f"{home}.md" + (f"#{anchor}" if anchor else "")
    if not to.exists() or not to.is_relative_to(ROOT):
        raise SystemExit(f"error: {file.relative_to(ROOT)}: {link} is not there")
    if to.is_dir():
        raise SystemExit(f"error: {file.relative_to(ROOT)}: {link} is a folder; link to a file")
    place = to.relative_to(ROOT / "docs") if to.is_relative_to(ROOT / "docs") else Path("files") / to.relative_to(ROOT)
    # As text, which a browser shows.
    if place.suffix not in (".png", ".svg", ".webp", ".html"):
        place = place.with_name(place.name + ".txt")
    (pages / place).parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(to, pages / place)
    return place.as_posix()


def draw(texts: dict[str, str], npm: Path) -> dict[str, str]:
    """The pages with their equations drawn; each that is numbered has an anchor."""
    latex = [equation for text in texts.values() for equation in EQUATION.findall(text)]
    command = ["node", str(HERE / "maths.mjs"), str(npm)]
    done = subprocess.run(command, input=json.dumps(latex), capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"error: an equation cannot be drawn: {done.stderr}")
    drawn = iter(json.loads(done.stdout))

    def html(equation: re.Match[str]) -> str:
        number = re.search(r"\\tag\{(\d+)\}", equation[1])
        return f'<div class="equation"{f" id=eq-{number[1]}" if number else ""}>{next(drawn)}</div>'

    return {name: EQUATION.sub(html, text) for name, text in texts.items()}


def public() -> list[str]:
    """What the Python package offers; functions first."""
    source = (ROOT / "crates/spunlaid-python/python/spunlaid/__init__.py").read_text("utf-8")
    names = next(
        ast.literal_eval(node.value)
        for node in ast.parse(source).body
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__"
    )
    return sorted((name for name in names if not name.startswith("_")), key=lambda name: (name[0].isupper(), name))


def main() -> None:
    npm, work = (Path(word).resolve() for word in sys.argv[1:])
    pages = work / "pages"
    (pages / "assets").mkdir(parents=True, exist_ok=True)
    shutil.copyfile(HERE / "site.css", pages / "assets/site.css")
    katex = npm / "node_modules/katex/dist"
    shutil.copytree(katex / "fonts", pages / "assets/katex/fonts", ignore=shutil.ignore_patterns("*.ttf", "*.woff"))
    shutil.copyfile(katex / "katex.min.css", pages / "assets/katex/katex.min.css")
    (pages / "assets/iframe-worker").mkdir()
    shutil.copyfile(npm / "node_modules/iframe-worker/shim/index.js", pages / "assets/iframe-worker/shim.js")

    texts: dict[str, str] = {}
    files: dict[str, Path] = {}
    nav: list[object] = []
    for group, names in ORDER.items():
        entries: list[object] = []
        for name in names:
            if name in MADE:
                entries.append(f"{name}.md")
                continue
            file = ROOT / FILES.get(name, f"docs/{name}.md")
            text = file.read_text("utf-8")
            made = sections(name, text) if name in CUT else {name: text}
            texts.update(made)
            files.update(dict.fromkeys(made, file))
            entries += [f"{page}.md" for page in made]
        nav += [{group: entries}] if group else entries
    forgotten = {path.stem for path in (ROOT / "docs").glob("*.md")} - set(texts)
    if forgotten:
        raise SystemExit(f"error: {', '.join(sorted(forgotten))} of docs have no place in ORDER of {Path(__file__).name}")

    sites = {file: name for name, file in reversed(files.items())}
    homes = {(files[name], anchor): name for name, text in texts.items() for anchor in anchors(text)}
    equations = {
        number: name
        for name, text in texts.items()
        for equation in EQUATION.findall(text)
        for number in re.findall(r"\\tag\{(\d+)\}", equation)
    }
    texts = draw(texts, npm)

    for name, text in texts.items():
        file = files[name]

        def follow(part: str) -> str:
            def led(link: re.Match[str]) -> str:
                to = link[2]
                is_elsewhere = re.match(r"[a-z]+:", to) is not None
                # A page of this site that was made here.
                is_made = file.name in {f"{cut}.md" for cut in CUT} and to.removesuffix(".md") in texts
                return link[0] if is_elsewhere or is_made else link[1] + target(to, file, sites, homes, pages) + link[3]

            part = LINK.sub(led, part)
            cited = r"(theory\.md )\((\d+)\)"
            return re.sub(cited, lambda m: f"{m[1]}[({m[2]})]({equations[m[2]]}.md#eq-{m[2]})" if m[2] in equations else m[0], part)

        (pages / f"{name}.md").write_text(outside_of_code(text, follow), "utf-8")

    config = {"INHERIT": str(HERE / "mkdocs.yml"), "docs_dir": str(pages), "nav": nav}
    (work / "mkdocs.yml").write_text(json.dumps(config, indent=1), "utf-8")
    (pages / "api.md").write_text(API + "\n".join(f"::: spunlaid.{name}\n" for name in public()), "utf-8")


if __name__ == "__main__":
    main()
