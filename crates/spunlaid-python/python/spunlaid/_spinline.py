"""Spinlines: from the hole of the spinneret to the solid filament."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from . import _spunlaid
from ._arguments import split_source
from ._results import Kept, Results

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Spinline(Results):
    """A spinline in steady state. `spunlaid.spin` returns it; a notebook shows its report.

    Each measure is an attribute, in SI units: `line.final_diameter_m`, `line.solidification["distance_m"]`.
    """

    def __init__(self, solved: _spunlaid.Computed | Kept) -> None:
        super().__init__(solved)
        self._measures: dict[str, Any] = self.summary["spinline"]

    @property
    def measures(self) -> dict[str, Any]:
        """All measures, as `spinline` in `summary.json`. Those of a curtain are of the first row, and `rows` has each row."""
        return self._measures

    @property
    def stations(self) -> dict[str, NDArray[np.float64]]:
        """The thread and the air around it from the die to the end, a NumPy array for each column of `spinline.parquet`: `z_m`,
        `speed_m_s`, `diameter_m`, `temperature_c`, `tension_n`, `stress_pa`, `transformed`, `strain_rate_per_s`, and
        `air_velocity_m_s`, `air_cross_velocity_m_s`, `air_temperature_c`. Of a curtain those of its first row."""
        return self.rows[0]

    @property
    def rows(self) -> list[dict[str, NDArray[np.float64]]]:
        """The same for each row of the curtain, the quenched side first; one if there is no curtain."""
        return list(self._keep("rows", self._rows))

    def _rows(self) -> list[dict[str, NDArray[np.float64]]]:
        if not isinstance(self._computed, Kept):
            return self._computed.stations
        table = _spunlaid.read_table(self._computed.path / "spinline.parquet")
        row = table.pop("row", None)
        if row is None:
            return [table]
        return [{name: of[row == number] for name, of in table.items()} for number in sorted(set(row))]

    @property
    def influences(self) -> list[dict[str, Any]]:
        """What decides the diameter, the largest first: `key`, `label`, `change`, and what it does to `diameter` and `speed`:
        d ln d / d ln x where the change is relative, the relative change for 10 K otherwise."""
        return self._measures["influences"]  # type: ignore[no-any-return]

    @property
    def text(self) -> str:
        """The spinline with every default written out, as a file."""
        if isinstance(self._computed, Kept):
            return (self._computed.path / "spinline.toml").read_text("utf-8")
        return self._computed.text or ""

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._packed(),)

    def __getattr__(self, name: str) -> Any:
        measures = self.__dict__.get("_measures", {})
        if name in measures:
            return measures[name]
        raise AttributeError(f"a spinline has no measure {name!r}; it has {', '.join(measures)}")

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self._measures})

    def __repr__(self) -> str:
        diameter, speed = 1e6 * self._measures["final_diameter_m"], self._measures["final_speed_m_s"]
        decitex = 1e7 * self._measures["linear_density_kg_m"]
        return f"<Spinline {self._computed.name}: {diameter:.4g} µm, {decitex:.3g} dtex, {speed:.4g} m/s>"


def spin(
    spinline: str | os.PathLike[str] | Mapping[str, Any],
    *,
    set: Mapping[str, Any] | None = None,  # noqa: A002 - the word of the program
) -> Spinline:
    """Solves a spinline, from the hole of the spinneret to the solid filament: bit-identical to `spunlaid spin`.

    spinline: the path of a file with the table `[spinline]`, which may be a case; or a dict of its tables, `{"spinline": {...},
        "drag": {...}}`, with texts that have a unit, and numbers in SI units. `spunlaid keys spinline` lists the keys
    set: keys that replace those of the file, `{"spinline.throughput": "0.4 g/min"}`
    """
    return Spinline(_spunlaid.solve_spinline(*split_source(spinline, set)))


def find_drag_factor(
    spinline: str | os.PathLike[str] | Mapping[str, Any],
    titre: str | float,
    *,
    set: Mapping[str, Any] | None = None,  # noqa: A002 - the word of the program
) -> float:
    """The factor on the drag of the air, `spinline.drag_factor`, with which the filament has a measured titre.

    spinline, set: as of `spin`
    titre: with its unit, `"1.9 dtex"`, or in kg/m
    """
    path, changes = split_source(spinline, set)
    return _spunlaid.find_drag_factor(path, titre, changes)
