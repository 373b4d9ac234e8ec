"""The air in a velocity record."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _spunlaid
from ._spunlaid import Case

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    _Curves = list[NDArray[np.float64]]


class Interval(NamedTuple):
    """A result with its interval of 95 % confidence."""

    value: float
    low: float
    high: float


class Analysis:
    """The statistics of the air in a record, in SI units."""

    def __init__(self, text: str, air_toml: str, curves: list[_Curves]) -> None:
        self.results: dict[str, Any] = json.loads(text)
        """What `analysis.json` of `spunlaid analyse` holds."""
        self.air_toml: str = air_toml
        """The `[air]` of a case file."""
        self._curves = curves

    def _interval(self, name: str) -> Interval:
        of = self.results[name]
        return Interval(*(np.nan if of[name] is None else of[name] for name in ("value", "low", "high")))

    @property
    def mean_velocity(self) -> Interval:
        """Mean velocity [m/s]."""
        return self._interval("mean_velocity_m_s")

    @property
    def turbulence_intensity(self) -> Interval:
        """Rms of a fluctuating component over the mean velocity [-]."""
        return self._interval("turbulence_intensity")

    @property
    def integral_time(self) -> Interval:
        """Integral time of the component along the flow [s]."""
        return self._interval("integral_time_s")

    @property
    def length_scale(self) -> Interval:
        """Integral length scale by Taylor's hypothesis [m]."""
        return self._interval("length_scale_m")

    @property
    def cutoff_frequency(self) -> Interval:
        """Cut-off frequency of the flat spectrum with the same variance and plateau [Hz]."""
        return self._interval("cutoff_frequency_hz")

    @property
    def warnings(self) -> list[str]:
        """Warnings about the record and the results."""
        return list(self.results["warnings"])

    def spectrum(self, component: int = 0) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Frequencies [Hz] and one-sided spectral density [(m/s)²/Hz] of a component."""
        frequencies, density, *_ = self._curves[component]
        return frequencies, density

    def autocorrelation(self, component: int = 0) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lags [s] and autocorrelation coefficients [-] of a component."""
        *_, lags, coefficients = self._curves[component]
        return lags, coefficients

    def air(self) -> dict[str, float]:
        """The four keys of a case that follow from the record; `case.with_(analysis.air())` is the case in this air."""
        return {
            "air.velocity": self.mean_velocity.value,
            "air.turbulence_intensity": self.turbulence_intensity.value,
            "air.length_scale": self.length_scale.value,
            "air.cutoff_frequency": self.cutoff_frequency.value,
        }

    def apply(self, case: Case) -> Case:
        """The case in this air."""
        return case.with_(self.air())

    def __repr__(self) -> str:
        u, tu, scale = self.mean_velocity, self.turbulence_intensity, self.length_scale
        return f"<Analysis: {u.value:.4g} m/s, turbulence {100 * tu.value:.3g} %, length scale {1e3 * scale.value:.3g} mm>"


def analyse(
    record: ArrayLike | str | os.PathLike[str],
    rate: str | float | None = None,
    *,
    mean_velocity: float | None = None,
    flat_until: float | None = None,
    integral: str | None = None,
    columns: tuple[str, ...] = (),
) -> Analysis:
    """The statistics of the air in a velocity record, as `spunlaid analyse` finds them.

    record: velocities [m/s] as an array, samples or samples × components with the one along the flow first; or the path
        of a file
    rate: sampling rate, "20 kHz" or in Hz; an array needs it
    mean_velocity: replaces the mean of the record [m/s]
    flat_until: end of the flat part of the spectrum [Hz]
    integral: the limit of the integral of the autocorrelation: "first-zero", "e-fold" or "fixed=20 ms"
    columns: of a file, the columns of velocity by name or number
    """
    if isinstance(record, os.PathLike):
        record = os.fspath(record)
    if isinstance(record, str) and _spunlaid.is_scan(record):
        raise ValueError(f"{record} is the scan of a web; spunlaid.scan({record!r}) measures how uniform it is")
    read = record if isinstance(record, str) else _velocities(record)
    return Analysis(*_spunlaid.analyse(read, rate, mean_velocity, flat_until, integral, list(columns)))


def _velocities(record: ArrayLike) -> NDArray[np.float64]:
    """An array of samples × components."""
    try:
        array = np.asarray(record, dtype=float)
    except (TypeError, ValueError):
        raise TypeError("a record is the path of a file, or an array of velocities [m/s]: samples, or samples × components") from None
    columns = array[:, None] if array.ndim == 1 else array
    if columns.ndim != 2 or not 1 <= columns.shape[1] <= 3:
        raise ValueError(f"an array of velocities has the shape (samples,) or (samples, 1 to 3 components), not {array.shape}")
    gaps = np.flatnonzero(~np.isfinite(columns).all(axis=1))
    if gaps.size:
        raise ValueError(f"sample {gaps[0]} is not finite; interpolate it, or take a part of the record without gaps")
    return columns
