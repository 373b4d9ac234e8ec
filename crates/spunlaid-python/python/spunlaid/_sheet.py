"""Maps of basis weight: what webs that were laid and webs that were scanned have in common."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from shutil import rmtree
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import FolderError
from ._plot import plot_map, plot_unevenness
from ._results import Results, packed, unpack

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray


@dataclass(frozen=True)
class Kept:
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
            # Files of others stay.
            for name in {name.split("/")[0] for name in self.files}:
                if (place / name).is_dir():
                    rmtree(place / name)
                else:
                    (place / name).unlink(missing_ok=True)
        unpack(self.files, place)


class Sheet(Results):
    """A map of the basis weight of a web, and how uneven it is."""

    @property
    def map(self) -> NDArray[np.float64]:
        """Basis weight of every cell [kg/m²]: rows in machine direction × columns in cross direction."""
        return self._keep("map", lambda: self._computed.map)  # type: ignore[no-any-return]

    @property
    def cell(self) -> float:
        """Side of a cell of the map [m]."""
        return self._computed.cell  # type: ignore[no-any-return]

    def plot(self, what: str = "map", *, ax: Axes | None = None) -> Axes:
        """Draws with matplotlib, and returns the axes.

        what: `map`, the basis weight of every cell; or `cv`, how uneven the web is over the size of the patches, with intervals of
            95 % by chance
        ax: the axes to draw on; new ones by default
        """
        if what == "map":
            return plot_map(self.map, self.cell, ax)
        if what == "cv":
            return plot_unevenness(self._computed.patches, ax)
        raise ValueError(f'a web plots "map" or "cv", not {what!r}')

    def report(self) -> str:
        """The report, one page of HTML that works offline."""
        with TemporaryDirectory() as folder:
            self.save(Path(folder) / "web")
            return (Path(folder) / "web" / "report.html").read_text("utf-8")

    def __reduce__(self) -> tuple[Any, ...]:
        computed, files = self._computed, packed(self.save)
        kept = Kept(computed.name, computed.summary, computed.cell, computed.map, computed.patches, self.notes, files)
        return type(self), (kept,)

    def __repr__(self) -> str:
        rows, columns = self.map.shape
        weight = 1e3 * float(self.map.mean())
        size = f"{columns * self.cell:.3g} m × {rows * self.cell:.3g} m"
        return f"<{type(self).__name__} {self._computed.name}: {weight:.4g} g/m², {size}>"
