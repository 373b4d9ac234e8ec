"""The files of the package import one another one way only."""

from __future__ import annotations

import ast
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

FILES = Path(__file__).resolve().parents[1] / "python" / "spunlaid"
COMPILED = "_spunlaid"


def imported(source: str, files: set[str]) -> set[str]:
    """The files of the package that a source imports: wherever the import stands, also in a function or for types only."""
    names: list[str] = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names += [name.name for name in node.names]
        elif isinstance(node, ast.ImportFrom):
            module = ".".join(filter(None, ["spunlaid" if node.level else None, node.module]))
            names += [f"{module}.{name.name}" for name in node.names]
    parts = [name.split(".") for name in names if name.split(".")[0] == "spunlaid"]
    # Whatever is no file comes from the package as such.
    return {part[1] if len(part) > 1 and part[1] in files | {COMPILED} else "__init__" for part in parts} - {COMPILED}


def order(sources: dict[str, str]) -> list[str]:
    """The files from left to right; each imports only from those to its left.

    Raises CycleError if there is no such order.
    """
    files = set(sources)
    return list(TopologicalSorter({name: imported(source, files) for name, source in sources.items()}).static_order())


def test_imports_run_one_way() -> None:
    found = order({path.stem: path.read_text("utf-8") for path in FILES.glob("*.py")})
    assert found.index("_plot") < found.index("_run") < found.index("__init__")


@pytest.mark.parametrize(
    "back",
    [
        "from ._a import x",
        "from . import _a",
        "import spunlaid._a",
        "from spunlaid import Case",
        "def f():\n    from ._a import x",
        "if TYPE_CHECKING:\n    from ._a import X",
    ],
)
def test_a_circle_is_found(back: str) -> None:
    sources = {"__init__": "from ._a import z", "_a": "from ._b import y", "_b": "from . import _c", "_c": "import os\n"}
    assert order(sources) == ["_c", "_b", "_a", "__init__"]
    with pytest.raises(CycleError):
        order({**sources, "_c": back})
