"""The examples of docs/python.md, in the order of the page."""

from __future__ import annotations

import doctest
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import CASES, ROOT

PAGE = ROOT / "docs" / "python.md"
EXAMPLES = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)


def test_the_examples_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib").use("Agg")
    # As in a clone of the repository, but what is written goes elsewhere, the web is small and the run has long steps.
    (tmp_path / "cases").mkdir()
    for path in CASES.iterdir():
        (tmp_path / "cases" / path.name).symlink_to(path)
    steps = ('time_step = "1 µs"', 'scheme = "implicit-tension"')
    for name, change in {"web_known.toml": ('"1 m"', '"0.15 m"'), "table1.toml": steps}.items():
        text = (CASES / name).read_text("utf-8")
        assert change[0] in text, name
        (tmp_path / "cases" / name).unlink()
        (tmp_path / "cases" / name).write_text(text.replace(*change), "utf-8")
    monkeypatch.chdir(tmp_path)
    assert len(EXAMPLES) >= 7
    names: dict[str, object] = {}
    for example in EXAMPLES:
        if example.startswith(">>>"):
            session = doctest.DocTestParser().get_doctest(example, names, "docs/python.md", str(PAGE), 0)
            assert doctest.DocTestRunner().run(session, clear_globs=False).failed == 0
        else:
            exec(compile(example, str(PAGE), "exec"), names)  # noqa: S102 - the page is of this repository


def test_the_examples_have_types(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    page = tmp_path / "examples.py"
    page.write_text("\n".join(example for example in EXAMPLES if not example.startswith(">>>")), "utf-8")
    settings = ROOT / "crates" / "spunlaid-python" / "pyproject.toml"
    words = [sys.executable, "-m", "mypy", "--config-file", str(settings), "--cache-dir", str(tmp_path / "cache"), str(page)]
    checked = subprocess.run(words, capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout + checked.stderr
