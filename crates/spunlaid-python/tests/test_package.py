"""The package as such: types, help, import, memory."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import spunlaid

PACKAGE = Path(__file__).resolve().parents[1]


# What `mypy` and `python -m mypy.stubtest spunlaid._spunlaid` do, with the types of NumPy read once for both.
# It ends at once, as letting go of all that was read would take half as long again.
TYPES = r"""
import os
from mypy import build, main, stubtest

sources, options = main.process_options(["--no-incremental", "--config-file", "pyproject.toml", "python/spunlaid"])
options.pos_only_special_methods = False
checked = build.build(sources, options)
stubtest._all_stubs = checked.files
errors = checked.errors or [error.get_description() for error in stubtest.test_module("spunlaid._spunlaid")]
print(*errors, sep="\n", flush=True)
os._exit(bool(errors))
"""


def test_types_hold_and_the_stub_has_what_the_module_has() -> None:
    pytest.importorskip("mypy.stubtest")
    checked = subprocess.run([sys.executable, "-c", TYPES], capture_output=True, text=True, cwd=PACKAGE)
    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_everything_has_help() -> None:
    for name in spunlaid.__all__:
        thing = getattr(spunlaid, name)
        if callable(thing):
            assert (thing.__doc__ or "").strip(), name
            for member, value in vars(thing).items() if isinstance(thing, type) else ():
                if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                    assert getattr(thing, member).__doc__, f"{name}.{member}"
    with pytest.raises(AttributeError, match="nonsense"):
        spunlaid.nonsense  # noqa: B018


def test_import_loads_nothing_heavy() -> None:
    code = "import sys, spunlaid; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert "spunlaid" in loaded
    heavy = {"numpy", "pandas", "xarray", "distributed", "dask", "scipy", "matplotlib", "tqdm"}
    assert heavy.isdisjoint(loaded), heavy.intersection(loaded)


HUNDREDS_OF_RUNS = """
import gc, sys
import psutil, spunlaid

case = spunlaid.Case.starter().with_(
    {"fibre.element_length": "100 mm", "run.duration": 0.004, "run.time_step": "20 us", "run.replicates": 2}
    | {"run.output_interval": "0.1 ms", "run.spin_up": 0}
)

def several(times):
    for number in range(times):
        # The checks take most of the time.
        run = spunlaid.run(case, threads=2, check_step=number % 10 == 0)
        # All that is made of it is let go of, too.
        assert run.end_node and run.energy and run.measures and run.shapes and run.curves
        try:
            case.with_({"air.velocity": "x"})
        except spunlaid.CaseError:
            pass

def state():
    gc.collect()
    return psutil.Process().memory_info().rss, sys.getallocatedblocks(), sys.getrefcount(case)

several(100)
before = state()
several(300)
print(*(after - first for after, first in zip(state(), before)))
"""


def test_memory_and_references_stay_flat_over_hundreds_of_runs() -> None:
    """In a process of its own: what other tests have left to the allocator moves by more than is asked here."""
    pytest.importorskip("psutil")
    reported = subprocess.run([sys.executable, "-c", HUNDREDS_OF_RUNS], capture_output=True, text=True, check=True).stdout
    memory, blocks, references = map(int, reported.split())
    assert references == 0
    assert abs(blocks) < 300, "less than a block for each run"
    # A run of this case holds 100 kB; three hundred kept ones would be 30 MB.
    assert memory < 3e6
