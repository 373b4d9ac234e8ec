"""The examples of docs/python.md, in the order of the page."""

from __future__ import annotations

import doctest
import re
from pathlib import Path

import pytest
from conftest import CASES, ROOT

PAGE = ROOT / "docs" / "python.md"
EXAMPLES = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)


def test_the_examples_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib").use("Agg")
    # As in a clone of the repository, but what is written goes elsewhere, and the web is a small one.
    (tmp_path / "cases").mkdir()
    for path in CASES.iterdir():
        (tmp_path / "cases" / path.name).symlink_to(path)
    web = (tmp_path / "cases" / "web_known.toml").read_text("utf-8")
    (tmp_path / "cases" / "web_known.toml").unlink()
    (tmp_path / "cases" / "web_known.toml").write_text(web.replace('"1 m"', '"0.3 m"'), "utf-8")
    monkeypatch.chdir(tmp_path)
    assert len(EXAMPLES) >= 7
    names: dict[str, object] = {}
    for example in EXAMPLES:
        if example.startswith(">>>"):
            session = doctest.DocTestParser().get_doctest(example, names, "docs/python.md", str(PAGE), 0)
            assert doctest.DocTestRunner().run(session, clear_globs=False).failed == 0
        else:
            exec(compile(example, str(PAGE), "exec"), names)  # noqa: S102 - the page is of this repository
