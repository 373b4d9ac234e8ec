"""Webs."""

from __future__ import annotations

import json
import pickle
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from conftest import CASES

import spunlaid

SMALL = {"web.width": 0.1, "web.length": "0.1 m", "laydown.sigma_md": "10 mm", "laydown.sigma_cd": 0.01}


@pytest.fixture(scope="module")
def web() -> spunlaid.Web:
    return spunlaid.web(CASES / "web_known.toml", set=SMALL, threads=2, advice=True)


def without_folders(summary: dict) -> dict:
    """A summary without how long it took, and without the folders into which its commands write."""
    return json.loads(re.sub(r' --out [^"]*"', '"', json.dumps({**summary, "performance": None})))


def test_identical_to_the_program(web: spunlaid.Web, program: Path, tmp_path: Path) -> None:
    command = [program, "web", CASES / "web_known.toml", "--out", tmp_path / "w", "--quiet"]
    # The settings of the advice are written as they were given; numbers of Python are in SI units.
    for setting in ("web.width=0.1 m", "web.length=0.1 m", "laydown.sigma_md=10 mm", "laydown.sigma_cd=0.01 m"):
        command += ["--set", setting]
    subprocess.run(command, check=True, capture_output=True)
    reported = json.loads((tmp_path / "w" / "summary.json").read_text())
    assert without_folders(reported) == without_folders(web.summary)
    web.save(tmp_path / "python")
    for name in ("map.npy", "fibres.vtp"):
        assert (tmp_path / "w" / name).read_bytes() == (tmp_path / "python" / name).read_bytes()
    with pytest.raises(spunlaid.FolderError, match="holds results already"):
        web.save(tmp_path / "python")
    web.save(tmp_path / "print", figures=["pdf"], figure_width="two-columns")
    suffixes = {path.suffix for path in (tmp_path / "print" / "figures").iterdir()}
    assert ".pdf" in suffixes and ".svg" not in suffixes


def test_what_filaments_do_to_their_air() -> None:
    coarse = {"air.lateral_cutoff": 6, "fibre.element_length": "20 mm", "run.duration": "50 ms", "run.spin_up": "10 ms"}
    small = {"web.width": 0.2, "web.length": 0.2, "web.cell": "1 mm", "web.simulated": 100}
    web = spunlaid.web(CASES / "web_shared.toml", set={**coarse, **small}, assumed_values=False, threads=2)
    [curtain], reported = web.curtains, web.summary["layers"][0]["curtain"]
    assert curtain["filaments_per_m"] == 5000 and curtain["mass_loading"] == reported["mass_loading"]
    places = curtain["places"]
    np.testing.assert_allclose(places["x_m"], np.linspace(0.05, 0.5, 10))
    for name in ("mean", "standard_error"):
        column = places["force_n_per_m" if name == "mean" else "force_n_per_m_se"]
        np.testing.assert_array_equal(column, [place["force_n_per_m"][name] for place in reported["places"]])
    # The filaments fall into air that is slower than they are.
    assert places["force_n_per_m"][-1] > 5 * places["force_n_per_m_se"][-1] > 0
    np.testing.assert_allclose(places["change_of_velocity"], np.sqrt(1 + places["share_of_momentum"]) - 1)


def test_known_curves_have_no_air(web: spunlaid.Web) -> None:
    assert web.curtains == []


def test_advice_only_where_it_is_asked_for(web: spunlaid.Web) -> None:
    assert {change["setting"] for change in web.summary["advice"]["changes"]} == {"throughput", "holes", "titre"}
    without = spunlaid.web(CASES / "web_known.toml", set=SMALL, threads=2)
    assert "advice" not in without.summary
    np.testing.assert_array_equal(without.map, web.map)


