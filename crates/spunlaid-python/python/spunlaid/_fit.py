"""From a scanned web back to the settings of the line."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import _spunlaid
from ._arguments import changes_of, check_figures, check_threads
from ._plot import plot_fit
from ._progress import Progress, shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Fit:
    """Values of keys whose webs are like a scan. `spunlaid.fit` returns it."""

    def __init__(self, text: str, sentences: list[str]) -> None:
        self.summary: dict[str, Any] = json.loads(text)
        """What `fit.json` of a results folder holds."""
        self.sentences = sentences
        """What the fit says: whether such webs can look like the scan, and what the scan does not know."""

    @property
    def values(self) -> dict[str, float]:
        """The value of each key, in SI units."""
        return {key["key"]: key["value"] for key in self.summary["keys"]}

    @property
    def intervals(self) -> dict[str, tuple[float, float] | None]:
        """The 95 % confidence interval of each key, in SI units; None where none can be given."""
        keys = self.summary["keys"]
        return {key["key"]: None if key["interval"] is None else tuple(key["interval"]) for key in keys}

    def plot(self, *, ax: Axes | None = None) -> Axes:
        """Draws CV over the side of the patches with matplotlib, of the scan and of the simulated webs, and returns the axes.

        ax: the axes to draw on; new ones by default
        """
        return plot_fit(self.summary["numbers"], ax)

    def __repr__(self) -> str:
        values = ", ".join(f"{key} = {value:.4g}" for key, value in self.values.items())
        return f"<Fit to {self.summary['scan']}: {values}>"


def fit(
    web: str | os.PathLike[str],
    to: str | os.PathLike[str],
    vary: Iterable[str] | Mapping[str, tuple[Any, Any] | None],
    *,
    spectrum: bool = False,
    webs: int = 20,
    set: Mapping[str, Any] | None = None,  # noqa: A002 - the word of the program
    out: str | os.PathLike[str] | None = None,
    figures: Sequence[str] | str | None = None,
    figure_width: str | float | None = None,
    threads: int | None = None,
    progress: Progress = None,
) -> Fit:
    """Finds the values of some keys whose webs have the CV of a scan: bit-identical to `spunlaid fit`.

    web: the path of the file of a web
    to: the results folder of the scan, from `spunlaid analyse`; or of a web
    vary: one to four keys, `["line.slot_gap", "laydown.noise"]`; or a dict of their ranges, `{"line.slot_gap": ("5 mm", "40 mm"),
        "laydown.noise": None}`, with texts that have a unit, and numbers in SI units
    spectrum: whether the spectrum is compared too
    webs: simulated webs of each trial
    set: keys that replace those of the file, `{"line.belt_speed": 5.0}`
    out: the folder of the results. The same call continues there when it has been interrupted; without a folder, nothing is kept
    figures, figure_width: how the figures in the folder are written, as of `Run.save`
    threads: number of threads, by default one for each processor; the results do not depend on it
    progress: None, True, False, or a function that gets the webs of a trial that are laid and their number
    """
    named = [vary] if isinstance(vary, str) else vary
    ranges = dict(named) if isinstance(named, Mapping) else dict.fromkeys(named)
    ends = [{key: pair[end] for key, pair in ranges.items() if pair is not None} for end in (0, 1)]
    folder = None if out is None else os.fspath(out)
    asked = check_figures(figures, figure_width, out, "results/fit")
    with shown(progress, "fit") as show:
        text, sentences = _spunlaid.find_fit(
            os.fspath(web),
            os.fspath(to),
            list(ranges),
            ends[0],
            ends[1],
            changes_of(set),
            spectrum,
            webs,
            folder,
            asked,
            check_threads(threads),
            show,
        )
    return Fit(text, sentences)

