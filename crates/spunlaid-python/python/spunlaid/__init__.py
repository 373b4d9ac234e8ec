"""Fibres in turbulent air: NumPy in, NumPy out.

    import spunlaid

    case = spunlaid.Case.starter().with_({"air.velocity": "20 m/s", "fibre.diameter": 18e-6})
    run = spunlaid.run(case, replicates=8)
    run.measures["amplitude_y_m"].mean          # [m]
    run.end_node["y_m"]                         # replicates x times [m]

Numbers are in SI units, and the names of columns carry theirs: `y_m`, `frequency_y_hz`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._errors import (
    CaseError,
    ClusterError,
    Diagnostic,
    Error,
    FibreLost,
    FileError,
    FlightError,
    FolderError,
    InternalError,
    Interrupted,
    SpunlaidWarning,
)
from ._keys import Key, keys
from ._spunlaid import Case, Flight, __version__

if TYPE_CHECKING:
    from ._air import Air
    from ._analysis import Analysis, analyse
    from ._comparison import Comparison, compare
    from ._fit import Fit, fit
    from ._measures import Curve, Measure, Measures, Shapes
    from ._load import load
    from ._run import Run, run
    from ._scan import Scan, scan
    from ._spinline import Spinline, find_drag_factor, spin
    from ._study import Study, sweep
    from ._web import Web, web

__all__ = [
    "Air",
    "Analysis",
    "Case",
    "CaseError",
    "ClusterError",
    "Comparison",
    "Curve",
    "Diagnostic",
    "Error",
    "FibreLost",
    "FileError",
    "Fit",
    "Flight",
    "FlightError",
    "FolderError",
    "InternalError",
    "Interrupted",
    "Key",
    "Measure",
    "Measures",
    "Run",
    "Scan",
    "Shapes",
    "Spinline",
    "SpunlaidWarning",
    "Study",
    "Web",
    "__version__",
    "analyse",
    "compare",
    "find_drag_factor",
    "fit",
    "keys",
    "load",
    "run",
    "scan",
    "spin",
    "sweep",
    "web",
]

_LATER = {
    name: file
    for file, names in {
        "_air": ["Air"],
        "_analysis": ["Analysis", "analyse"],
        "_comparison": ["Comparison", "compare"],
        "_fit": ["Fit", "fit"],
        "_measures": ["Curve", "Measure", "Measures", "Shapes"],
        "_load": ["load"],
        "_run": ["Run", "run"],
        "_scan": ["Scan", "scan"],
        "_spinline": ["Spinline", "find_drag_factor", "spin"],
        "_study": ["Study", "sweep"],
        "_web": ["Web", "web"],
    }.items()
    for name in names
}


def __getattr__(name: str) -> Any:
    """What needs NumPy is imported when it is first used: the program `spunlaid` has no use for it."""
    if name in _LATER:
        from importlib import import_module

        value = getattr(import_module(f".{_LATER[name]}", __name__), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *_LATER])
