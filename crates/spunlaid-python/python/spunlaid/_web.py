"""Webs of many filaments."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _spunlaid
from ._arguments import check_threads, split_source
from ._progress import Progress, shown
from ._results import Kept
from ._sheet import Sheet

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Web(Sheet):
    """A web that was laid. `spunlaid.web` returns it; a notebook shows its report."""

    @property
    def patches(self) -> dict[str, NDArray[np.float64]]:
        """CV of the web over square patches, a number for each size `patch_m` [m]: `cv` of the map with its
        sampling error `cv_standard_error`, the error of the sample of filaments `cv_sample_error`,
        and its `cv_total_error` by both; `cv_single_fibres` expected of known numbers, from single fibres, with its standard
        error; `cv_independent` expected from the same filaments in independent turbulence, by their
        surrogate; and `cv_straight_fibres` of straight fibres in all directions of the same mass.
        What is not known is NaN: without simulated fibres, the error of the sample and the total standard error."""
        return self._patches()

    @property
    def neighbours(self) -> dict[str, NDArray[np.float64]]:
        """How the filaments of a web in shared turbulence land together, a number for each distance `distance_m` of two inlets in
        cross direction [m]: `correlation_md` and `correlation_cd` of the positions where both land at equal fed length, each with
        its standard error, `correlation_md_se` and `correlation_cd_se`. One layer follows the other. Empty arrays for independent
        filaments; an error that is not known is NaN."""
        entries = self.summary.get("neighbours", {}).get("cd", [])
        names = ["distance_m", "correlation_md", "correlation_md_se", "correlation_cd", "correlation_cd_se"]
        return {name: np.array([entry[name] for entry in entries], dtype=float) for name in names}

    @property
    def curtains(self) -> list[dict[str, Any]]:
        """What the filaments of each layer do to their air, if its case is known, as `summary["layers"]` has it: `filaments_per_m`,
        `mass_loading`, `momentum_loading`, `eddy_damping`, `heat_w_per_m`, …; and in `places`, where filaments were simulated, an array of each
        number from the inlet to the belt: `x_m`, `force_n_per_m` with its standard error `force_n_per_m_se`, `share_of_momentum`,
        `change_of_velocity` and `pressure_pa`. A number that is not known is None, in an array NaN."""
        return [_with_columns(layer["curtain"]) for layer in self.summary["layers"] if "curtain" in layer]

    def specification(self) -> bytes:
        """The specification sheet, one page of PDF: every number of the web and of its fabric with its error, as `spunlaid web --sheet`
        writes it."""
        if isinstance(self._computed, Kept):
            raise ValueError("a web that has been pickled has no specification sheet; ask for it where it was laid")
        return self._computed.specification()  # type: ignore[return-value]


def _with_columns(curtain: dict[str, Any]) -> dict[str, Any]:
    """The load of a curtain, its places as arrays."""
    columns: dict[str, list[Any]] = {}
    for place in curtain.get("places", []):
        for name, number in place.items():
            mean, *error = number.values() if isinstance(number, dict) else [number]
            columns.setdefault(name, []).append(mean)
            if error:
                columns.setdefault(f"{name}_se", []).append(error[0])
    places = {name: np.array(numbers, dtype=float) for name, numbers in columns.items()}
    return {**curtain, "places": places}


def web(
    web: str | os.PathLike[str] | Mapping[str, Any],
    *,
    set: Mapping[str, Any] | None = None,  # noqa: A002 - the word of the program
    advice: bool = False,
    assumed_values: bool = True,
    threads: int | None = None,
    progress: Progress = None,
) -> Web:
    """Lays a web of many filaments and estimates its CV: bit-identical to `spunlaid web`.

    web: the path of the file of a web; or a dict of its tables, `{"fibre": {...}, "laydown": {...}, "line": {...}, "web":
        {...}}`, with texts that have a unit, and numbers in SI units, also with the tables of the simulated filament, `{"air":
        {...}, "belt": {...}, ...}`. `spunlaid keys --web` and `spunlaid keys` list the keys
    set: keys that replace those of the file, `{"line.belt_speed": 5.0}` or `{"belt.distance": "0.4 m"}`
    advice: whether to try which settings of the line would make it more uniform at the same basis weight; see `summary["advice"]`
    assumed_values: whether a web whose file names assumed values (`web.assumed`) is also tried with half and twice of each;
        `summary["assumed_values"]` then has the CVs
    threads: number of threads, by default one for each processor; the results do not depend on it
    progress: None, True, False, or a function that gets the parts done and their number
    """
    path, changes = split_source(web, set)
    with shown(progress, "web") as show:
        return Web(_spunlaid.lay_web(path, changes, advice, assumed_values, check_threads(threads), show))
