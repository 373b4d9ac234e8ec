"""The compiled part of spunlaid."""

import os
from collections.abc import Callable, ItemsView, Iterator, KeysView, Mapping, Sequence, ValuesView
from typing import Any, Final, Literal, TypedDict, final, type_check_only

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "Case",
    "Flight",
    "AirSampler",
    "Computed",
    "Study",
    "__version__",
    "analyse",
    "analyse_scan",
    "check_figures",
    "column_unit",
    "compare_folders",
    "copy_results",
    "find_drag_factor",
    "find_fit",
    "fly",
    "fly_bundle",
    "is_scan",
    "keys",
    "lay_web",
    "measures",
    "patch_numbers",
    "program",
    "read_table",
    "solve_spinline",
]

__version__: str

_Floats = NDArray[np.float64]
_Progress = Callable[[int, int], object] | None
_Figures = tuple[Any, str | float | None]
_Scale = tuple[str, float, float, bool]
@type_check_only
class _ComputedReplicate(TypedDict):
    point: int
    replicate: int
    values: list[float]
    lost: tuple[int, float] | None

@type_check_only
class _BundlePart(TypedDict):
    point: int
    noun: str
    text: str
    checksum: int
    first: int
    end: int

@final
class Case(Mapping[str, Any]):
    """A fibre, the air around it and how its flight is computed: a case file, read and checked, that can be run."""

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Case:
        """Reads and checks a case file."""

    @classmethod
    def from_text(cls, text: str, name: str = "Case") -> Case:
        """A case from the text of a case file (TOML)."""

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Case:
        """A case from a dict of its tables, or of full keys."""

    @classmethod
    def starter(cls, fed: bool = False) -> Case:
        """The case to start from."""

    def with_(self, values: Mapping[str, Any]) -> Case:
        """The same case with other values."""

    def __getitem__(self, key: str, /) -> Any:
        """The value of a key in SI units."""

    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[str]: ...
    def __contains__(self, key: object, /) -> bool: ...
    def get(self, key: str, default: Any = None) -> Any:
        """The value of a key in SI units, or `default`."""

    def keys(self) -> KeysView[str]:
        """The keys of this case."""

    def values(self) -> ValuesView[Any]:
        """Their values."""

    def items(self) -> ItemsView[str, Any]:
        """The keys with their values."""

    def to_dict(self) -> dict[str, dict[str, Any]]:
        """The values of all keys by table, in SI units."""

    def to_toml(self) -> str:
        """The case as a case file with every key, in SI units."""

    def air_at(self, points: ArrayLike, axes: Literal["line", "field"] | None = None) -> dict[str, _Floats]:
        """The air at places, in SI units: an array for each column of `spunlaid air --at`."""

    @property
    def notes(self) -> list[str]:
        """Notes and warnings about the case."""

    @property
    def name(self) -> str:
        """The name of the case file."""

    @property
    def instants(self) -> int:
        """Number of recorded instants of a run."""

    @property
    def step_limits(self) -> dict[str, float]:
        """The limits on the time step [s] and what sets them."""

@final
class AirSampler:
    def __new__(cls, case: Case, replicate: int) -> AirSampler: ...
    def velocities(self, times: _Floats, places: _Floats) -> _Floats: ...
    extent: Final[tuple[float, float]]

@final
class Flight:
    """Fibres in flight, which you step."""

    def __new__(
        cls, case: Case | str | os.PathLike[str] | Mapping[str, Any], replicates: int | None = None
    ) -> Flight: ...
    def step(self, duration: str | float) -> None:
        """Advances all fibres by a time, "10 ms" or in seconds, to the nearest whole step."""

    def step_to(self, time: str | float) -> None:
        """Advances all fibres to a time, "10 ms" or in seconds, to the nearest whole step."""

    def set(self, key: str, value: str | float | Sequence[float]) -> None:
        """Changes a key while the fibres fly."""

    def take_laid(self) -> list[dict[str, _Floats]]:
        """What each fed fibre has laid on the belt since the last call."""

    @property
    def time(self) -> float:
        """Time of the positions [s]."""

    @property
    def time_step(self) -> float:
        """The time step [s]."""

    @property
    def fibres(self) -> int:
        """Number of fibres."""

    @property
    def positions(self) -> _Floats:
        """Positions of the nodes now [m]: fibres × nodes × 3."""

    @property
    def velocities(self) -> _Floats:
        """Velocities of the nodes now [m/s]: fibres × nodes × 3."""

    @property
    def tensions(self) -> _Floats:
        """Tensions of the elements now [N]: fibres × elements."""

    @property
    def energies(self) -> dict[str, _Floats]:
        """Energies and works now [J], a number for each fibre."""

