"""The same bits from Python and from the program."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from conftest import CASES

import spunlaid
from spunlaid import Case

# Cases whose numbers, files or results come over the border in other ways, simulated for a short time.
NAMES = "table1 hanging_chain measured_spectrum openfoam_diffuser profile record spunbond".split()


@pytest.mark.parametrize("name", NAMES)
def test_identical_to_the_program(name: str, program: Path, tmp_path: Path) -> None:
    path = CASES / f"{name}.toml"
    case = Case.read(path)
    changes = {"run.replicates": 3, "run.duration": "10 ms", "run.spin_up": "0 s", "run.output_interval": "1 ms"}
    case = case.with_(changes)
    out = tmp_path / "program"
    command = [program, "run", path, "--out", out, "--quiet", "--threads", "2"]
    command += [word for key, value in changes.items() for word in ("--set", f"{key}={value}")]
    subprocess.run(command, check=True, capture_output=True)
    run = spunlaid.run(case)
    run.save(tmp_path / "python")
    tables = ["energy.parquet"] + (["laid.parquet"] if run.laid else ["end_node.parquet"])
    for table in tables:
        written = (out / table).read_bytes()
        assert written == (tmp_path / "python" / table).read_bytes(), table
    # Notes call a change by the way in which it was given.
    summary = json.loads((out / "summary.json").read_text().replace("--set run.", "Case: run."))
    # What it cost differs.
    assert {**summary, "performance": None} == {**run.summary, "performance": None}
    loaded = spunlaid.load(out)
    np.testing.assert_array_equal(loaded.shapes.positions_m[:, 0], run.shapes.positions_m[:, 0])
    # Steps that Python asks for are those of the run, too.
    flight = spunlaid.Flight(case, 3)
    flight.step_to(0.004)
    if run.end_node:
        np.testing.assert_array_equal(flight.positions[:, -1, 1], run.end_node["y_m"][:, 4])
