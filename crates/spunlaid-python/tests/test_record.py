"""Velocity records."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from conftest import CASES

import spunlaid

PROBE = CASES / "records" / "probe.csv"


def test_identical_from_array_file_and_program(program: Path, tmp_path: Path) -> None:
    table = np.loadtxt(PROBE, delimiter=",", skiprows=1 + sum(line.startswith("#") for line in PROBE.read_text().splitlines()))
    rate = 1 / (table[1, 0] - table[0, 0])
    array, file = spunlaid.analyse(table[:, 1:], rate), spunlaid.analyse(PROBE)
    subprocess.run([program, "analyse", PROBE, "--out", tmp_path / "a", "--quiet"], check=True, capture_output=True)
    reported = json.loads((tmp_path / "a" / "analysis.json").read_text())
    assert {**reported, "record": None} == {**file.results, "record": None}
    assert (tmp_path / "a" / "air.toml").read_text() == file.air_toml
    # The times of the file are rounded to a microsecond.
    for name in ("mean_velocity", "turbulence_intensity", "integral_time", "length_scale", "cutoff_frequency"):
        np.testing.assert_allclose(getattr(array, name), getattr(file, name), rtol=1e-9)


def test_spectrum_autocorrelation_and_air_of_a_record() -> None:
    found = spunlaid.analyse(PROBE)
    frequency, density = found.spectrum()
    rms = found.turbulence_intensity.value * found.mean_velocity.value
    np.testing.assert_allclose(np.sum(density) * (frequency[1] - frequency[0]), rms**2, rtol=0.05)
    lag, coefficient = found.autocorrelation()
    assert coefficient[0] == pytest.approx(1.0) and 0 < coefficient[np.searchsorted(lag, found.integral_time.value)] < 0.6
    assert found.apply(spunlaid.Case.starter())["air.velocity"] == found.mean_velocity.value


@pytest.mark.parametrize(
    ("record", "rate", "error"),
    [
        (np.zeros(1000), 1e3, spunlaid.FileError),
        (np.arange(10.0), 1e3, spunlaid.FileError),
        (np.full(1000, np.nan), 1e3, ValueError),
        (np.random.default_rng(1).normal(10, 1, (100, 4)), 1e3, ValueError),
        (np.random.default_rng(1).normal(10, 1, 1000), None, ValueError),
        (np.random.default_rng(1).normal(10, 1, 1000), -1.0, ValueError),
        (np.random.default_rng(1).normal(10, 1, 1000), float("nan"), ValueError),
        (np.empty(0), 1e3, (ValueError, spunlaid.FileError)),
        (["a", "b"], 1e3, TypeError),
        (None, 1e3, (TypeError, ValueError)),
        ("nowhere.csv", None, spunlaid.FileError),
    ],
)
def test_rejects_what_is_no_record(record: object, rate: float | None, error: type[Exception]) -> None:
    with pytest.raises(error):
        spunlaid.analyse(record, rate)  # type: ignore[arg-type]


def test_rules_of_the_integral() -> None:
    u = np.random.default_rng(3).normal(10, 1, 4000)
    assert spunlaid.analyse(u, 1e3, integral="e-fold").results["method"]["integral"] != spunlaid.analyse(u, 1e3).results["method"]["integral"]
    with pytest.raises(ValueError, match="first-zero"):
        spunlaid.analyse(u, 1e3, integral="often")