@final
class Computed:
    """Results of a run, a web, a scan, a spinline or a comparison."""

    name: Final[str]
    summary: Final[str]
    map: Final[_Floats | None]
    curves: Final[list[dict[str, Any]]]
    shapes: Final[tuple[_Floats, _Floats]]
    stations: Final[list[dict[str, _Floats]]]
    text: Final[str | None]
    def report(self) -> str: ...
    def save(self, path: str, force: bool, figures: _Figures, written: str | None = None) -> None: ...
    def specification(self) -> bytes | None: ...

@final
class Study:
    """A study: its points, its journal and its results."""

    def __new__(
        cls,
        study: str,
        case: Case | None = None,
        path: str | None = None,
        out: str | None = None,
        force: bool = False,
        points: int | None = None,
        replicates: int | None = None,
        set: Mapping[str, Any] | None = None,  # noqa: A002
        threads: int | None = None,
    ) -> Study: ...
    def __len__(self) -> int: ...
    def fly(self, threads: int | None = None, progress: _Progress = None) -> None: ...
    def begin_round(self, flights: int) -> int: ...
    def bundle(self, index: int) -> tuple[list[_BundlePart], list[float]]: ...
    def add(self, rows: list[_ComputedReplicate]) -> int: ...
    def next_round(self) -> bool: ...
    def results(self) -> dict[str, Any]: ...
    def replicates(self) -> _Floats: ...
    def effects(self) -> list[tuple[Any, ...]]: ...
    def write(self, figures: _Figures) -> None: ...
    def save(self, path: str, force: bool, figures: _Figures) -> None: ...
    def point_text(self, point: int) -> str: ...
    fibres: Final[tuple[int, int]]
    noun: Final[str]
    work: Final[float]
    one_web_a_machine: Final[bool]
    inputs: Final[list[dict[str, Any]]]
    name: Final[str]
    design: Final[str]
    notes: Final[list[str]]
    measures: Final[list[tuple[str, str, str, str, _Scale]]]

def check_figures(figures: _Figures) -> None: ...
def solve_spinline(path: str | None, changes: Mapping[str, Any]) -> Computed: ...
def find_drag_factor(path: str | None, titre: str | float, changes: Mapping[str, Any]) -> float: ...
def fly(
    case: Case,
    place: str | os.PathLike[str],
    threads: int | None = None,
    progress: _Progress = None,
    check_step: bool = True,
    shapes: bool = True,
) -> Computed: ...
def fly_bundle(parts: list[_BundlePart], sides: list[float], threads: int = 1) -> list[_ComputedReplicate]: ...
def analyse(
    record: _Floats | str,
    rate: str | float | None = None,
    mean_velocity: float | None = None,
    flat_until: float | None = None,
    integral: str | None = None,
    columns: list[str] = ...,
) -> tuple[str, str, list[list[_Floats]]]: ...
def find_fit(
    path: str,
    to: str,
    names: list[str],
    low: Mapping[str, Any],
    high: Mapping[str, Any],
    changes: Mapping[str, Any],
    spectrum: bool,
    webs: int,
    out: str | None,
    figures: _Figures,
    threads: int | None = None,
    progress: _Progress = None,
) -> tuple[str, list[str]]: ...
def lay_web(
    path: str | None,
    changes: Mapping[str, Any],
    advice: bool = False,
    assumed_values: bool = True,
    threads: int | None = None,
    progress: _Progress = None,
) -> Computed: ...
def analyse_scan(picture: str | bytes, options: dict[str, Any]) -> Computed: ...
def column_unit(name: str) -> str: ...
def compare_folders(folders: Sequence[str]) -> Computed: ...
def copy_results(source: str | os.PathLike[str], target: str | os.PathLike[str], force: bool) -> None: ...
def is_scan(path: str | os.PathLike[str]) -> bool: ...
def keys(web: bool = False) -> list[tuple[Any, ...]]: ...
def measures() -> list[dict[str, Any]]: ...
def patch_numbers() -> list[list[str]]: ...
def program(words: Sequence[str | bytes | os.PathLike[str]]) -> int: ...
def read_table(path: str | os.PathLike[str]) -> dict[str, Any]: ...
