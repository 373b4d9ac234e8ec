"""The notebooks run from their first cell to the last: as in Jupyter, but in the process of the tests."""

from __future__ import annotations

import json
import re
from pathlib import Path
from types import ModuleType

import pytest
from conftest import CASES, ROOT

pytest.importorskip("scipy")
matplotlib = pytest.importorskip("matplotlib")
shells = pytest.importorskip("IPython.core.interactiveshell")


def made_quicker(cell: str) -> str:
    """The same cell with webs of 0.15 m and flights of half a second: the same code in less time."""
    cell = re.sub(r'("web\.(?:width|length)": )(?:0\.[3-9]|"0\.[3-9] m")', r"\g<1>0.15", cell)
    return cell.replace('"run.duration": 1.0', '"run.duration": 0.5')


@pytest.mark.parametrize("path", sorted((ROOT / "notebooks").glob("*.ipynb")), ids=lambda path: path.stem)
def test_a_notebook_runs(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    matplotlib.use("Agg")
    # As in a clone of the repository, but what is written goes elsewhere.
    (tmp_path / "cases").symlink_to(CASES, target_is_directory=True)
    (tmp_path / "notebooks").mkdir()
    monkeypatch.chdir(tmp_path / "notebooks")
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path))
    # In a module of its own: processes that other tests start would look for `__main__`.
    shell = shells.InteractiveShell(user_module=ModuleType("notebook"))
    for cell in json.loads(path.read_text("utf-8"))["cells"]:
        if cell["cell_type"] == "code":
            shell.run_cell(made_quicker("".join(cell["source"]))).raise_error()
            for number in matplotlib.pyplot.get_fignums():
                matplotlib.pyplot.figure(number).canvas.draw()
            matplotlib.pyplot.close("all")
