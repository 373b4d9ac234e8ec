"""Plots with matplotlib."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import CASES

import spunlaid
from spunlaid import Case

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")


@pytest.fixture(autouse=True)
def closed() -> Any:
    yield
    matplotlib.pyplot.close("all")


@pytest.fixture(scope="module")
def run(short: Case) -> spunlaid.Run:
    return spunlaid.run(short, 11)


def numbers(line: Any) -> tuple[Any, Any]:
    return np.asarray(line.get_xdata(), dtype=float), np.asarray(line.get_ydata(), dtype=float)


def test_a_run_shows_its_free_ends(run: spunlaid.Run) -> None:
    ax = run.plot()
    assert ax.get_xlabel() == "Time (s)" and ax.get_ylabel().endswith("$y$ (mm)")
    assert len(ax.lines) == 8
    for line, y in zip(ax.lines, run.end_node["y_m"], strict=False):
        np.testing.assert_array_equal(numbers(line)[0], run.end_node["time_s"])
        np.testing.assert_allclose(numbers(line)[1], 1e3 * y, rtol=1e-14)
    # On axes of the caller.
    _, mine = matplotlib.pyplot.subplots()
    assert run.plot(ax=mine) is mine


def test_measures_have_their_units(run: spunlaid.Run, tmp_path: Path) -> None:
    amplitude = run.measures["amplitude_y_m"]
    run.save(tmp_path / "r")
    for each in (run, spunlaid.load(tmp_path / "r")):
        ax = each.plot("amplitude_y_m")
        assert (ax.get_xlabel(), ax.get_ylabel()) == ("Replicate", "Amplitude in y (mm)")
        np.testing.assert_allclose(numbers(ax.lines[0])[1], 1e3 * amplitude.values, rtol=1e-14)
        np.testing.assert_allclose(numbers(ax.lines[1])[1], 1e3 * amplitude.mean, rtol=1e-14)
    curve = run.curves["spectrum_y_m2_hz"]
    ax = run.plot("spectrum_y_m2_hz")
    assert "(Hz)" in ax.get_xlabel() and "(mm²/Hz)" in ax.get_ylabel() and (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
    np.testing.assert_allclose(numbers(ax.lines[0]), [curve.at, 1e6 * curve.mean], rtol=1e-12)
    along = run.curves["amplitude_y_along_fibre_m"]
    ax = run.plot("amplitude_y_along_fibre_m")
    np.testing.assert_allclose(numbers(ax.lines[0]), [1e3 * along.at, 1e3 * along.mean], rtol=1e-12)
    with pytest.raises(KeyError, match="amplitude_y_m"):
        run.plot("amplitude_y")


def test_a_fed_fibre_shows_what_it_laid(fed: Case) -> None:
    run = spunlaid.run(fed)
    ax = run.plot()
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Machine direction (mm)", "Cross direction (mm)") and ax.get_aspect() == 1.0
    md, cd = numbers(ax.lines[0])
    laid = run.laid[0]
    assert len(md) > 3 and set(np.round(cd, 9)) <= set(np.round(1e3 * laid["cd_m"], 9))
    with pytest.raises(ValueError, match="samples=False"):
        spunlaid.run(Case.starter(), set={"run.duration": 0.002, "run.time_step": "20 us", "run.spin_up": 0}, samples=False).plot()


def test_a_study_has_a_line_for_what_is_in_common(short: Case) -> None:
    vary = {"air.velocity": [20.0, 5.0, 10.0], "fibre.diameter": ["20 um", "50 um"]}
    study = spunlaid.sweep({"case": short, "replicates": 4, "vary": vary})
    ax = study.plot()
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Mean velocity $U$ (m/s)", "Amplitude in y (mm)")
    names = [text.get_text() for text in ax.get_legend().get_texts()]
    assert names == ["Fibre diameter $d$ = 20 µm", "Fibre diameter $d$ = 50 µm"]
    mean, inputs = study.mean["amplitude_y_m"], study.inputs
    for container, diameter in zip(ax.containers, (20e-6, 50e-6), strict=True):
        x, y = numbers(container.lines[0])
        assert list(x) == [5.0, 10.0, 20.0], "a line goes from the left to the right"
        at = [np.flatnonzero((inputs["air.velocity"] == u) & (inputs["fibre.diameter"] == diameter))[0] for u in x]
        np.testing.assert_allclose(y, 1e3 * mean[at], rtol=1e-14)
    ax = study.plot("frequency_y_hz", along="fibre.diameter")
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Fibre diameter $d$ (µm)", "Frequency in y (Hz)") and len(ax.containers) == 3
    for arguments in ({"column": "amplitude"}, {"along": "air.density"}):
        with pytest.raises(KeyError, match="there are"):
            study.plot(**arguments)


def test_words_and_drawn_points_are_not_joined(short: Case) -> None:
    roots = spunlaid.sweep({"case": short, "replicates": 2, "vary": {"fibre.root": ["pinned", "clamped"]}}).plot()
    assert [text.get_text() for text in roots.get_xticklabels()] == ["pinned", "clamped"]
    drawn = {"design": "latin-hypercube", "points": 4, "vary": {"air.velocity": {"from": 5, "to": 20}, "fibre.length": {"from": 0.5, "to": 1.0}}}
    drawn_ax = spunlaid.sweep({"case": short, "replicates": 2, **drawn}).plot()
    for ax in (roots, drawn_ax):
        assert [container.lines[0].get_linestyle() for container in ax.containers] == ["None"]
    alone = {"design": "one-at-a-time", "vary": {"air.velocity": [5, 20], "fibre.length": [0.5, 0.8]}}
    ax = spunlaid.sweep({"case": short, "replicates": 2, **alone}).plot(along="fibre.length")
    assert list(numbers(ax.containers[0].lines[0])[0]) == [500.0, 800.0, 1000.0], "those of the other factor are left out"


def test_a_web_shows_its_map_and_its_unevenness() -> None:
    web = spunlaid.web(CASES / "web_known.toml", set={"web.width": 0.2, "web.length": 0.3})
    ax = web.plot()
    (image,) = ax.get_images()
    np.testing.assert_allclose(image.get_array(), 1e3 * web.map, rtol=1e-14)
    np.testing.assert_allclose(image.get_extent(), (0, 200, 0, 300))
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Cross direction (mm)", "Machine direction (mm)")
    assert image.colorbar.ax.get_ylabel() == "Basis weight (g/m²)"
    ax = web.plot("cv")
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Side of the patches (mm)", "CV of the basis weight (%)")
    np.testing.assert_allclose(numbers(ax.containers[0].lines[0])[1], 100 * web.patches["cv"], rtol=1e-14)
    with pytest.raises(ValueError, match="cv"):
        web.plot("clouds")


def test_what_is_absent_is_reported(run: spunlaid.Run, monkeypatch: pytest.MonkeyPatch) -> None:
    for package, call in (
        ("matplotlib", run.plot),
        ("pandas", run.to_pandas),
        ("pandas", run.measures.to_pandas),
        ("xarray", run.to_xarray),
    ):
        with monkeypatch.context() as patch:
            for name in [name for name in sys.modules if name.partition(".")[0] == package]:
                patch.delitem(sys.modules, name)
            patch.setitem(sys.modules, package, None)
            with pytest.raises(ImportError, match=rf"needs {package}.*pip install"):
                call()
