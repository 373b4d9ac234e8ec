"""Webs of many filaments."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import _spunlaid
from ._progress import Progress, shown
from ._run import _threads

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from numpy.typing import NDArray


class Web:
    """A web that was laid. `spunlaid.web` returns it; a notebook shows its report."""

    def __init__(self, laid: _spunlaid.LaidWeb) -> None:
        self._laid = laid
        self._map: Any = None

    @property
    def summary(self) -> dict[str, Any]:
        """What `summary.json` of a results folder holds."""
        return json.loads(self._laid.summary)  # type: ignore[no-any-return]

    @property
    def map(self) -> NDArray[np.float64]:
        """Basis weight of every cell [kg/m²]: rows in machine direction × columns in cross direction."""
        if self._map is None:
            self._map = self._laid.map
        return self._map  # type: ignore[no-any-return]

    @property
    def cell(self) -> float:
        """Side of a cell of the map [m]."""
        return self._laid.cell

    @property
    def patches(self) -> dict[str, NDArray[np.float64]]:
        """How uneven the web is over square patches, a number for each size `patch_m` [m]: `cv` of the map with its
        `cv_standard_error` by chance, its `cv_flight_error` by the few fibres that were flown, its `cv_model_error` by the
        surrogate in place of the flown curves, and its `cv_whole_error` by all of them; `cv_single_fibres` expected
        from single fibres of the kind that was laid; `cv_flown` expected from the flown curves, and `cv_surrogate` expected
        from the surrogate, each with its standard error; `cv_independent` expected from the same filaments of a web in one air
        if each had an air of its own, and `cv_pairs` from these and from what pairs of filaments have in common; and `cv_straight_fibres`
        of straight fibres in all directions of the same mass.
        What is not known is NaN: without flown fibres, `cv_flown`, the model error and the whole error."""
        return self._laid.patches

    @property
    def neighbours(self) -> dict[str, NDArray[np.float64]]:
        """How the filaments of a web in one air come down together, a number for each distance `distance_m` of two inlets in
        cross direction [m]: `correlation_md` and `correlation_cd` of the places where both come down at equal fed length, each with
        its standard error, `correlation_md_se` and `correlation_cd_se`. One layer follows the other. Empty arrays for independent
        filaments; an error that is not known is NaN."""
        import numpy as np

        entries = self.summary.get("neighbours", {}).get("cd", [])
        names = ["distance_m", "correlation_md", "correlation_md_se", "correlation_cd", "correlation_cd_se"]
        return {name: np.array([entry[name] for entry in entries], dtype=float) for name in names}

    @property
    def notes(self) -> list[str]:
        """Notes and warnings."""
        return self._laid.notes

    def plot(self, what: str = "map", *, ax: Axes | None = None) -> Axes:
        """Draws with matplotlib, and returns the axes.

        what: `map`, the basis weight of every cell; or `cv`, how uneven the web is over the size of the patches, with intervals of
            95 % by chance
        ax: the axes to draw on; new ones by default
        """
        from ._plot import of_web

        return of_web(self, what, ax)

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        force: bool = False,
        figures: Sequence[str] | str | None = None,
        figure_width: str | float | None = None,
    ) -> None:
        """Writes the folder that `spunlaid web` writes.

        force: whether results that the folder holds are replaced.
        figures: the formats of the figures, `["pdf", "png"]`; SVG and PNG if it is left out
        figure_width: their width in print, `"one-column"`, `"two-columns"`, `"90 mm"` or in metres; PNG then has 300 dpi
        """
        self._laid.save(os.fspath(path), force, figures, figure_width)

    def report(self) -> str:
        """The report, one page of HTML that works offline."""
        from pathlib import Path
        from tempfile import TemporaryDirectory

        with TemporaryDirectory() as folder:
            self.save(Path(folder) / "web")
            return (Path(folder) / "web" / "report.html").read_text("utf-8")

    def __repr__(self) -> str:
        rows, columns = self.map.shape
        weight = 1e3 * float(self.map.mean())
        return f"<Web {self._laid.name}: {weight:.4g} g/m², {columns * self.cell:.3g} m × {rows * self.cell:.3g} m>"

    def _repr_html_(self) -> str:
        from html import escape

        page = escape(self.report(), quote=True)
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 720px; border: 1px solid #ccc"></iframe>'


def web(
    web: str | os.PathLike[str] | Mapping[str, Any],
    *,
    set: Mapping[str, Any] | None = None,  # noqa: A002 - the word of the program
    advice: bool = False,
    threads: int | None = None,
    progress: Progress = None,
) -> Web:
    """Lays a web of many filaments and says how even it is: the same bits as `spunlaid web`.

    web: the path of the file of a web; or a dict of its tables, `{"fibre": {...}, "laydown": {...}, "line": {...}, "web":
        {...}}`, with texts that have a unit, and numbers in SI units. `spunlaid keys --web` lists the keys
    set: keys that replace those of the file, `{"line.belt_speed": 5.0}`
    advice: whether to try what settings of the line would make it more even at the same basis weight; `summary["advice"]` then says it
    threads: number of threads, by default one for each processor; the results do not depend on it
    progress: None, True, False, or a function that gets the parts done and their number
    """
    changes = dict(set or {})
    path = None
    if isinstance(web, Mapping):
        changes = {**web, **changes}
    else:
        path = os.fspath(web)
    with shown(progress, "web") as show:
        return Web(_spunlaid.lay_web(path, changes, advice, _threads(threads), show))
