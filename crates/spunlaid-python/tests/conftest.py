"""What the tests share."""

from __future__ import annotations

import importlib
import os
import subprocess
from pathlib import Path

import pytest

import spunlaid

if os.environ.get("CI"):
    # There a package that is missing or broken is a failure, not a reason to leave tests out.
    pytest.importorskip = lambda name, *_, **__: importlib.import_module(name)  # type: ignore[assignment]

ROOT = Path(__file__).resolve().parents[3]
CASES = ROOT / "cases"


@pytest.fixture(scope="session")
def program() -> Path:
    """The program `spunlaid` of this repository."""
    path = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "spunlaid"
    if not path.exists():
        subprocess.run(["cargo", "build", "--release", "--locked"], cwd=ROOT, check=True)
    return path


@pytest.fixture(scope="session")
def short() -> spunlaid.Case:
    """A case of some milliseconds of computing time."""
    return spunlaid.Case.starter().with_(
        {"run.duration": 0.02, "run.time_step": "20 us", "run.replicates": 3, "run.output_interval": "1 ms", "run.spin_up": 0}
    )


@pytest.fixture(scope="session")
def fed() -> spunlaid.Case:
    """A fed fibre that lays some loops on its belt."""
    return spunlaid.Case.read(CASES / "spunbond.toml").with_(
        {"belt.distance": 0.1, "run.duration": 0.05, "run.replicates": 3, "run.spin_up": "10 ms"}
    )
