"""Arguments that several functions take."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from . import _spunlaid


def check_threads(threads: int | None) -> int | None:
    """A number of threads, if it is one; None for one of each processor."""
    if threads is not None and (not isinstance(threads, (int, np.integer)) or isinstance(threads, bool)):
        raise TypeError(f"threads must be a whole number, not {type(threads).__name__}")
    if threads is not None and not 1 <= threads <= 4096:
        raise ValueError(f"threads must be 1 to 4096, not {threads}")
    return None if threads is None else int(threads)


def split_source(
    source: str | os.PathLike[str] | Mapping[str, Any], changes: Mapping[str, Any] | None
) -> tuple[str | None, dict[str, Any]]:
    """The path of a file and the changes to it; for a dict of tables no path, and its values are the changes."""
    if isinstance(source, Mapping):
        return None, {**source, **changes_of(changes)}
    return os.fspath(source), changes_of(changes)


def changes_of(changes: Mapping[str, Any] | None) -> dict[str, Any]:
    """The keys that an argument `set` replaces."""
    if changes is not None and not isinstance(changes, Mapping):
        raise TypeError(f'set takes a dict, {{"air.velocity": "20 m/s"}}, not {type(changes).__name__}')
    return dict(changes or {})


def check_figures(
    figures: Sequence[str] | str | None, figure_width: str | float | None, out: str | os.PathLike[str] | None, example: str
) -> tuple[Sequence[str] | str | None, str | float | None]:
    """Formats and width of figures for the folder `out`. What could not be written is refused before a long computation.

    example: a folder that the message names
    """
    asked = (figures, figure_width)
    _spunlaid.check_figures(asked)
    if out is None and any(option is not None for option in asked):
        raise ValueError(f'figures are written to a folder; name one: out = "{example}"')
    return asked
