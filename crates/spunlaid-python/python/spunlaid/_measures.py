"""What is measured of every fibre of a run, over the replicates."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._optional import needed

if TYPE_CHECKING:
    import pandas
    from numpy.typing import NDArray


class Measure(NamedTuple):
    """A number that is measured of every fibre, over the replicates; in SI units."""

    column: str
    """Name with its unit, `amplitude_y_m`."""
    label: str
    meaning: str
    group: str
    unit: str
    """Its unit as the CF conventions write it, `m` or `m2/Hz`; `1` of a plain number."""
    mean: float
    """Mean over the replicates."""
    standard_error: float
    """Standard error of the mean, sampling error alone; NaN from a single replicate."""
    error: float
    """Its total standard error, with what the checks of step and mesh found beyond their limit; NaN if not known."""
    shown: float
    """The value of all replicates in reports: the mean, the median or the largest value."""
    values: NDArray[np.float64]
    """The value of each replicate; NaN where it is not defined."""

    def __float__(self) -> float:
        return self.mean

    def __repr__(self) -> str:
        error = "" if np.isnan(self.error) else f" ± {self.error:.2g}"
        return f"<{self.column}: {self.mean:.6g}{error}>"


class Curve(NamedTuple):
    """A curve that is measured of every fibre, over the replicates; in SI units."""

    column: str
    label: str
    meaning: str
    group: str
    unit: str
    """Unit of the values as the CF conventions write it, `m` or `m2/Hz`; `1` of plain numbers."""
    at: NDArray[np.float64]
    """Distance from the root [m], time [s] or frequency [Hz]."""
    mean: NDArray[np.float64]
    standard_error: NDArray[np.float64]
    """NaN from a single replicate."""
    largest: NDArray[np.float64]
    """The largest value of any replicate."""

    def __repr__(self) -> str:
        return f"<{self.column}: a curve of {len(self.at)} points>"


class Shapes(NamedTuple):
    """Whole fibres at some of the recorded instants, of the first replicates."""

    time_s: NDArray[np.float64]
    """Times [s]."""
    positions_m: NDArray[np.float64]
    """Replicates × times × nodes × 3 [m]; NaN where a fed fibre has fewer nodes."""


def unknown_measure(column: str, known: Iterable[str]) -> KeyError:
    """The error of a measure that is not there."""
    from difflib import get_close_matches

    known = list(known)
    near = get_close_matches(str(column), known, n=1)
    hint = f"did you mean {near[0]!r}?" if near else "there are " + ", ".join(known)
    return KeyError(f"no measure {column!r} here; {hint}")


class MeasureMapping(Mapping[str, Any]):
    """Numbers or curves by their columns."""

    def __init__(self, kind: Any, described: list[dict[str, Any]]) -> None:
        self._of = {of["column"]: kind(**{name: of[name] for name in kind._fields}) for of in described}

    def __getitem__(self, column: str) -> Any:
        try:
            return self._of[column]
        except KeyError:
            raise unknown_measure(column, self._of) from None

    def __iter__(self) -> Any:
        return iter(self._of)

    def __len__(self) -> int:
        return len(self._of)

    def __repr__(self) -> str:
        return "\n".join(map(repr, self._of.values()))


class Measures(MeasureMapping):
    """The measures of a run that are numbers, by column."""

    def __getitem__(self, column: str) -> Measure:
        return super().__getitem__(column)  # type: ignore[no-any-return]

    def to_pandas(self) -> pandas.DataFrame:
        """A row for each measure, by column, in SI units: `label`, `mean`, `standard_error`, `error`, `shown`, which stands
        for all replicates in reports, the number `n` of replicates in which it is defined, and its `meaning`."""
        pd = needed("pandas", "pandas", "to_pandas()")
        rows = [
            (m.label, m.mean, m.standard_error, m.error, m.shown, np.isfinite(m.values).sum(), m.meaning)
            for m in self.values()
        ]
        columns = ["label", "mean", "standard_error", "error", "shown", "n", "meaning"]
        table = pd.DataFrame(rows, columns=columns, index=pd.Index(list(self), name="measure"))
        return table.astype({"standard_error": float, "error": float})
