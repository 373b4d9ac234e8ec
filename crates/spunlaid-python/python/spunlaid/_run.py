"""Runs: a case flown, and its results."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _spunlaid
from ._case import CaseLike, case_of
from ._optional import needed
from ._progress import Progress, shown

if TYPE_CHECKING:
    import pandas
    import xarray
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from ._spunlaid import Case


class Measure(NamedTuple):
    """A number that is measured of every fibre, over the replicates; in SI units."""

    column: str
    """Name with its unit, `amplitude_y_m`."""
    label: str
    meaning: str
    group: str
    mean: float
    """Mean over the replicates."""
    standard_error: float | None
    """Standard error of the mean; None from a single replicate."""
    shown: float
    """What stands for all replicates in reports: the mean, the median or the largest value."""
    values: NDArray[np.float64]
    """The value of each replicate; NaN where it is not defined."""

    def __float__(self) -> float:
        return self.mean

    def __repr__(self) -> str:
        error = "" if self.standard_error is None else f" ± {self.standard_error:.2g}"
        return f"<{self.column}: {self.mean:.6g}{error}>"


class Curve(NamedTuple):
    """A curve that is measured of every fibre, over the replicates; in SI units."""

    column: str
    label: str
    meaning: str
    group: str
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


class Run:
    """The results of a case. `spunlaid.run` and `spunlaid.load` return one; a notebook shows its report."""

    def __init__(self, case: Case, flown: Any) -> None:
        self._case = case
        self._flown = flown
        self._kept: dict[str, Any] = {}

    def _keep(self, name: str, make: Any) -> Any:
        # Two threads may both make it; the values are equal.
        if name not in self._kept:
            self._kept[name] = make()
        return self._kept[name]

    @property
    def case(self) -> Case:
        """The case that was flown."""
        return self._case

    @property
    def summary(self) -> dict[str, Any]:
        """What `summary.json` of a results folder holds."""
        return dict(self._keep("summary", lambda: json.loads(self._flown.summary)))

    @property
    def measures(self) -> Measures:
        """The measures that are numbers, by column: `run.measures["amplitude_y_m"].mean`."""
        return self._keep("measures", lambda: Measures(Measure, self._flown.numbers))  # type: ignore[no-any-return]

    @property
    def curves(self) -> Mapping[str, Curve]:
        """The measures that are curves, by column. A loaded run has none."""
        return self._keep("curves", lambda: _Named(Curve, self._flown.curves))  # type: ignore[no-any-return]

    @property
    def end_node(self) -> dict[str, NDArray[np.float64]]:
        """The free end over time: `time_s` (times), and `x_m`, `y_m`, `z_m` (replicates × times). Empty for a fed fibre."""
        return dict(self._keep("end_node", lambda: self._flown.end_node))

    @property
    def energy(self) -> dict[str, NDArray[np.float64]]:
        """Energies and works over time: `time_s` (times), and others (replicates × times)."""
        return dict(self._keep("energy", lambda: self._flown.energy))

    @property
    def shapes(self) -> Shapes:
        """Whole fibres over time."""
        return self._keep("shapes", lambda: Shapes(*self._flown.shapes))  # type: ignore[no-any-return]

    @property
    def laid(self) -> list[dict[str, NDArray[np.float64]]]:
        """What each replicate of a fed fibre laid: fed length `s_m`, `time_s`, and the place on the belt, `md_m` and
        `cd_m`. Empty for a fibre of fixed length."""
        return list(self._keep("laid", lambda: self._flown.laid))

    @property
    def step_check(self) -> dict[str, float | None] | None:
        """What a finer time step changes, see `summary`; None if it was not checked."""
        return self._flown.step_check  # type: ignore[no-any-return]

    @property
    def mesh_check(self) -> dict[str, float | None] | None:
        """What elements of half the length change, see `summary`; None if it was not checked."""
        return self._flown.mesh_check  # type: ignore[no-any-return]

    @property
    def notes(self) -> list[str]:
        """Notes and warnings."""
        return list(self._flown.notes)

    @property
    def lost(self) -> list[tuple[int, float, str]]:
        """The fibres that were lost: replicate, counted from 1, time [s] and reason of each. They are in no mean, and NaN in
        every array."""
        return list(self._flown.lost)

    def report(self) -> str:
        """The report, one page of HTML that works offline."""
        return self._keep("report", self._flown.report)  # type: ignore[no-any-return]

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        force: bool = False,
        figures: Sequence[str] | str | None = None,
        figure_width: str | float | None = None,
    ) -> None:
        """Writes the folder that `spunlaid run` writes.

        force: whether results that the folder holds are replaced.
        figures: the formats of the figures, `["pdf", "png"]`; SVG and PNG if it is left out
        figure_width: their width in print, `"one-column"`, `"two-columns"`, `"90 mm"` or in metres; PNG then has 300 dpi
        """
        self._flown.save(os.fspath(path), force, figures, figure_width)

    def to_pandas(self) -> pandas.DataFrame:
        """A row for each replicate and recorded instant: the free end and the energies."""
        pd = needed("pandas", "pandas", "to_pandas()")
        columns = {**self.end_node, **self.energy}
        times = columns.pop("time_s")
        replicates = len(next(iter(columns.values())))
        index = pd.MultiIndex.from_product([range(1, replicates + 1), times], names=["replicate", "time_s"])
        return pd.DataFrame({name: values.ravel() for name, values in columns.items()}, index=index)

    def to_xarray(self) -> xarray.Dataset:
        """The same with dimensions `replicate` and `time_s`, and the measures over `replicate`."""
        xr = needed("xarray", "xarray", "to_xarray()")
        columns = {**self.end_node, **self.energy}
        times = columns.pop("time_s")
        data: dict[str, Any] = {name: (("replicate", "time_s"), values) for name, values in columns.items()}
        for name, measure in self.measures.items():
            data[name] = ("replicate", measure.values, {"long_name": measure.label, "description": measure.meaning})
        replicates = len(next(iter(columns.values())))
        return xr.Dataset(data, {"replicate": np.arange(1, replicates + 1), "time_s": times})

    def plot(self, column: str | None = None, *, ax: Axes | None = None) -> Axes:
        """Draws with matplotlib, and returns the axes.

        column: a curve, drawn with its standard error; or a number, drawn for each replicate with its mean. By default the motion
            of the free ends over time, of up to eight replicates; of a fed fibre, a piece of what the first one laid
        ax: the axes to draw on; new ones by default
        """
        from ._plot import of_run

        return of_run(self, column, ax)

    def scales(self, column: str) -> list[tuple[str, float, float, bool]]:
        """How a measure stands on axes: label with unit, zero in SI units, factor from SI units, whether logarithmic. Of a curve
        first along, then up."""
        described = self._keep("described", lambda: [*self._flown.numbers, *self._flown.curves])
        return next(list(measure["scales"]) for measure in described if measure["column"] == column)

    def __reduce__(self) -> tuple[Any, ...]:
        return Run, (self._case, self._flown)

    def __repr__(self) -> str:
        lines = [f"<Run of {self.case!r}"]
        names = [name for name in _FIRST if name in self.measures]
        lines += [f"  {self.measures[name]!r}" for name in names]
        return "\n".join(lines) + ">"

    def _repr_html_(self) -> str:
        from html import escape

        page = escape(self.report(), quote=True)
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 720px; border: 1px solid #ccc"></iframe>'


_FIRST = ("amplitude_y_m", "amplitude_z_m", "frequency_y_hz", "frequency_z_hz", "sigma_md_m", "sigma_cd_m")


def unknown_measure(column: str, known: Iterable[str]) -> KeyError:
    """The error of a measure that is not there."""
    from difflib import get_close_matches

    known = list(known)
    near = get_close_matches(str(column), known, n=1)
    hint = f"did you mean {near[0]!r}?" if near else "there are " + ", ".join(known)
    return KeyError(f"no measure {column!r} here; {hint}")


class _Named(Mapping[str, Any]):
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


class Measures(_Named):
    """The measures of a run that are numbers, by column."""

    def __getitem__(self, column: str) -> Measure:
        return super().__getitem__(column)  # type: ignore[no-any-return]

    def to_pandas(self) -> pandas.DataFrame:
        """A row for each measure, by column, in SI units: `label`, `mean`, `standard_error`, `shown`, which stands for all
        replicates in reports, the number `n` of replicates in which it is defined, and its `meaning`."""
        pd = needed("pandas", "pandas", "to_pandas()")
        rows = [(m.label, m.mean, m.standard_error, m.shown, np.isfinite(m.values).sum(), m.meaning) for m in self.values()]
        columns = ["label", "mean", "standard_error", "shown", "n", "meaning"]
        table = pd.DataFrame(rows, columns=columns, index=pd.Index(list(self), name="measure"))
        return table.astype({"standard_error": float})


def run(
    case: CaseLike,
    replicates: int | None = None,
    *,
    set: Mapping[str, Any] | None = None,  # noqa: A002 - the word of the program
    seed: int | None = None,
    threads: int | None = None,
    progress: Progress = None,
    check_step: bool = True,
    samples: bool = True,
    shapes: bool = True,
) -> Run:
    """Flies a case: the same bits as `spunlaid run`.

    case: a Case, the path of a case file, or a dict of its tables, with texts that have a unit and numbers in SI units
    set: keys that replace those of the case, `{"air.velocity": "20 m/s"}`
    replicates, seed: number of fibres, and the seed of their turbulence; as the case says by default
    threads: number of threads, by default one for each processor; the results do not depend on it
    progress: None, True, False, or a function that gets the steps done and their number
    check_step: whether some fibres fly again with a finer time step and finer elements, to tell their errors
    samples: whether the free ends and energies over time are kept: 136 bytes for each fibre and instant
    shapes: whether whole fibres over time are kept, of up to eight replicates

    Ctrl-C stops it. Raises FibreLost if a fibre's positions become infinite.
    """
    case = case_of(case)
    changes = dict(set or {})
    if replicates is not None:
        changes["run.replicates"] = replicates
    if seed is not None:
        changes["run.seed"] = seed
    if changes:
        case = case.with_(changes)
    with shown(progress, f"{case['run.replicates']} fibres") as show:
        return Run(case, _spunlaid.fly(case, _threads(threads), show, check_step, samples, shapes))


def _threads(threads: int | None) -> int | None:
    if threads is not None and (not isinstance(threads, (int, np.integer)) or isinstance(threads, bool)):
        raise TypeError(f"threads must be a whole number, not {type(threads).__name__}")
    if threads is not None and not 1 <= threads <= 4096:
        raise ValueError(f"threads must be 1 to 4096, not {threads}")
    return None if threads is None else int(threads)


def load(path: str | os.PathLike[str]) -> Run:
    """The results of a run from the folder that `Run.save` or `spunlaid run` wrote.

    It has what the files hold: summary, measures, end_node, energy, shapes, laid and the report; no curves. It needs
    pyarrow for the tables, when they are first used.
    """
    from ._folder import Folder

    folder = Folder(path)
    return Run(folder.case, folder)
