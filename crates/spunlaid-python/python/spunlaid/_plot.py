"""Plots with matplotlib, which is imported when the first one is drawn. Every function returns the axes, to be changed at will."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._measures import Curve, Measure
from ._optional import needed

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

Scale = tuple[str, float, float, bool]
"""What the compiled part says of an `Axis`."""

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

    def name_level(self, value: Any) -> str:
        """`Diameter d = 50 µm` of a factor with this value."""
        name, _, unit = self.shown_label().partition(" (")
        return f"{name} {value}" if isinstance(value, str) else f"{name} = {float(self.place(value)):.4g} {unit.rstrip(')')}".rstrip()

    def shown_label(self) -> str:
        """The label as matplotlib writes it."""
        return re.sub(r"\*(.+?)\*", r"$\1$", self.label)


def label(ax: Axes, along: Axis, up: Axis) -> Axes:
    """Labels both axes, and scales them."""
    ax.set_xlabel(along.shown_label())
    ax.set_ylabel(up.shown_label())
    if along.logarithmic:
        ax.set_xscale("log")
    if up.logarithmic:
        ax.set_yscale("log")
    return ax


def axes(ax: Axes | None) -> Axes:
    """The axes to draw on: those of the caller, or new ones."""
    plt = needed("matplotlib.pyplot", "plot", "plot()")
    return ax if ax is not None else plt.subplots(layout="constrained")[1]


def plot_free_ends(end_node: dict[str, Any], ax: Axes | None) -> Axes:
    """The free ends of some replicates over time."""
    ax = axes(ax)
    time, up = Axis("Time (s)"), Axis("Free end, displacement in *y* (mm)", per_si=1e3)
    for number, y in enumerate(end_node["y_m"][:_MOST_LINES], start=1):
        ax.plot(end_node["time_s"], up.place(y), linewidth=0.8, label=f"replicate {number}")
    return label(ax, time, up)


def plot_laid_fibre(laid: list[dict[str, Any]], ax: Axes | None) -> Axes:
    """A piece of what the first fibre laid."""
    ax = axes(ax)
    first = next((fibre for fibre in laid if len(fibre["s_m"])), None)
    if first is None:
        raise ValueError("nothing to plot: the run was computed with samples=False, or its fibres laid nothing")
    along, up = Axis("Machine direction (mm)", per_si=1e3), Axis("Cross direction (mm)", per_si=1e3)
    md, cd = along.place(first["md_m"]), up.place(first["cd_m"])
    # A piece of the belt, three times as long as the trace is wide, without the end that further loops would cover.
    width = np.ptp(cd)
    start = md.min() + 0.5 * width
    shown = (md >= start) & (md <= start + 3 * width)
    ax.plot(md[shown], cd[shown], linewidth=0.8)
    ax.set_aspect("equal")
    return label(ax, along, up)


def plot_curve(curve: Curve, scales: Sequence[Scale], ax: Axes | None) -> Axes:
    """A curve with its standard error."""
    ax = axes(ax)
    along, up = (Axis(*scale) for scale in scales)
    at, mean, error = along.place(curve.at), up.place(curve.mean), up.place(curve.standard_error)
    (line,) = ax.plot(at, mean, label=curve.label)
    if np.isfinite(error).any():
        ax.fill_between(at, mean - error, mean + error, color=line.get_color(), alpha=0.25, linewidth=0)
    return label(ax, along, up)


def plot_number(measure: Measure, scales: Sequence[Scale], ax: Axes | None) -> Axes:
    """A number of each replicate, and its mean with the standard error."""
    ax = axes(ax)
    (up,) = (Axis(*scale) for scale in scales)
    ax.plot(np.arange(1, len(measure.values) + 1), up.place(measure.values), "o", label="replicates")
    mean, error = float(up.place(measure.mean)), measure.standard_error
    line = ax.axhline(mean, color="black", linewidth=0.8, label="mean")
    if np.isfinite(error):
        half = error * up.per_si
        ax.axhspan(mean - half, mean + half, color=line.get_color(), alpha=0.15, linewidth=0)
    ax.legend()
    ax.locator_params(axis="x", integer=True)
    return label(ax, Axis("Replicate"), up)


def plot_points(
    factor: tuple[Axis, NDArray[Any]],
    measure: tuple[Axis, NDArray[np.float64], NDArray[np.float64]],
    families: list[tuple[str | None, NDArray[np.intp]]],
    is_ordered: bool,
    ax: Axes | None,
) -> Axes:
    """The points of a study: a measure over a factor.

    factor: its axis, and its value at each point
    measure: its axis, and mean and standard error at each point
    families: name and points of each line
    is_ordered: whether the points of a line are joined from the left to the right
    """
    ax = axes(ax)
    (x, values), (up, mean, error) = factor, measure
    places = x.place(values) if values.dtype.kind == "f" else values
    mean, error = up.place(mean), up.place(error)
    for name, points in families:
        order = points[np.argsort(places[points], kind="stable")] if is_ordered else points
        bars = error[order] if np.isfinite(error[order]).any() else None
        ax.errorbar(places[order], mean[order], yerr=bars, fmt="o-" if is_ordered else "o", capsize=2, markersize=4, label=name)
    if any(name is not None for name, _ in families):
        ax.legend()
    return label(ax, x, up)


def plot_map(basis_weight: NDArray[np.float64], cell: float, ax: Axes | None) -> Axes:
    """The basis weight [kg/m²] of every cell of a web, whose side is `cell` [m]."""
    ax = axes(ax)
    weight = 1e3 * basis_weight
    across, along = (1e3 * cell * cells for cells in (weight.shape[1], weight.shape[0]))
    image = ax.imshow(weight, cmap="Greys", origin="lower", extent=(0, across, 0, along), interpolation="nearest")
    bar = ax.figure.colorbar(image, ax=ax)
    bar.set_label("Basis weight (g/m²)")
    return label(ax, Axis("Cross direction (mm)"), Axis("Machine direction (mm)"))


_SIDE = Axis("Side of the patches (mm)", per_si=1e3, logarithmic=True)
_CV = Axis("CV of the basis weight (%)", per_si=1e2, logarithmic=True)


def plot_unevenness(patches: dict[str, NDArray[np.float64]], ax: Axes | None) -> Axes:
    """CV of a web over the size of the patches; see `Web.patches`."""
    ax = axes(ax)
    at, cv = _SIDE.place(patches["patch_m"]), _CV.place(patches["cv"])
    known = np.isfinite(patches["cv_low"] + patches["cv_high"])
    ends = np.where(known, np.abs(_CV.place([patches["cv_low"], patches["cv_high"]]) - cv), 0.0)
    ax.errorbar(at, cv, yerr=ends if known.any() else None, fmt="o-", capsize=2, markersize=4, label="this web")
    for name, words in (("cv_independent", "each filament in its own air"), ("cv_single_fibres", "expected from single fibres")):
        if np.isfinite(patches[name]).any():
            ax.plot(at, _CV.place(patches[name]), "--", label=words)
    ax.legend()
    return label(ax, _SIDE, _CV)


def plot_fit(numbers: list[dict[str, Any]], ax: Axes | None) -> Axes:
    """The CV of a scan and of the webs that are like it; `numbers` as in `fit.json`."""
    ax = axes(ax)
    patches = [number for number in numbers if "patch_m" in number]
    at = _SIDE.place([patch["patch_m"] for patch in patches])
    found, scatter = (np.array([patch[name] for patch in patches]) for name in ("fit", "scatter"))
    ends = [_CV.place(found * np.exp(sign * 1.96 * scatter)) for sign in (-1.0, 1.0)]
    ax.fill_between(at, ends[0], ends[1], alpha=0.25, label="95 of 100 simulated webs")
    ax.plot(at, _CV.place(found), label="fit")
    ax.plot(at, _CV.place([patch["scan"] for patch in patches]), "o", markersize=4, label="scan")
    ax.legend()
    return label(ax, _SIDE, _CV)
