"""Studies on this machine."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

import spunlaid
from spunlaid import Case

FACTORS = {"air.velocity": [5.0, 10.0, 20.0], "fibre.diameter": ["20 um", "50 um"]}


@pytest.fixture(scope="session")
def study(short: Case) -> dict[str, object]:
    return {"case": short, "design": "grid", "replicates": 5, "vary": FACTORS}


def test_points_are_runs_of_their_cases(study: dict[str, object], short: Case) -> None:
    found = spunlaid.sweep(study, threads=2)
    assert len(found) == 6 and found.factors == list(FACTORS) and (found.n == 5).all() and not found.lost.any()
    for point in range(6):
        case = short.with_({key: values[point] for key, values in found.inputs.items()})
        run = spunlaid.run(case, 5)
        amplitude = run.measures["amplitude_y_m"]
        assert found.mean["amplitude_y_m"][point] == amplitude.mean
        assert found.standard_error["amplitude_y_m"][point] == amplitude.standard_error
        assert found.case(point)["air.velocity"] == case["air.velocity"]


def test_frames_have_the_factors(study: dict[str, object]) -> None:
    found = spunlaid.sweep(study)
    table, data, fibres = found.to_pandas(), found.to_xarray(), found.replicates()
    assert data["amplitude_y_m"].dims == ("air.velocity", "fibre.diameter")
    units = {name: variable.attrs.get("units") for name, variable in data.variables.items()}
    assert (units["air.velocity"], units["fibre.diameter"], units["amplitude_y_m"], units["n"]) == ("m/s", "m", "m", "1")
    assert units["frequency_y_hz"] == units["frequency_y_hz_se"] == "Hz"
    assert all(unit for name, unit in units.items() if name not in ("point", "seed")), units
    at = (table["air.velocity_m_s"] == 20.0) & (table["fibre.diameter_m"] == 50e-6)
    assert data["amplitude_y_m"].sel({"air.velocity": 20.0, "fibre.diameter": 50e-6}) == table[at]["amplitude_y_m"].item()
    assert len(fibres) == 30 and not fibres["lost"].any()
    np.testing.assert_allclose(fibres.groupby("point")["amplitude_y_m"].mean(), table["amplitude_y_m"], rtol=1e-14)
    drawn = spunlaid.sweep({**study, "design": "latin-hypercube", "points": 4, "vary": {"air.velocity": {"from": 5, "to": 20}}})
    assert drawn.to_xarray()["amplitude_y_m"].dims == ("point",)
    assert {of["factor"] for of in found.effects()} == set(FACTORS)


def test_identical_to_the_program(study: dict[str, object], program: Path, tmp_path: Path) -> None:
    found = spunlaid.sweep(study, out=tmp_path / "python")
    again = spunlaid.sweep(study, out=tmp_path / "python")
    assert again.to_pandas().equals(found.to_pandas())
    # The folder has the study and its case, so that the program can fly the same.
    command = [program, "sweep", tmp_path / "python" / "study.toml", "--out", tmp_path / "program", "--quiet"]
    subprocess.run(command, check=True, capture_output=True)
    for table in ("results.csv", "results.parquet", "replicates.parquet", "results.json"):
        first, second = ((tmp_path / of / table).read_bytes() for of in ("python", "program"))
        assert first == second, table


def test_figures_are_written_as_asked_for(study: dict[str, object], tmp_path: Path) -> None:
    small = {**study, "replicates": 2, "vary": {"air.velocity": [5.0, 10.0]}}
    spunlaid.sweep(small, out=tmp_path / "s", figures=["pdf"], figure_width="one-column")
    assert {path.suffix for path in (tmp_path / "s" / "figures").iterdir()} == {".csv", ".pdf"}
    with pytest.raises(ValueError, match="figures: write one of svg"):
        spunlaid.sweep(small, out=tmp_path / "none", figures=["gif"])
    assert not (tmp_path / "none").exists()
    with pytest.raises(ValueError, match="name one: out"):
        spunlaid.sweep(small, figures=["pdf"])



def test_another_study_is_not_mixed_in(study: dict[str, object], tmp_path: Path) -> None:
    spunlaid.sweep(study, out=tmp_path / "s")
    with pytest.raises(spunlaid.FolderError, match="another study"):
        spunlaid.sweep({**study, "vary": {"air.velocity": [6.0]}}, out=tmp_path / "s")
    found = spunlaid.sweep({**study, "vary": {"air.velocity": [6.0]}}, out=tmp_path / "s", force=True)
    assert len(found) == 1


@pytest.mark.parametrize(
    ("said", "key"),
    [
        ({"vary": {"air.velocty": [1.0]}}, "air.velocty"),
        ({"vary": {"air.velocity": [1.0]}, "replicate": 3}, "replicate"),
        ({"vary": {"air.velocity": [1.0]}, "replicates": "many"}, "replicates"),
        ({"vary": {"air.velocity": [1.0]}, "set": {"air.velocty": 2.0}}, "air.velocty"),
        # The case has changes, so that the text that is read of it is not one that the user wrote.
        ({"vary": {"air.velocity": [1.0]}, "set": {"feed.speed": "1 m/s"}}, "fibre.length"),
    ],
)
def test_messages_about_a_dict_name_the_key_and_no_line(said: dict[str, object], key: str, short: Case) -> None:
    leapfrog = short.with_({"run.scheme": "leapfrog", "run.time_step": "1 us"})
    for case in (leapfrog, leapfrog.to_dict(), dict(leapfrog)):
        with pytest.raises(spunlaid.CaseError, match=key.replace(".", r"\.")) as caught:
            spunlaid.sweep({"case": case, **said})
        assert key in [problem.key for problem in caught.value.problems]
        assert {problem.line for problem in caught.value.problems} == {None} and not re.search(r":\d+:", str(caught.value))


def test_a_file_keeps_its_lines(short: Case, tmp_path: Path) -> None:
    text = short.with_({"run.scheme": "leapfrog", "run.time_step": "1 us"}).to_toml()
    (tmp_path / "case.toml").write_text(text)
    with pytest.raises(spunlaid.CaseError) as caught:
        spunlaid.sweep({"case": tmp_path / "case.toml", "set": {"feed.speed": "1 m/s"}, "vary": {"air.velocity": [1.0]}})
    line = 1 + text.split("\nlength")[0].count("\n") + 1
    assert ("fibre.length", line) in [(problem.key, problem.line) for problem in caught.value.problems]


@pytest.mark.parametrize(
    ("study", "error"),
    [
        ({}, ValueError),
        ({"case": 3}, TypeError),
        ({"case": "nowhere.toml"}, spunlaid.FileError),
        ({"case": Case.starter(), "vary": {"air.velocty": [1]}}, spunlaid.CaseError),
        ({"case": Case.starter(), "vary": {"air.velocity": [object()]}}, TypeError),
        ({"case": Case.starter(), "vary": {3: [1]}}, TypeError),
        ({"case": Case.starter(), "vary": {"air.velocity": None}}, TypeError),
        ({"case": Case.starter(), "vary": {"air.velocity": []}}, spunlaid.CaseError),
        ({"case": Case.starter(), "design": "star", "vary": {"air.velocity": [1.0]}}, spunlaid.CaseError),
        ("nowhere.toml", spunlaid.FileError),
        (3, TypeError),
    ],
)
def test_rejects_what_is_no_study(study: object, error: type[Exception]) -> None:
    with pytest.raises(error):
        spunlaid.sweep(study)  # type: ignore[arg-type]


def test_a_value_of_no_use_is_reported_with_its_key(short: Case) -> None:
    for said in ({"vary": {"air.velocity": [object()]}}, {"vary": {"air.velocity": {"from": 1.0, "to": b"2"}}}, {"set": {"air.velocity": None}}):
        with pytest.raises(TypeError, match=r"air\.velocity takes"):
            spunlaid.sweep({"case": short, **said})
