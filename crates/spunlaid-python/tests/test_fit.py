"""Fits of webs to scans."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest
from conftest import CASES

import spunlaid

SMALL = {
    "web.width": 0.1,
    "web.length": 0.1,
    "laydown.sigma_md": 0.006,
    "laydown.sigma_cd": 0.006,
    "line.belt_speed": 5.0,
}
# Of a start at 500: 200 to 2000, as the program is asked.
KEYS = {"line.filaments_per_metre": ("-60 %", "+300 %")}


@pytest.fixture(scope="module")
def scan(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A web of 900 filaments per metre."""
    folder = tmp_path_factory.mktemp("fit") / "scan"
    values = {**SMALL, "line.filaments_per_metre": 900, "web.seed": 5}
    spunlaid.web(CASES / "web_known.toml", set=values, threads=1).save(folder)
    return folder


def test_the_number_is_found_as_by_the_program(scan: Path, program: Path, tmp_path: Path) -> None:
    start = {**SMALL, "line.filaments_per_metre": 500}
    web = CASES / "web_known.toml"
    found = spunlaid.fit(web, scan, KEYS, webs=8, set=start, out=tmp_path / "python", figures="pdf", threads=1)
    low, high = found.intervals["line.filaments_per_metre"]
    assert low < 900 < high
    assert high / low < 3
    assert found.values["line.filaments_per_metre"] == pytest.approx(900, rel=0.4)
    assert "can look like the scan" in found.sentences[0]
    command = [program, "fit", web, "--to", scan, "--vary", "line.filaments_per_metre=200..2000", "--webs", "8", "--quiet"]
    for key, value in start.items():
        command += ["--set", f"{key}={value} m/s" if "speed" in key else f"{key}={value}" if "filaments" in key else f"{key}={value} m"]
    subprocess.run([*command, "--out", tmp_path / "program"], check=True, capture_output=True)
    reported = json.loads((tmp_path / "program" / "fit.json").read_text())
    assert reported == found.summary == json.loads((tmp_path / "python" / "fit.json").read_text())
    assert {path.suffix for path in (tmp_path / "python" / "figures").iterdir()} == {".csv", ".pdf"}


def test_what_is_wrong_is_said(scan: Path, tmp_path: Path) -> None:
    with pytest.raises(spunlaid.CaseError, match=r"line\.depht cannot be sought"):
        spunlaid.fit(CASES / "web_known.toml", scan, ["line.depht"])
    with pytest.raises(spunlaid.CaseError, match="is a change of a value that is not given; write line.slot_gap=FROM..TO"):
        spunlaid.fit(CASES / "web_known.toml", scan, {"line.slot_gap": ("-20 %", "+20 %")})
    with pytest.raises(ValueError, match="figures: "):
        spunlaid.fit(CASES / "web_known.toml", scan, ["laydown.noise"], out=tmp_path / "fit", figures="gif")
    with pytest.raises(ValueError, match="name one: out"):
        spunlaid.fit(CASES / "web_known.toml", scan, ["laydown.noise"], figure_width="one-column")
    with pytest.raises(spunlaid.FolderError, match="holds no scanned or laid web"):
        spunlaid.fit(CASES / "web_known.toml", tmp_path, ["laydown.noise"])
