"""Maps of basis weight: what webs that were laid and webs that were scanned have in common."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._plot import plot_map, plot_unevenness
from ._results import Kept, Results
from ._spunlaid import Computed, patch_numbers

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray


class Sheet(Results):
    """A map of the basis weight of a web, and its CV.

    weights: the map of one that was pickled
    """

    _scanned = False

    def __init__(self, computed: Computed | Kept, weights: NDArray[np.float64] | None = None) -> None:
        super().__init__(computed)
        if weights is not None:
            weights.setflags(write=False)
            self._kept["map"] = weights

    @property
    def map(self) -> NDArray[np.float64]:
        """Basis weight of every cell [kg/m²]: rows in machine direction × columns in cross direction."""
        return self._keep("map", lambda: self._computed.map)  # type: ignore[no-any-return, union-attr]

    @property
    def cell(self) -> float:
        """Side of a cell of the map [m]."""
        return self.summary["web"]["cell_m"]  # type: ignore[no-any-return]

    def _patches(self) -> dict[str, NDArray[np.float64]]:
        patches = self.summary["web"]["patches"]
        columns = {name: [patch.get(name) for patch in patches] for name in ("patch_m", *patch_numbers()[self._scanned])}
        ends = [patch.get("cv_interval") or (None, None) for patch in patches]
        columns |= {name: [pair[end] for pair in ends] for end, name in enumerate(("cv_low", "cv_high"))}
        # The older name of these.
        return {name.replace("one_fibre", "single_fibres"): np.array(of, dtype=float) for name, of in columns.items()}

    def plot(self, what: str = "map", *, ax: Axes | None = None) -> Axes:
        """Draws with matplotlib, and returns the axes.

        what: `map`, the basis weight of every cell; or `cv`, its CV over the size of the patches, with 95 %
            confidence intervals
        ax: the axes to draw on; new ones by default
        """
        if what == "map":
            return plot_map(self.map, self.cell, ax)
        if what == "cv":
            return plot_unevenness(self._patches(), ax)
        raise ValueError(f'a web plots "map" or "cv", not {what!r}')

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._packed(), self.map)

    def __repr__(self) -> str:
        rows, columns = self.map.shape
        weight = 1e3 * float(self.map.mean())
        size = f"{columns * self.cell:.3g} m × {rows * self.cell:.3g} m"
        return f"<{type(self).__name__} {self._computed.name}: {weight:.4g} g/m², {size}>"
