"""Progress of longer work, shown with tqdm where it is installed."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable, Iterator
from importlib.util import find_spec

Progress = bool | Callable[[int, int], object] | None
"""None shows a bar in notebooks and terminals, True always, False never; a function gets parts done and their number."""


@contextlib.contextmanager
def shown(progress: Progress, label: str) -> Iterator[Callable[[int, int], object] | None]:
    """A function that shows progress, or None."""
    if callable(progress):
        yield progress
        return
    if progress is None:
        progress = "ipykernel" in sys.modules or bool(sys.stderr and sys.stderr.isatty())
    tqdm = _tqdm() if progress else None
    if tqdm is None:
        yield None
        return
    # Short work shows nothing.
    with tqdm(desc=label, total=100, unit="%", delay=2, leave=False, bar_format="{l_bar}{bar}| {elapsed}<{remaining}") as bar:

        def show(done: int, of: int) -> None:
            bar.update(round(100 * done / of, 1) - bar.n if of else 0)

        yield show


def _tqdm() -> type | None:
    """The bar that fits where Python runs; None without tqdm."""
    # An import that failed ends here, so that errors of the work itself do not name it.
    try:
        # Without its widgets, the bar for notebooks would warn.
        if "ipykernel" in sys.modules and find_spec("ipywidgets"):
            from tqdm.notebook import tqdm
        else:
            from tqdm import tqdm
    except ImportError:
        return None
    bar: type = tqdm
    return bar
