"""Runs: a simulated case, and its results."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _spunlaid
from ._arguments import changes_of, check_threads
from ._case import CaseLike, case_of
from ._errors import FolderError
from ._measures import Curve, Measure, MeasureMapping, Measures, Shapes, unknown_measure
from ._optional import needed
from ._plot import plot_curve, plot_free_ends, plot_laid_fibre, plot_number
from ._progress import Progress, shown
from ._results import Kept, Place, Results
from ._spunlaid import Case, Computed
from ._tables import Tables

if TYPE_CHECKING:
    import pandas
    import xarray
    from matplotlib.axes import Axes
    from numpy.typing import NDArray


class Run(Results):
    """The results of a case. `spunlaid.run` and `spunlaid.load` return one; a notebook shows its report."""

    def __init__(self, case: Case, computed: Computed | Kept, tables: Tables) -> None:
        super().__init__(computed)
        self._case, self._tables = case, tables

    @property
    def case(self) -> Case:
        """The case that was simulated."""
        return self._case

    @property
    def measures(self) -> Measures:
        """The measures that are numbers, by column: `run.measures["amplitude_y_m"].mean`."""
        return self._keep("measures", lambda: Measures(Measure, self._tables.numbers))  # type: ignore[no-any-return]

    @property
    def curves(self) -> Mapping[str, Curve]:
        """The measures that are curves, by column. A run that was loaded or pickled has none."""
        return self._keep("curves", lambda: MeasureMapping(Curve, self._curves()))  # type: ignore[no-any-return]

    @property
    def end_node(self) -> dict[str, NDArray[np.float64]]:
        """The free end over time: `time_s` (times), and `x_m`, `y_m`, `z_m` (replicates × times). Empty for a fed fibre."""
        return dict(self._keep("end_node", lambda: self._tables.end_node))

    @property
    def energy(self) -> dict[str, NDArray[np.float64]]:
        """Energies and works over time: `time_s` (times), and others (replicates × times)."""
        return dict(self._keep("energy", lambda: self._tables.energy))

    @property
    def shapes(self) -> Shapes:
        """Whole fibres over time."""
        return self._keep("shapes", lambda: Shapes(*self._shapes()))  # type: ignore[no-any-return]

    @property
    def laid(self) -> list[dict[str, NDArray[np.float64]]]:
        """What each replicate of a fed fibre laid: fed length `s_m`, `time_s`, and the place on the belt, `md_m` and
        `cd_m`. Empty for a fibre of fixed length."""
        return list(self._keep("laid", lambda: self._tables.laid))

    @property
    def step_check(self) -> dict[str, float | None] | None:
        """What a finer time step changes, see `summary`; None if it was not checked."""
        return self._tables.differences("step_check")

    @property
    def mesh_check(self) -> dict[str, float | None] | None:
        """What elements of half the length change, see `summary`; None if it was not checked."""
        return self._tables.differences("mesh_check")

    @property
    def lost(self) -> list[tuple[int, float, str]]:
        """The fibres that were lost: replicate, counted from 1, time [s] and reason of each. They are in no mean, and NaN in
        every array."""
        # Results of an earlier version have no such list: a lost fibre ended the run.
        return [(fibre["replicate"], fibre["time_s"], fibre["reason"]) for fibre in self.summary.get("lost_fibres", [])]

    def _curves(self) -> list[dict[str, Any]]:
        return [] if isinstance(self._computed, Kept) else self._computed.curves

    def _shapes(self) -> tuple[Any, Any]:
        return self._tables.shapes if isinstance(self._computed, Kept) else self._computed.shapes

    def to_pandas(self) -> pandas.DataFrame:
        """A row for each replicate and recorded instant: the free end and the energies."""
        pd = needed("pandas", "pandas", "to_pandas()")
        replicates, times, columns = self._over_time()
        index = pd.MultiIndex.from_product([replicates, times], names=["replicate", "time_s"])
        return pd.DataFrame({name: values.ravel() for name, values in columns.items()}, index=index)

    def to_xarray(self) -> xarray.Dataset:
        """The same with dimensions `replicate` and `time_s`, and the measures over `replicate`; `attrs["units"]` of each variable is
        its unit as the CF conventions write it."""
        xr = needed("xarray", "xarray", "to_xarray()")
        replicates, times, columns = self._over_time()
        over_time = {name: {"units": _spunlaid.column_unit(name)} for name in [*columns, "time_s"]}
        data: dict[str, Any] = {name: (("replicate", "time_s"), of, over_time[name]) for name, of in columns.items()}
        for name, measure in self.measures.items():
            about = {"long_name": measure.label, "description": measure.meaning, "units": measure.unit}
            data[name] = ("replicate", measure.values, about)
        return xr.Dataset(data, {"replicate": replicates, "time_s": ("time_s", times, over_time["time_s"])})

    def _over_time(self) -> tuple[NDArray[np.int64], NDArray[np.float64], dict[str, NDArray[np.float64]]]:
        """Numbers of the replicates, times, and columns of replicates × times."""
        columns = {**self.end_node, **self.energy}
        times = columns.pop("time_s")
        return np.arange(1, len(next(iter(columns.values()))) + 1), times, columns

    def plot(self, column: str | None = None, *, ax: Axes | None = None) -> Axes:
        """Draws with matplotlib, and returns the axes.

        column: a curve, drawn with its standard error; or a number, drawn for each replicate with its mean. By default the motion
            of the free ends over time, of up to eight replicates; of a fed fibre, a piece of what the first one laid
        ax: the axes to draw on; new ones by default
        """
        if column is None:
            return plot_free_ends(self.end_node, ax) if self.end_node else plot_laid_fibre(self.laid, ax)
        if column in self.curves:
            return plot_curve(self.curves[column], self.scales(column), ax)
        if column in self.measures:
            return plot_number(self.measures[column], self.scales(column), ax)
        raise unknown_measure(column, [*self.measures, *self.curves])

    def scales(self, column: str) -> list[tuple[str, float, float, bool]]:
        """How a measure is drawn on axes: label with unit, zero in SI units, factor from SI units, whether logarithmic. Of a curve
        first along, then up."""
        described = self._keep("described", lambda: [*self._tables.numbers, *self._curves()])
        return next(list(measure["scales"]) for measure in described if measure["column"] == column)

    def _save(self, path: str, force: bool, figures: tuple[Any, Any], whole: bool = True) -> None:
        if isinstance(self._computed, Kept):
            return self._computed.save(path, force, figures)
        if whole and not self.energy:
            raise FolderError("the run was computed with samples=False, so its tables cannot be written")
        self._computed.save(path, force, figures, os.fspath(self._tables.path))

    def __reduce__(self) -> tuple[Any, ...]:
        return of_kept, (self._packed(), self._case)

    def __repr__(self) -> str:
        lines = [f"<Run of {self.case!r}"]
        names = [name for name in _FIRST if name in self.measures]
        lines += [f"  {self.measures[name]!r}" for name in names]
        return "\n".join(lines) + ">"


_FIRST = ("amplitude_y_m", "amplitude_z_m", "frequency_y_hz", "frequency_z_hz", "sigma_md_m", "sigma_cd_m")


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
    """Simulates a case: bit-identical to `spunlaid run`.

    case: a Case, the path of a case file, or a dict of its tables, with texts that have a unit and numbers in SI units
    set: keys that replace those of the case, `{"air.velocity": "20 m/s"}`
    replicates, seed: number of fibres, and the seed of their turbulence; as the case says by default
    threads: number of threads, by default one for each processor; the results do not depend on it
    progress: None, True, False, or a function that gets the steps done and their number
    check_step: whether some fibres are simulated again with a finer time step and finer elements, to find their errors
    samples: whether the free ends and energies over time are kept: 136 bytes for each fibre and instant
    shapes: whether whole fibres over time are kept, of up to eight replicates

    Ctrl-C stops it. Raises FibreLost if a fibre's positions become infinite.
    """
    case = case_of(case)
    changes = changes_of(set)
    if replicates is not None:
        changes["run.replicates"] = replicates
    if seed is not None:
        changes["run.seed"] = seed
    if changes:
        case = case.with_(changes)
    with shown(progress, f"{case['run.replicates']} fibres") as show:
        place = Place()
        folder = place.path / "run"
        simulated = _spunlaid.fly(case, folder, check_threads(threads), show, check_step, shapes)
    if not samples:
        for name in ("end_node.parquet", "energy.parquet"):
            (folder / name).unlink(missing_ok=True)
    return Run(case, simulated, Tables(folder, simulated.summary, place))


def of_kept(kept: Kept, case: Case | None = None) -> Run:
    """A run from the files of its folder."""
    tables = Tables(kept.path, kept.summary)
    return Run(case or Case.read(kept.path / "case.toml"), kept, tables)
