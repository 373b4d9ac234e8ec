"""The turbulent air of a case, at any time and place."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from . import _spunlaid
from ._case import CaseLike, case_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


class Air:
    """The air of a case in a field of eddies in space: `Air(case)`, `Air(case, seed=7, replicate=2)`.

    The case needs `air.lateral = "von-karman"`. The same seed and replicate give the air of a fibre of the case.

        air = spunlaid.Air(case)
        y = np.linspace(-0.05, 0.05, 101)
        v = air.at(0.01, 0.2, y, 0.0)[:, 1]        # velocity along y on a line across the flow [m/s]
    """

    def __init__(self, case: CaseLike, seed: int | None = None, replicate: int = 1) -> None:
        if isinstance(replicate, bool) or not isinstance(replicate, (int, np.integer)) or replicate < 1:
            raise ValueError(f"replicate must be a whole number from 1, not {replicate!r}")
        case = case_of(case)
        self._case = case if seed is None else case.with_({"run.seed": seed})
        self._air = _spunlaid.AirSampler(self._case, int(replicate) - 1)

    def at(self, t: ArrayLike, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> NDArray[np.float64]:
        """Velocity of the air [m/s]. Numbers and arrays of any shapes that fit together; the result has one more axis, with the
        velocity along x, y and z.

        :param t: time from the start of a run [s]
        :param x: distance from the inlet or the root, along gravity [m]
        :param y: place in machine direction [m]
        :param z: place in cross direction [m]
        """
        t, x, y, z = np.broadcast_arrays(*(np.asarray(values, dtype=np.float64) for values in (t, x, y, z)))
        places = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
        return self._air.velocities(t.ravel(), places).reshape(*t.shape, 3)

    @property
    def extent(self) -> tuple[float, float]:
        """After what distances the turbulence repeats itself along y and z [m]."""
        return self._air.extent

    @property
    def case(self) -> _spunlaid.Case:
        """The case."""
        return self._case

    def __repr__(self) -> str:
        y, z = self.extent
        return f"<Air of {self._case.name}, repeated after {y:.3g} m along y and {z:.3g} m along z>"
