"""Spinlines."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from conftest import CASES

import spunlaid

LINE = {
    "polymer": "pp",
    "melt_flow_rate": 35,
    "die_temperature": 503.15,
    "hole_diameter": 0.6e-3,
    "throughput": "0.5 g/min",
    "length": 1.2,
    "velocity": 50.0,
    "cross_velocity": "0.5 m/s",
}


def test_identical_to_the_program(program: Path, tmp_path: Path) -> None:
    line = spunlaid.spin(CASES / "spinline.toml", set={"spinline.throughput": "0.4 g/min"})
    command = [program, "spin", CASES / "spinline.toml", "--set", "spinline.throughput=0.4 g/min", "--out", tmp_path / "p", "--quiet"]
    subprocess.run(command, check=True, capture_output=True)
    assert json.loads((tmp_path / "p" / "summary.json").read_text()) == line.summary
    line.save(tmp_path / "python")
    for name in ("spinline.parquet", "report.html"):
        assert (tmp_path / "p" / name).read_bytes() == (tmp_path / "python" / name).read_bytes()
    with pytest.raises(spunlaid.FolderError, match="holds results already"):
        line.save(tmp_path / "python")
    line.save(tmp_path / "python", force=True)
    line.save(tmp_path / "print", figures=["pdf"], figure_width=0.09)
    assert {path.suffix for path in (tmp_path / "print" / "figures").iterdir()} == {".csv", ".pdf"}


def test_measures_and_stations_agree() -> None:
    line = spunlaid.spin({"spinline": LINE, "drag": {"along": "matsui"}})
    assert line.measures["final_diameter_m"] == line.final_diameter_m
    stations = line.stations
    assert stations["speed_m_s"][-1] == line.final_speed_m_s
    assert stations["z_m"][-1] == pytest.approx(1.2)
    assert np.all(np.diff(stations["z_m"]) > 0)
    # The throughput is the line density times the speed.
    assert line.linear_density_kg_m * line.final_speed_m_s == pytest.approx(0.5e-3 / 60, rel=1e-12)
    frozen = stations["z_m"] >= line.solidification["distance_m"]
    np.testing.assert_allclose(stations["speed_m_s"][frozen], line.final_speed_m_s, rtol=1e-12)
    assert line.influences[0]["diameter"] != 0
    assert "dtex" in repr(line)
    assert "iframe" in line._repr_html_()
    with pytest.raises(AttributeError, match="final_diameter_m"):
        line.final_diameter  # noqa: B018


def test_a_curtain_has_rows() -> None:
    curtain = {"spinline.rows": 3, "spinline.filaments_per_metre_and_row": 100}
    line = spunlaid.spin({"spinline": LINE}, set=curtain)
    assert len(line.rows) == 3 == len(line.measures["rows"])
    for row, measures in zip(line.rows, line.measures["rows"], strict=True):
        assert row["speed_m_s"][-1] == measures["final_speed_m_s"]


def test_constants_of_the_polymer_can_be_given() -> None:
    usual = spunlaid.spin({"spinline": LINE})
    other = spunlaid.spin({"spinline": {**LINE, "material": {"solidification_temperature": "120 °C"}}})
    assert other.solidification["temperature_c"] == pytest.approx(120.0)
    assert other.final_diameter_m > usual.final_diameter_m


def test_the_drag_factor_of_a_titre_is_found() -> None:
    changed = {"spinline.drag_factor": 0.8}
    titre = spunlaid.spin({"spinline": LINE}, set=changed).linear_density_kg_m
    assert spunlaid.find_drag_factor({"spinline": LINE}, titre) == pytest.approx(0.8, rel=1e-5)
    with pytest.raises(spunlaid.CaseError, match="cannot be found"):
        spunlaid.find_drag_factor({"spinline": LINE}, "0.01 dtex")


def test_rejects_spinlines_without_a_steady_state() -> None:
    with pytest.raises(spunlaid.CaseError, match="solidifies at 110 °C") as caught:
        spunlaid.spin({"spinline": {**LINE, "length": "50 mm", "end": "take-up", "take_up_speed": 20.0}})
    assert caught.value.key.startswith("spinline.")
    with pytest.raises(spunlaid.CaseError, match="is missing"):
        spunlaid.spin({})
    with pytest.raises(spunlaid.FileError):
        spunlaid.spin("nowhere.toml")


def test_a_study_of_a_dict_is_that_of_the_spinlines() -> None:
    throughputs = [5e-6, 8e-6]
    study = spunlaid.sweep({"spinline": CASES / "spinline.toml", "vary": {"spinline.throughput": throughputs}})
    alone = [spunlaid.spin(CASES / "spinline.toml", set={"spinline.throughput": value}) for value in throughputs]
    assert list(study.mean["final_diameter_m"]) == [line.final_diameter_m for line in alone]
