"""Drag laws that are given as tables: files of this process, from which everything reads them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any
from zlib import crc32

import numpy as np

from ._results import Place

COLUMNS = ("reynolds", "coefficient")
LAWS = ("drag.across", "drag.along")

_place: Place | None = None


def law_file(key: str, table: Any) -> str:
    """The path of a file with a table of Reynolds numbers and drag coefficients.

    key: what a message calls it
    table: n x 2 numbers; or a dict or a frame with the columns `reynolds` and `coefficient`
    """
    names = getattr(getattr(table, "dtype", None), "names", None)
    try:
        if isinstance(table, Mapping) or hasattr(table, "columns") or names:
            rows = np.column_stack([np.asarray(table[name], dtype=float) for name in COLUMNS])
        else:
            rows = np.asarray(table, dtype=float)
    except (KeyError, TypeError, ValueError, IndexError) as error:
        raise _no_law(key) from error
    if rows.ndim != 2 or rows.shape[1] != 2:
        raise _no_law(key)
    return kept(",".join(COLUMNS) + "\n" + "".join(f"{float(re)!r},{float(c)!r}\n" for re, c in rows))


def kept(text: str) -> str:
    """The path of a file of this process with this text."""
    global _place  # noqa: PLW0603 - one folder for the process, made when it is needed
    if _place is None or not _place.path.exists():
        _place = Place()
    path = _place.path / f"drag_law_{crc32(text.encode()):08x}.csv"
    path.write_text(text, "utf-8")
    return str(path)


def texts_of(values: list[str]) -> dict[str, str]:
    """The texts of those values that are such files, for a pickle: by the values."""
    paths = {value: Path(value.strip('"')) for value in values}
    ours = {value: path for value, path in paths.items() if _place is not None and path.parent == _place.path}
    return {value: path.read_text("utf-8") for value, path in ours.items()}


def _no_law(key: str) -> ValueError:
    return ValueError(
        f"{key} takes the name of a law, the path of a file, or a table: n x 2 Reynolds numbers and coefficients, or a dict or"
        f" a frame with the columns {' and '.join(COLUMNS)}"
    )
