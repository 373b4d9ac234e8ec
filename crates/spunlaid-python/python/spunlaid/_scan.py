"""Scans of webs."""

from __future__ import annotations

import os
from collections.abc import Sequence
from io import BytesIO
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _spunlaid
from ._sheet import Sheet

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


class Scan(Sheet):
    """A web of which there is a scan or a map. `spunlaid.scan` returns it; a notebook shows its report."""

    _scanned = True

    @property
    def patches(self) -> dict[str, NDArray[np.float64]]:
        """CV of the web over square patches, a number for each size `patch_m` [m]: `cv` with its sampling error `cv_standard_error`
        and the ends `cv_low` and `cv_high` of its interval of 95 %, `cv_noise` by the noise of the camera, and `blur_of_a_pixel`, the
        share by which one more pixel of blur lowers it. What is not known is NaN; `summary` says why."""
        return self._patches()

    @property
    def mean_known(self) -> bool:
        """Whether the mean of the map is that of the sheet; otherwise it is 1 kg/m²."""
        return self.summary["web"]["basis_weight_kg_m2"] is not None


def scan(
    picture: ArrayLike | str | os.PathLike[str],
    pixel: str | float | None = None,
    *,
    weight: str | float | None = None,
    light: str | None = None,
    lamp: str | os.PathLike[str] | None = None,
    white: float | None = None,
    keep_shading: bool = False,
    keep_spots: bool = False,
    noise: float | None = None,
    titre: str | float | None = None,
    md: str = "columns",
    patches: Sequence[str | float] = (),
) -> Scan:
    """Measures how uniform a web is from a scan or a map: bit-identical to `spunlaid analyse`.

    picture: the path of a picture (PNG, TIFF) or of a map of the basis weight (.npy, CSV); or such a map as an array of rows in
        machine direction × columns in cross direction, [kg/m²] or, with `weight`, in any unit
    pixel: side of a pixel, "0.1 mm" or in metres; PNG and TIFF may contain it
    weight: mean basis weight of the sheet, "15 g/m²" or in kg/m²
    light: what the values are: "transmitted", "reflected" or "weight"; by default transmitted light for PNG and TIFF
    lamp: picture of the lamp without web, at the same exposure
    white: grey level of the lamp without web, or in reflected light of a web too thick to see through
    keep_shading: whether the lamp is taken as even; else its shading is taken out
    keep_spots: whether all of the picture is web; else the bare lamp beside it, dust and blots are left out
    noise: standard deviation of the noise of a single pixel, which is then taken out [levels]
    titre: titre of the filaments, "2 dtex" or in kg/m; with `weight` it gives the formation number of `summary["fabric"]`
    md: where the machine direction runs in the picture, along its "columns" or its "rows"
    patches: sides of the patches, "1 mm" or in metres
    """
    if md not in ("columns", "rows"):
        raise ValueError(f'md is "columns" or "rows", not {md!r}')
    options: dict[str, Any] = {"pixel": pixel, "weight": weight, "light": light, "white": white, "noise": noise}
    options["titre"] = titre
    options |= {"keep_shading": keep_shading, "keep_spots": keep_spots, "md_along_rows": md == "rows"}
    options |= {"lamp": None if lamp is None else os.fspath(lamp), "patches": list(patches)}
    if isinstance(picture, (str, os.PathLike)):
        return Scan(_spunlaid.analyse_scan(os.fspath(picture), options))
    return Scan(_spunlaid.analyse_scan(_npy(picture), options))


def _npy(picture: ArrayLike) -> bytes:
    """An array as NumPy writes it to a file."""
    try:
        array = np.ascontiguousarray(picture, dtype=float)
    except (TypeError, ValueError):
        raise TypeError("a scan is the path of a file, or an array of basis weights: rows × columns") from None
    file = BytesIO()
    np.save(file, array, allow_pickle=False)
    return file.getvalue()
