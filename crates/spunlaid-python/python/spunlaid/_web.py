"""Webs of many filaments."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from shutil import rmtree
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _spunlaid
from ._arguments import check_threads, split_source
from ._errors import FolderError
from ._plot import plot_map, plot_unevenness
from ._progress import Progress, shown
from ._results import Results

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray


@dataclass(frozen=True)
class _Kept:
    """What a web that has been pickled has in place of the compiled one: its values, and the files of its folder."""

    name: str
    summary: str
    cell: float
    map: NDArray[np.float64]
    patches: dict[str, NDArray[np.float64]]
    notes: list[str]
    files: dict[str, bytes]

    def __post_init__(self) -> None:
        self.map.setflags(write=False)

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        # A pickled array comes back as one that can be written to.
        self.__post_init__()

    def save(self, path: str, force: bool, figures: tuple[Any, Any]) -> None:
        if figures != (None, None):
            raise ValueError("a web that has been pickled has its figures as SVG and PNG; draw others where it was laid")
        place = Path(path)
        if place.exists() and any(place.iterdir()):
            if not force:
                raise FolderError(f"{place}: holds results already; name another folder, or pass force=True")
            rmtree(place)
        for name, content in self.files.items():
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            (place / name).write_bytes(content)


class Web(Results):
    """A web that was laid. `spunlaid.web` returns it; a notebook shows its report."""

    _computed: _spunlaid.LaidWeb | _Kept

    @property
    def map(self) -> NDArray[np.float64]:
        """Basis weight of every cell [kg/m²]: rows in machine direction × columns in cross direction."""
        return self._keep("map", lambda: self._computed.map)  # type: ignore[no-any-return]

    @property
    def cell(self) -> float:
        """Side of a cell of the map [m]."""
        return self._computed.cell

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
        return self._computed.patches

    @property
    def neighbours(self) -> dict[str, NDArray[np.float64]]:
        """How the filaments of a web in one air come down together, a number for each distance `distance_m` of two inlets in
        cross direction [m]: `correlation_md` and `correlation_cd` of the places where both come down at equal fed length, each with
        its standard error, `correlation_md_se` and `correlation_cd_se`. One layer follows the other. Empty arrays for independent
        filaments; an error that is not known is NaN."""
        entries = self.summary.get("neighbours", {}).get("cd", [])
        names = ["distance_m", "correlation_md", "correlation_md_se", "correlation_cd", "correlation_cd_se"]
        return {name: np.array([entry[name] for entry in entries], dtype=float) for name in names}

    def plot(self, what: str = "map", *, ax: Axes | None = None) -> Axes:
        """Draws with matplotlib, and returns the axes.

        what: `map`, the basis weight of every cell; or `cv`, how uneven the web is over the size of the patches, with intervals of
            95 % by chance
        ax: the axes to draw on; new ones by default
        """
        if what == "map":
            return plot_map(self.map, self.cell, ax)
        if what == "cv":
            return plot_unevenness(self.patches, ax)
        raise ValueError(f'a web plots "map" or "cv", not {what!r}')

    def report(self) -> str:
        """The report, one page of HTML that works offline."""
        with TemporaryDirectory() as folder:
            self.save(Path(folder) / "web")
            return (Path(folder) / "web" / "report.html").read_text("utf-8")

    def __reduce__(self) -> tuple[Any, ...]:
        with TemporaryDirectory() as place:
            self.save(Path(place) / "web")
            found = sorted(path for path in (Path(place) / "web").rglob("*") if path.is_file())
            files = {path.relative_to(Path(place) / "web").as_posix(): path.read_bytes() for path in found}
        computed = self._computed
        kept = _Kept(computed.name, computed.summary, computed.cell, computed.map, computed.patches, self.notes, files)
        return Web, (kept,)

    def __repr__(self) -> str:
        rows, columns = self.map.shape
        weight = 1e3 * float(self.map.mean())
        return f"<Web {self._computed.name}: {weight:.4g} g/m², {columns * self.cell:.3g} m × {rows * self.cell:.3g} m>"


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
    set: keys that replace those of the file, `{"line.belt_speed": 5.0}`; and those of the case that it flies, `{"belt.distance": "0.4 m"}`
    advice: whether to try what settings of the line would make it more even at the same basis weight; `summary["advice"]` then says it
    threads: number of threads, by default one for each processor; the results do not depend on it
    progress: None, True, False, or a function that gets the parts done and their number
    """
    path, changes = split_source(web, set)
    with shown(progress, "web") as show:
        return Web(_spunlaid.lay_web(path, changes, advice, check_threads(threads), show))
