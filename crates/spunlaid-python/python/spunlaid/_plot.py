"""Plots with matplotlib, which is imported when the first one is drawn. Every function returns the axes, to be changed at will."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._optional import needed
from ._run import unknown_measure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from ._fit import Fit
    from ._run import Run
    from ._study import Study
    from ._web import Web

_MOST_LINES = 8
"""More fibres in one plot hide each other."""


class Axis(NamedTuple):
    """How values in SI units stand on an axis. The compiled part gives it."""

    label: str
    """Quantity and unit, with letters between asterisks: `Frequency *f* (Hz)`."""
    zero: float = 0.0
    """The value at which the unit of the axis counts zero [SI unit]."""
    per_si: float = 1.0
    """Factor from the SI unit to the unit of the axis."""
    logarithmic: bool = False

    def place(self, values: ArrayLike) -> NDArray[np.float64]:
        """The values in the unit of the axis."""
        return (np.asarray(values, dtype=np.float64) - self.zero) * self.per_si


def label(ax: Axes, along: Axis, up: Axis) -> Axes:
    """Labels both axes, and scales them."""
    letters = [re.sub(r"\*(.+?)\*", r"$\1$", axis.label) for axis in (along, up)]
    ax.set_xlabel(letters[0])
    ax.set_ylabel(letters[1])
    if along.logarithmic:
        ax.set_xscale("log")
    if up.logarithmic:
        ax.set_yscale("log")
    return ax


def axes(ax: Axes | None) -> Axes:
    """The axes to draw on: those of the caller, or new ones."""
    plt = needed("matplotlib.pyplot", "plot", "plot()")
    return ax if ax is not None else plt.subplots(layout="constrained")[1]


def of_run(run: Run, column: str | None, ax: Axes | None) -> Axes:
    """See `Run.plot`."""
    if column is None:
        return _free_ends(run, axes(ax)) if run.end_node else _laid(run, axes(ax))
    for measures, draw in ((run.curves, _curve), (run.measures, _number)):
        if column in measures:
            return draw(run, column, axes(ax))
    raise unknown_measure(column, [*run.measures, *run.curves])


def _free_ends(run: Run, ax: Axes) -> Axes:
    time, up = Axis("Time (s)"), Axis("Free end, displacement in *y* (mm)", per_si=1e3)
    for number, y in enumerate(run.end_node["y_m"][:_MOST_LINES], start=1):
        ax.plot(run.end_node["time_s"], up.place(y), linewidth=0.8, label=f"replicate {number}")
    return label(ax, time, up)


def _laid(run: Run, ax: Axes) -> Axes:
    if not any(len(laid["s_m"]) for laid in run.laid):
        raise ValueError("nothing to plot: the run was flown with samples=False, or its fibres laid nothing")
    along, up = Axis("Machine direction (mm)", per_si=1e3), Axis("Cross direction (mm)", per_si=1e3)
    first = next(laid for laid in run.laid if len(laid["s_m"]))
    md, cd = along.place(first["md_m"]), up.place(first["cd_m"])
    # A piece of the belt, three times as long as the trace is wide, without the end that further loops would cover.
    width = np.ptp(cd)
    start = md.min() + 0.5 * width
    shown = (md >= start) & (md <= start + 3 * width)
    ax.plot(md[shown], cd[shown], linewidth=0.8)
    ax.set_aspect("equal")
    return label(ax, along, up)


def _curve(run: Run, column: str, ax: Axes) -> Axes:
    curve = run.curves[column]
    along, up = (Axis(*scale) for scale in run.scales(column))
    at, mean, error = along.place(curve.at), up.place(curve.mean), up.place(curve.standard_error)
    (line,) = ax.plot(at, mean, label=curve.label)
    if np.isfinite(error).any():
        ax.fill_between(at, mean - error, mean + error, color=line.get_color(), alpha=0.25, linewidth=0)
    return label(ax, along, up)


def _number(run: Run, column: str, ax: Axes) -> Axes:
    measure = run.measures[column]
    (up,) = (Axis(*scale) for scale in run.scales(column))
    ax.plot(np.arange(1, len(measure.values) + 1), up.place(measure.values), "o", label="replicates")
    mean, error = float(up.place(measure.mean)), measure.standard_error
    line = ax.axhline(mean, color="black", linewidth=0.8, label="mean")
    if error is not None:
        half = error * up.per_si
        ax.axhspan(mean - half, mean + half, color=line.get_color(), alpha=0.15, linewidth=0)
    ax.legend()
    ax.locator_params(axis="x", integer=True)
    return label(ax, Axis("Replicate"), up)


def of_study(study: Study, column: str, along: str, ax: Axes | None) -> Axes:
    """See `Study.plot`."""
    ax = axes(ax)
    x, up = study.scale_of_factor(along), study.scale_of_measure(column)
    values = study.inputs[along]
    places = x.place(values) if values.dtype.kind == "f" else values
    mean, error = up.place(study.mean[column]), up.place(study.standard_error[column])
    others = [key for key in study.factors if key != along]
    # Neither words nor the points of a random design have an order.
    joined = values.dtype.kind == "f" and study.design not in ("latin-hypercube", "sobol")
    for name, points in _families(study, others):
        order = points[np.argsort(places[points], kind="stable")] if joined else points
        bars = error[order] if np.isfinite(error[order]).any() else None
        ax.errorbar(places[order], mean[order], yerr=bars, fmt="o-" if joined else "o", capsize=2, markersize=4, label=name)
    if others and ax.get_legend_handles_labels()[1]:
        ax.legend()
    return label(ax, x, up)


def _families(study: Study, others: list[str]) -> list[tuple[str | None, NDArray[np.intp]]]:
    """The points of each line of a plot, with its name: those that have the other factors in common."""
    every = np.arange(len(study))
    columns = [study.inputs[key] for key in others]
    if study.design == "one-at-a-time":
        # The first point is the one from which the factors go.
        alike = [column == column[0] for column in columns]
        return [(None, every[np.logical_and.reduce(alike)] if alike else every)]
    if study.design != "grid" or not others:
        return [(None, every)]
    families: dict[str, list[int]] = {}
    for point in range(len(study)):
        names = [_level(study, key, column[point]) for key, column in zip(others, columns, strict=True)]
        families.setdefault(", ".join(names), []).append(point)
    return [(name, np.array(points)) for name, points in families.items()]


def _level(study: Study, key: str, value: Any) -> str:
    """`Diameter d = 50 µm` of a factor with this value."""
    axis = study.scale_of_factor(key)
    name, _, unit = re.sub(r"\*(.+?)\*", r"$\1$", axis.label).partition(" (")
    return f"{name} {value}" if isinstance(value, str) else f"{name} = {float(axis.place(value)):.4g} {unit.rstrip(')')}".rstrip()


def of_web(web: Web, what: str, ax: Axes | None) -> Axes:
    """See `Web.plot`."""
    draw = {"map": _map, "cv": _cv}.get(what)
    if draw is None:
        raise ValueError(f'a web plots "map" or "cv", not {what!r}')
    return draw(web, axes(ax))


def of_fit(fit: Fit, ax: Axes | None) -> Axes:
    """See `Fit.plot`."""
    ax = axes(ax)
    along = Axis("Side of the patches (mm)", per_si=1e3, logarithmic=True)
    up = Axis("CV of the basis weight (%)", per_si=1e2, logarithmic=True)
    patches = [number for number in fit.summary["numbers"] if "patch_m" in number]
    at = along.place([patch["patch_m"] for patch in patches])
    found, scatter = (np.array([patch[name] for patch in patches]) for name in ("fit", "scatter"))
    ends = [up.place(found * np.exp(sign * 1.96 * scatter)) for sign in (-1.0, 1.0)]
    ax.fill_between(at, ends[0], ends[1], alpha=0.25, label="95 of 100 simulated webs")
    ax.plot(at, up.place(found), label="fit")
    ax.plot(at, up.place([patch["scan"] for patch in patches]), "o", markersize=4, label="scan")
    ax.legend()
    return label(ax, along, up)


def _map(web: Web, ax: Axes) -> Axes:
    weight = 1e3 * web.map
    across, along = (1e3 * web.cell * cells for cells in (weight.shape[1], weight.shape[0]))
    image = ax.imshow(weight, cmap="Greys", origin="lower", extent=(0, across, 0, along), interpolation="nearest")
    bar = ax.figure.colorbar(image, ax=ax)
    bar.set_label("Basis weight (g/m²)")
    return label(ax, Axis("Cross direction (mm)"), Axis("Machine direction (mm)"))


def _cv(web: Web, ax: Axes) -> Axes:
    along = Axis("Side of the patches (mm)", per_si=1e3, logarithmic=True)
    up = Axis("CV of the basis weight (%)", per_si=1e2, logarithmic=True)
    patches = web.patches
    at, cv = along.place(patches["patch_m"]), up.place(patches["cv"])
    known = np.isfinite(patches["cv_low"] + patches["cv_high"])
    ends = np.where(known, np.abs(up.place([patches["cv_low"], patches["cv_high"]]) - cv), 0.0)
    ax.errorbar(at, cv, yerr=ends if known.any() else None, fmt="o-", capsize=2, markersize=4, label="this web")
    for name, words in (("cv_independent", "each filament in its own air"), ("cv_single_fibres", "expected from single fibres")):
        if np.isfinite(patches[name]).any():
            ax.plot(at, up.place(patches[name]), "--", label=words)
    ax.legend()
    return label(ax, along, up)
