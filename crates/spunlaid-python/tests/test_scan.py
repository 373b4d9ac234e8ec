"""Scans of webs, and results side by side."""

from __future__ import annotations

import json
import pickle
import subprocess
from pathlib import Path

import numpy as np
import pytest
from conftest import CASES

import spunlaid

SMALL = {"web.width": 0.2, "web.length": 0.2, "laydown.sigma_md": 0.01, "laydown.sigma_cd": 0.01}


@pytest.fixture(scope="module")
def webs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the results of two webs, of which the second is lighter."""
    place = tmp_path_factory.mktemp("webs")
    for name, speed in (("heavy", 3.0), ("light", 6.0)):
        spunlaid.web(CASES / "web_known.toml", set={**SMALL, "line.belt_speed": speed}, threads=2).save(place / name)
    return place


def test_identical_to_the_program(webs: Path, program: Path, tmp_path: Path) -> None:
    picture = webs / "heavy" / "map.png"
    options = ["--weight", "15 g/m²", "--light", "weight", "--md", "rows", "--patches", "2 mm,10 mm", "--keep-shading"]
    command = [program, "analyse", picture, "--out", tmp_path / "program", "--quiet", *options]
    subprocess.run(command, check=True, capture_output=True)
    scan = spunlaid.scan(picture, weight=0.015, light="weight", md="rows", patches=["2 mm", 0.01], keep_shading=True)
    reported = json.loads((tmp_path / "program" / "summary.json").read_text())
    assert {**reported, "performance": None} == {**scan.summary, "performance": None}
    scan.save(tmp_path / "python")
    assert (tmp_path / "program" / "map.npy").read_bytes() == (tmp_path / "python" / "map.npy").read_bytes()
    names = [sorted(path.name for path in (tmp_path / which).rglob("*")) for which in ("program", "python")]
    # The program keeps its command.
    assert set(names[0]) - set(names[1]) == {"origin.toml"} and set(names[1]) <= set(names[0])
    for patch, i in zip(reported["web"]["patches"], range(2), strict=True):
        for name, values in scan.patches.items():
            if name in patch:
                assert values[i] == (np.nan if patch[name] is None else patch[name]) or np.isnan(values[i]), name


def test_identical_from_array_and_file(webs: Path) -> None:
    basis_weight = np.load(webs / "light" / "map.npy")
    cell = json.loads((webs / "light" / "summary.json").read_text())["web"]["cell_m"]
    array, file = spunlaid.scan(basis_weight, pixel=cell), spunlaid.scan(webs / "light" / "map.npy", pixel=cell)
    np.testing.assert_array_equal(array.map, file.map)
    assert array.mean_known and array.cell == pytest.approx(cell)
    np.testing.assert_allclose(array.map, basis_weight, rtol=1e-3, atol=1e-5 * basis_weight.mean())
    for name, values in file.patches.items():
        np.testing.assert_array_equal(array.patches[name], values)
    # The CV is that of the web that was laid, whose patches also go around its edges.
    laid = json.loads((webs / "light" / "summary.json").read_text())["web"]["patches"]
    patch = next(patch for patch in laid if patch["patch_m"] > 5 * cell)
    again = spunlaid.scan(basis_weight, pixel=cell, patches=[patch["patch_m"]])
    assert abs(again.patches["cv"].item() - patch["cv"]) < patch["cv_standard_error"]


def test_identical_after_pickling(webs: Path, tmp_path: Path) -> None:
    scan = spunlaid.scan(webs / "light" / "map.png")
    again = pickle.loads(pickle.dumps(scan))
    np.testing.assert_array_equal(again.map, scan.map)
    assert not again.map.flags.writeable and not scan.map.flags.writeable
    assert (again.summary, again.notes, repr(again)) == (scan.summary, scan.notes, repr(scan))
    assert repr(scan).startswith("<Scan map: ") and "iframe" in scan._repr_html_()
    again.save(tmp_path / "again")
    assert (tmp_path / "again" / "report.html").read_text("utf-8") == scan.report()


@pytest.mark.parametrize(
    ("picture", "options", "error", "message"),
    [
        ("nowhere.png", {}, spunlaid.FileError, "nowhere.png"),
        (np.ones((40, 40)), {}, spunlaid.FileError, "pixel"),
        (np.ones(40), {"pixel": 1e-3}, spunlaid.FileError, "dimension"),
        (np.ones((40, 40)), {"pixel": "1 kg"}, ValueError, "pixel = "),
        (np.ones((40, 40)), {"pixel": -1.0}, ValueError, "above zero"),
        (np.ones((40, 40)), {"pixel": True}, TypeError, "bool"),
        (np.ones((40, 40)), {"pixel": 1e-3, "light": "bright"}, ValueError, '"transmitted", "reflected", "weight"'),
        (np.ones((40, 40)), {"pixel": 1e-3, "md": "up"}, ValueError, "columns"),
        (np.ones((40, 40)), {"pixel": 1e-3, "patches": [1e-3, "1 s"]}, ValueError, "patches = "),
        (np.ones((40, 40)), {"pixel": 1e-3, "lamp": "lamp.png", "white": 200}, ValueError, "lamp and white"),
        ({"a": 1}, {"pixel": 1e-3}, TypeError, "array of basis weights"),
    ],
)
def test_rejects_what_is_no_scan(picture: object, options: dict[str, object], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        spunlaid.scan(picture, **options)  # type: ignore[arg-type]


def test_a_scan_is_no_record(webs: Path) -> None:
    with pytest.raises(ValueError, match="spunlaid.scan"):
        spunlaid.analyse(webs / "light" / "map.png")


def test_identical_comparison_of_webs(webs: Path, program: Path, tmp_path: Path) -> None:
    folders = [webs / "heavy", webs / "light"]
    command = [program, "compare", *folders, "--out", tmp_path / "program", "--quiet"]
    subprocess.run(command, check=True, capture_output=True)
    found = spunlaid.compare(*folders)
    assert json.loads((tmp_path / "program" / "comparison.json").read_text()) == found.summary
    found.save(tmp_path / "python")
    for name in ("comparison.json", "report.html", "figures/web_picture_1.png"):
        assert (tmp_path / "program" / name).read_bytes() == (tmp_path / "python" / name).read_bytes(), name
    with pytest.raises(spunlaid.FolderError, match="holds results already"):
        found.save(tmp_path / "python")
    table = found.to_pandas().loc["light"]
    cv = table.loc[[name for name in table.index if name.startswith("cv_")]]
    # Half the weight is less even.
    assert (cv["difference"].dropna() > 0).all() and cv["significant"].dropna().any()
    assert repr(found) == "<Comparison of light with heavy>"


def test_identical_comparison_of_runs(short: spunlaid.Case, program: Path, tmp_path: Path) -> None:
    for name, changes in (("one", {}), ("two", {"air.velocity": 12.0})):
        spunlaid.run(short.with_(changes), threads=2).save(tmp_path / name)
    folders = [tmp_path / "one", tmp_path / "two"]
    reported = subprocess.run([program, "compare", *folders, "--json"], check=True, capture_output=True, text=True)
    found = spunlaid.compare(*folders)
    assert json.loads(reported.stdout) == found.summary
    [compared] = found.comparisons
    assert compared["paired"] and compared["pairs"] == 3
    amplitudes = [spunlaid.load(folder).measures["amplitude_y_m"].mean for folder in folders]
    measure = compared["measures"]["amplitude_y_m"]
    assert [measure["against"]["mean"], measure["run"]["mean"]] == amplitudes
    assert measure["difference"] == pytest.approx(amplitudes[1] - amplitudes[0])


@pytest.mark.parametrize(("count", "message"), [(0, "0 folders are named"), (1, "1 folders are named"), (99, "at most")])
def test_rejects_what_cannot_be_compared(count: int, message: str, tmp_path: Path) -> None:
    with pytest.raises(spunlaid.Error, match=message):
        spunlaid.compare(*[tmp_path] * count)


def test_rejects_a_folder_without_results(webs: Path, tmp_path: Path) -> None:
    with pytest.raises(spunlaid.FolderError, match="summary.json"):
        spunlaid.compare(webs / "light", tmp_path)