def test_identical_after_pickling(web: spunlaid.Web, tmp_path: Path) -> None:
    again = pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(web))))
    np.testing.assert_array_equal(again.map, web.map)
    assert not again.map.flags.writeable
    assert (again.summary, again.notes, again.cell, repr(again)) == (web.summary, web.notes, web.cell, repr(web))
    for name, numbers in web.patches.items():
        np.testing.assert_array_equal(again.patches[name], numbers)
    assert again.report() == web.report()
    web.save(tmp_path / "one")
    again.save(tmp_path / "two")
    names = [sorted(path.name for path in (tmp_path / which).rglob("*")) for which in ("one", "two")]
    assert names[0] == names[1]
    with pytest.raises(spunlaid.FolderError, match="holds results already"):
        again.save(tmp_path / "two")
    (tmp_path / "two" / "thesis.tex").write_text("mine")
    again.save(tmp_path / "two", force=True)
    assert (tmp_path / "two" / "thesis.tex").read_text() == "mine"
    with pytest.raises(ValueError, match="with their figures as they are"):
        again.save(tmp_path / "three", figures=["pdf"])


def test_advice_can_be_set(web: spunlaid.Web) -> None:
    changes = web.summary["advice"]["changes"]
    change = next(change for change in changes if change["setting"] == "titre")
    assert change["command"].startswith("spunlaid web ")
    changed = spunlaid.web(CASES / "web_known.toml", set=change["set"], threads=2)
    # The titre is another one, and the basis weight is the same.
    np.testing.assert_allclose(changed.map.mean(), web.map.mean(), rtol=1e-4)
    assert changed.summary["layers"][0]["linear_density_kg_m"] == pytest.approx(change["keys"][0]["to"])


def test_keys_of_the_flown_case() -> None:
    web = {
        "laydown": {"case": CASES / "spunbond.toml"},
        "line": {"filaments_per_metre": 100},
        "web": {"width": 0.1, "length": 0.05, "cell": "1 mm"},
    }
    short = {"run.duration": "0.1 s", "run.spin_up": "10 ms", "run.replicates": 2, "fibre.element_length": "10 mm"}
    near, far = (spunlaid.web(web, set={**short, "belt.distance": at}, threads=2) for at in ("0.1 m", "0.15 m"))
    assert near.map.mean() > 0
    assert near.summary["layers"][0]["sigma_cd_m"] != far.summary["layers"][0]["sigma_cd_m"]
    with pytest.raises(spunlaid.CaseError, match="is a key of a simulated filament, and this web simulates none"):
        spunlaid.web(CASES / "web_known.toml", set={"belt.distance": "0.4 m"})


def test_analytic_basis_weight(web: spunlaid.Web) -> None:
    line_density = np.pi / 4 * 18e-6**2 * 910
    # Line density x filaments per width x feed speed / belt speed; the map is counted in quanta of 1e-5 of a fibre.
    np.testing.assert_allclose(web.map.mean(), line_density * 5000 * 50 / 3.8594, rtol=1e-4)
    rows, columns = web.map.shape
    assert (rows * web.cell, columns * web.cell) == pytest.approx((0.1, 0.1))
    # The CV over patches of a cell is that of the map.
    cv = web.map.std() / web.map.mean()
    first = np.argmin(np.abs(web.patches["patch_m"] - web.cell))
    if np.isclose(web.patches["patch_m"][first], web.cell):
        np.testing.assert_allclose(web.patches["cv"][first], cv, rtol=1e-3)
    assert "iframe" in web._repr_html_()
    # Independent filaments have no neighbours.
    assert [len(numbers) for numbers in web.neighbours.values()] == [0] * 5


def test_patches_hold_every_number_of_the_summary(web: spunlaid.Web) -> None:
    for i, patch in enumerate(web.summary["web"]["patches"]):
        numbers = {name: value for name, value in patch.items() if name not in ("cv_interval", "no_interval")}
        assert len(numbers) > 4
        for name, value in numbers.items():
            # Python has another name for it.
            of_python = web.patches[name.replace("one_fibre", "single_fibres")][i]
            assert of_python == value or (value is None and np.isnan(of_python)), name


