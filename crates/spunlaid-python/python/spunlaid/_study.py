"""Studies: many cases or webs, on this machine or on a cluster."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _spunlaid
from ._arguments import check_figures, check_threads
from ._case import case_of
from ._optional import needed
from ._errors import FolderError
from ._plot import Axis, plot_points
from ._progress import Progress, shown
from ._results import Place, read_files, write_files
from ._spunlaid import Case
from ._toml import study_toml

if TYPE_CHECKING:
    import pandas
    import xarray
    from matplotlib.axes import Axes
    from numpy.typing import NDArray


class Study:
    """A study that has been computed. `spunlaid.sweep` returns it."""

    def __init__(self, study: _spunlaid.Study) -> None:
        self._study = study
        self._results: dict[str, Any] = study.results()

    def __len__(self) -> int:
        """Number of points."""
        return len(self._study)

    @property
    def inputs(self) -> dict[str, NDArray[Any]]:
        """The keys that differ between points, in SI units: the factors, then what follows from them."""
        return {of["key"]: np.asarray(of["values"]) for of in self._study.inputs}

    @property
    def factors(self) -> list[str]:
        """The keys that were varied."""
        return [of["key"] for of in self._study.inputs if of["factor"]]

    @property
    def design(self) -> str:
        """How the factors are combined."""
        return self._study.design

    @property
    def n(self) -> NDArray[np.int64]:
        """Number of fibres or webs measured at each point."""
        return self._results["n"]  # type: ignore[no-any-return]

    @property
    def lost(self) -> NDArray[np.int64]:
        """Number of fibres lost at each point: the computation diverged, or the fibre did not reach the belt."""
        return self._results["lost"]  # type: ignore[no-any-return]

    @property
    def mean(self) -> dict[str, NDArray[np.float64]]:
        """The mean of each measure at the points, by column: `study.mean["amplitude_y_m"]`."""
        return self._by_measure("mean")

    @property
    def standard_error(self) -> dict[str, NDArray[np.float64]]:
        """The standard error of each mean; NaN from a single fibre. Of a single web it comes from the parts of the map."""
        return self._by_measure("standard_error")

    def _by_measure(self, name: str) -> dict[str, NDArray[np.float64]]:
        values = self._results[name]
        columns = [of[0] for of in self._study.measures]
        return {column: values[:, i] for i, column in enumerate(columns) if np.isfinite(self._results["mean"][:, i]).any()}

    @property
    def notes(self) -> list[str]:
        """Notes about the points."""
        return self._study.notes

    def case(self, point: int) -> Case:
        """The case of a point, counted from 0."""
        if self.noun == "web":
            raise ValueError("the points of this study are webs; point_text(point) has the file of one")
        return Case.from_text(self._study.point_text(point))

    def point_text(self, point: int) -> str:
        """The file of a point, counted from 0: a case for `spunlaid run`, or a web for `spunlaid web`."""
        return self._study.point_text(point)

    @property
    def noun(self) -> str:
        """What a replicate is: `fibre` or `web`."""
        return self._study.noun

    def effects(self) -> list[dict[str, Any]]:
        """How much each factor changes each measure from one end of its range to the other: `measure`, `factor`, `from`,
        `to`, `change`, its `standard_error` and `half_width` of its interval of 95 %; empty if the design does not give it."""
        names = ("measure", "factor", "from", "to", "change", "standard_error", "half_width", "explained")
        return [dict(zip(names, effect, strict=True)) for effect in self._study.effects()]

    def replicates(self) -> pandas.DataFrame:
        """A row for each fibre or web: `point` and `replicate`, both counted from 1, whether it was `lost`, and its measures."""
        pd = needed("pandas", "pandas", "replicates()")
        columns = ["point", "replicate", "lost"] + [of[0] for of in self._study.measures]
        table = pd.DataFrame(self._study.replicates(), columns=columns).dropna(axis="columns", how="all")
        table[["point", "replicate"]] = table[["point", "replicate"]].astype(int) + 1
        return table.astype({"lost": bool})

    def to_pandas(self) -> pandas.DataFrame:
        """A row for each point, as `results.csv` has it: seed, inputs, numbers of fibres, means and standard errors (`_se`)."""
        pd = needed("pandas", "pandas", "to_pandas()")
        columns: dict[str, Any] = {"seed": self._results["seed"]}
        columns |= {of["column"]: np.asarray(of["values"]) for of in self._study.inputs}
        columns |= {"n": self.n, "lost": self.lost}
        errors = self.standard_error
        for column, mean in self.mean.items():
            columns |= {column: mean, f"{column}_se": errors[column]}
        return pd.DataFrame(columns, index=pd.RangeIndex(1, len(self) + 1, name="point"))

    def to_xarray(self) -> xarray.Dataset:
        """The same with the factors as coordinates: a dimension for each factor of a grid, `point` for other designs. `attrs` of each
        variable have its `units`, as the CF conventions write them, and of a measure `long_name` and `description`."""
        needed("xarray", "xarray", "to_xarray()")
        data = self._data_set()
        about = {of["key"]: {"units": of["unit"]} for of in self._study.inputs}
        about |= {of["column"]: about[of["key"]] for of in self._study.inputs}
        for column, label, meaning, unit, _ in self._study.measures:
            about[column] = {"long_name": label, "description": meaning, "units": unit}
            about[f"{column}_se"] = {"long_name": f"Standard error: {label}", "units": unit}
        about |= {count: {"units": "1"} for count in ("n", "lost")}
        for name, variable in data.variables.items():
            # Words have no unit.
            if variable.dtype.kind in "fiu":
                variable.attrs.update(about.get(name, {}))
        return data

    def _data_set(self) -> xarray.Dataset:
        table = self.to_pandas()
        factors = {of["key"]: of["column"] for of in self._study.inputs if of["factor"]}
        if self.design == "grid" and factors:
            columns = list(factors.values())
            table = table.reset_index().set_index(columns)
            if not table.index.has_duplicates:
                return table.to_xarray().rename({column: key for key, column in factors.items()})
            table = table.reset_index().set_index("point")
        data = table.to_xarray()
        return data.set_coords(list(factors.values())).rename({column: key for key, column in factors.items()})

    def plot(self, column: str | None = None, *, along: str | None = None, ax: Axes | None = None) -> Axes:
        """Draws a measure over a factor with matplotlib, with standard errors, and returns the axes. In a grid, each line has the
        other factors in common.

        column: the measure, `amplitude_y_m`; by default the amplitude, the width of the laydown, the CV or the diameter,
            whichever the study has
        along: the key that is varied along the axis; the first factor by default
        ax: the axes to draw on; new ones by default
        """
        measured, factors = self.mean, self.factors
        if column is None:
            column = next((name for name in _FIRST if name in measured), next(iter(measured), ""))
        if along is None:
            along = next(iter(factors), "")
        for name, known, what in ((column, list(measured), "measure"), (along, factors, "factor")):
            if name not in known:
                raise KeyError(f"no {what} {name!r} in this study; there are {', '.join(known) or 'none'}")
        values = self.inputs[along]
        # Neither words nor the points of a random design have an order.
        is_ordered = values.dtype.kind == "f" and self.design != "latin-hypercube"
        measure = (self.scale_of_measure(column), self.mean[column], self.standard_error[column])
        return plot_points((self.scale_of_factor(along), values), measure, self._families(along), is_ordered, ax)

    def _families(self, along: str) -> list[tuple[str | None, NDArray[np.intp]]]:
        """The points of each line of a plot, with its name: those that have the other factors in common."""
        others = [key for key in self.factors if key != along]
        every = np.arange(len(self))
        columns = [self.inputs[key] for key in others]
        if self.design == "one-at-a-time":
            # The first point is the one from which the factors go.
            alike = [column == column[0] for column in columns]
            return [(None, every[np.logical_and.reduce(alike)] if alike else every)]
        if self.design != "grid" or not others:
            return [(None, every)]
        families: dict[str, list[int]] = {}
        for point in range(len(self)):
            names = [self.scale_of_factor(key).name_level(column[point]) for key, column in zip(others, columns, strict=True)]
            families.setdefault(", ".join(names), []).append(point)
        return [(name, np.array(points)) for name, points in families.items()]

    def scale_of_factor(self, key: str) -> Axis:
        """How the values of a factor stand on an axis."""
        return next(Axis(*of["scale"]) for of in self._study.inputs if of["key"] == key and of["factor"])

    def scale_of_measure(self, column: str) -> Axis:
        """How the values of a measure stand on an axis."""
        return next(Axis(*scale) for name, *_, scale in self._study.measures if name == column)

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        force: bool = False,
        figures: Sequence[str] | str | None = None,
        figure_width: str | float | None = None,
    ) -> None:
        """Writes the folder that `spunlaid sweep` writes, with the journal, so that it can go on from there.

        force: whether other results in the folder are replaced
        figures, figure_width: as of `Run.save`
        """
        _spunlaid.check_figures((figures, figure_width))
        self._study.save(os.fspath(path), force, (figures, figure_width))

    def __reduce__(self) -> tuple[Any, ...]:
        place = Place()
        folder = place.path / "study"
        self.save(folder, figures=["svg"])
        return _of_files, (read_files(folder),)

    def __repr__(self) -> str:
        factors = ", ".join(self.factors) or "no factors"
        return f"<Study {self._study.name}: {len(self)} points of {factors}, {int(self.n.sum())} {self.noun}s>"

    def _repr_html_(self) -> str | None:
        try:
            return self.to_pandas().to_html(max_rows=20)  # type: ignore[no-any-return]
        except ImportError:
            # Without pandas a notebook shows the text.
            return None


def of_folder(folder: Path) -> Study:
    """A study from its folder; one that was stopped is refused."""
    begun = _spunlaid.Study(os.fspath(folder / "study.toml"), out=os.fspath(folder))
    simulated, wanted = begun.fibres
    if simulated < wanted:
        raise FolderError(f"{folder}: holds {simulated} of {wanted} {begun.noun}s; spunlaid.sweep or `spunlaid sweep` goes on with it")
    return Study(begun)


def _of_files(files: dict[str, bytes]) -> Study:
    """A study that was pickled. It is read from a folder, which goes then."""
    place = Place()
    write_files(place.path, files)
    return of_folder(place.path)


_FIRST = ("amplitude_y_m", "sigma_cd_m", "cv_10_mm", "final_diameter_m")


def sweep(
    study: str | os.PathLike[str] | Mapping[str, Any],
    *,
    client: Any = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    figures: Sequence[str] | str | None = None,
    figure_width: str | float | None = None,
    points: int | None = None,
    replicates: int | None = None,
    set: Mapping[str, Any] | None = None,  # noqa: A002 - the word of study files
    threads: int | None = None,
    progress: Progress = None,
) -> Study:
    """Computes a study: bit-identical to `spunlaid sweep`, on any machine and any number of them.

    study: the path of a study file; or a dict with what such a file says, `{"case": case, "vary": {"air.velocity": [5, 10]},
        "replicates": 8}`, where `case` is a Case, a dict or the path of a case file, or `web` or `spinline` is the path of the
        file of a web or of a spinline, numbers are in SI units, and the design
        is a grid if it is left out
    client: a client of dask.distributed, whose workers then simulate the fibres or lay the webs
    out: the folder for journal, tables, figures and report, as `spunlaid sweep` writes it; a study that was stopped goes
        on from there. Without it, results are kept in memory only
    force: whether other results in the folder are replaced
    figures, figure_width: how the figures in the folder are written, as of `Run.save`
    points: number of points, which more than 10,000 need
    replicates, set: as of `spunlaid sweep`
    threads: number of threads on this machine
    progress: None, True, False, or a function that gets the fibres or webs done and their number
    """
    asked = check_figures(figures, figure_width, out, "results/study")
    folder = None if out is None else os.fspath(out)
    begun = _spunlaid.Study(*_split_study(study), folder, force, points, replicates, set, check_threads(threads))
    with shown(progress, f"{len(begun)} points") as show:
        if client is None:
            begun.fly(check_threads(threads), show)
        else:
            from ._dask import fly

            fly(begun, client, show)
    if out is not None:
        begun.write(asked)
    return Study(begun)


def _split_study(study: str | os.PathLike[str] | Mapping[str, Any]) -> tuple[str, Case | None, str | None]:
    """The path of a study; or the text of one with the case that it varies, or with the path of its web or spinline."""
    if not isinstance(study, Mapping):
        return os.fspath(study), None, None
    if "case" in study:
        return study_toml(study), case_of(study["case"]), None
    for name in ("web", "spinline"):
        if name in study:
            return study_toml(study), None, os.fspath(study[name])
    raise ValueError('a study needs a case: {"case": spunlaid.Case.starter(), "vary": {...}}')
