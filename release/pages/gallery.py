"""Makes the gallery of the site: runs the commands of docs/first_hour.md and a few more, and keeps the reports.

    python gallery.py PROGRAM PAGES

A command of the page that fails ends it.
"""

from __future__ import annotations

import html
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# A report: its command in addition to those of the page, if it needs one; its folder; the figure that stands for it.
REPORTS = (
    ("A run", None, "fibre", "end_node_path"),
    ("Two runs compared", None, "fibre_against_faster", "amplitude_along_fibre"),
    ("A filament that is fed and laid", "spunlaid run cases/spunbond.toml", "spunbond", "laid_trace"),
    ("A spinline", "spunlaid spin cases/spinline.toml", "spinline", None),
    ("A web in one air, with advice", None, "line", "web_cv"),
    ("A web of known numbers", "spunlaid web cases/web_known.toml", "web_known", "web_cv"),
    ("A scan", None, "scan", "web_cv"),
    ("A fit to a scan", None, "fit", "fit_cv"),
    ("A record of a hot wire", "spunlaid analyse cases/records/probe.csv --out results/record", "record", None),
    ("The air of a case", "spunlaid air cases/spunbond_slot.toml --frames 6 --out results/air", "air", None),
    ("A study", "spunlaid sweep cases/studies/web_evenness.toml --replicates 1 --set web.width=0.3m --set web.length=0.3m", "web_evenness", None),
)


def main() -> None:
    program, pages = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    gallery = pages / "gallery"
    gallery.mkdir()
    page = (ROOT / "docs/first_hour.md").read_text("utf-8")
    blocks = re.findall(r"^```sh\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    (file,) = re.findall(r"file `(\w+\.toml)`:\n\n```toml\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    commands = [line for block in blocks for line in block.splitlines()] + [more for _, more, _, _ in REPORTS if more]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "cases").symlink_to(ROOT / "cases")
        (folder / file[0]).write_text(file[1], "utf-8")
        environment = {**os.environ, "PATH": f"{program.parent}{os.pathsep}{os.environ['PATH']}"}
        by_folder: dict[str, str] = {}
        for command in commands:
            before = {path.parent.name for path in folder.glob("results/*/report.html")}
            print(f"$ {command}", flush=True)
            subprocess.run(command, shell=True, cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL)
            made = {path.parent.name for path in folder.glob("results/*/report.html")} - before
            by_folder.update(dict.fromkeys(made, command))
        cards = []
        for title, _, results, figure in REPORTS:
            made_in = folder / "results" / results
            shutil.copyfile(made_in / "report.html", gallery / f"{results}.html")
            figures = sorted((made_in / "figures").glob("*.png"))
            picture = next((path for path in figures if path.stem == figure), figures[0])
            shutil.copyfile(picture, gallery / f"{results}.png")
            cards.append(
                f'<a href="gallery/{results}.html"><img src="gallery/{results}.png" alt="" loading="lazy">'
                f"<b>{html.escape(title)}</b><br><code>{html.escape(by_folder[results])}</code></a>"
            )
    text = (
        "# Gallery\n\nReports as the program writes them, each with its command. A report is one page that needs nothing else.\n\n"
        f'<div class="gallery">{"".join(cards)}</div>\n'
    )
    (pages / "gallery.md").write_text(text, "utf-8")


if __name__ == "__main__":
    main()