def test_a_dict_is_a_web(web: spunlaid.Web) -> None:
    same = spunlaid.web(
        {
            "fibre": {"diameter": 18e-6, "density": "910 kg/m^3"},
            "laydown": {"sigma_md": 0.01, "sigma_cd": 0.01, "noise": "12.4 m^-0.5"},
            "line": {"feed_speed": 50, "belt_speed": 3.8594, "filaments_per_metre": 5000},
            "web": {"width": 0.1, "length": 0.1},
        }
    )
    np.testing.assert_array_equal(same.map, web.map)


@pytest.mark.parametrize(
    ("web", "error"),
    [({}, spunlaid.CaseError), ("nowhere.toml", spunlaid.FileError), ({"web": 3}, spunlaid.CaseError), (3, TypeError)],
)
def test_rejects_what_is_no_web(web: object, error: type[Exception]) -> None:
    with pytest.raises(error):
        spunlaid.web(web)  # type: ignore[arg-type]


def test_a_study_of_webs(program: Path, tmp_path: Path) -> None:
    study = {
        "web": CASES / "web_known.toml",
        "replicates": 2,
        "set": {**SMALL, "web.width": "0.1 m"},
        "vary": {"line.belt_speed": [3.0, 4.0]},
    }
    found = spunlaid.sweep(study, out=tmp_path / "here")
    assert list(found.n) == [2, 2] and repr(found).endswith("4 webs>")
    # A slower belt takes more fibre, which is more even.
    basis, cv = found.mean["basis_weight_kg_m2"], found.mean["cv_10_mm_one_fibre"]
    np.testing.assert_allclose(basis[0] / basis[1], 4 / 3, rtol=1e-4)
    assert cv[0] < cv[1]
    assert spunlaid.keys(web=True)["line.belt_speed"].varies
    with pytest.raises(ValueError, match="webs"):
        found.case(0)
    # The program gives the same files from the study as it was written.
    command = [program, "sweep", tmp_path / "here" / "study.toml", "--out", tmp_path / "there", "--quiet"]
    subprocess.run(command, check=True, capture_output=True)
    for name in ("results.csv", "results.json", "results.parquet"):
        assert (tmp_path / "here" / name).read_bytes() == (tmp_path / "there" / name).read_bytes(), name


LAYERS = """
version = 1
[web]
width = "0.2 m"
length = "0.1 m"
[[layer]]
[layer.fibre]
diameter = "18 µm"
density = "910 kg/m³"
[layer.laydown]
sigma_md = "9 mm"
sigma_cd = "8 mm"
noise = "15 m^-0.5"
[layer.line]
feed_speed = "50 m/s"
belt_speed = "5 m/s"
filaments_per_metre = 200
[[layer]]
name = "M"
[layer.fibre]
diameter = "4 µm"
density = "910 kg/m³"
[layer.laydown]
sigma_md = "12 mm"
sigma_cd = "12 mm"
noise = "10 m^-0.5"
[layer.line]
feed_speed = "50 m/s"
rows = [{ pitch = "1 mm", filaments = 200 }]
"""


def test_identical_alone_and_in_a_study_of_one_layer(tmp_path: Path) -> None:
    """A key of a layer varies by its number or its name; numbers are in SI units."""
    path = tmp_path / "web.toml"
    path.write_text(LAYERS, encoding="utf-8")
    common = {"web.cell": 0.002, "web.edges": "cut", "layer.M.laydown.noise": 11.0}
    for key, values in {
        "layer.1.laydown.sigma_md": [0.009, 0.012],
        "layer.M.fibre.diameter": [4e-6, 6e-6],
        "layer.2.line.rows.1.pitch": [0.001, 0.0008],
    }.items():
        found = spunlaid.sweep({"web": path, "vary": {key: values}}, set=common)
        alone = [spunlaid.web(path, set={**common, key: value}) for value in values]
        expected = [web.patches["cv"][np.isclose(web.patches["patch_m"], 0.01)][0] for web in alone]
        assert list(found.mean["cv_10_mm"]) == expected and expected[0] != expected[1], key
