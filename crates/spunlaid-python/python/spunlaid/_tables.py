"""What the files of a run hold."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from ._errors import FolderError
from ._results import Place
from ._spunlaid import measures, read_table


class Tables:
    """What the files of a run hold.

    path: their folder
    summary: text of the summary
    place: what the folder lies in, as long as it is used
    """

    def __init__(self, path: Path, summary: str, place: Place | None = None) -> None:
        self.path: Path = path
        self._place = place
        try:
            self._read: dict[str, Any] = json.loads(summary)
        except ValueError as error:
            raise FolderError(f"{path}: is not the results of a run: summary.json: {error}") from error
        if not isinstance(self._read, dict) or not {"end_node", "laydown"} & set(self._read):
            raise FolderError(f"{path}: is not the results of a run: summary.json is that of another product")

    @property
    def numbers(self) -> list[dict[str, Any]]:
        """The measures of summary.json."""
        found: list[dict[str, Any]] = []
        for of in measures():
            group: Any = self._read
            for name in of["group"].split("."):
                group = group.get(name, {})
            if of["column"] in group:
                number = group[of["column"]]
                values = np.array([np.nan if value is None else value for value in number["values"]], dtype=float)
                values.setflags(write=False)
                mean = np.nan if number["mean"] is None else number["mean"]
                shown = number.get("median", number.get("largest", mean))
                chance = number["standard_error"]
                errors = {"standard_error": _known(chance), "error": _known(number.get("error", chance))}
                found.append({**of, "mean": mean, **errors, "shown": shown, "values": values})
        return found

    def differences(self, name: str) -> dict[str, float | None] | None:
        """What a check has found, `step_check` or `mesh_check`; None if it was not made."""
        check = self._read[name]
        if check is None:
            return None
        found = {name: check[name] for name in ("duration_s", "share_of_run")}
        for difference, of in check.items():
            if difference.endswith("_difference") and isinstance(of, dict):
                found[difference] = of["mean"]
                found[f"{difference}_standard_error"] = of["standard_error"]
                found[f"{difference.removesuffix('_difference')}_error_over_difference"] = of["error_over_difference"]
        return found

    @property
    def end_node(self) -> dict[str, Any]:
        """Columns of end_node.parquet."""
        return self._over_time("end_node.parquet")

    @property
    def energy(self) -> dict[str, Any]:
        """Columns of energy.parquet."""
        return self._over_time("energy.parquet")

    @property
    def laid(self) -> list[dict[str, Any]]:
        """Columns of laid.parquet by replicate."""
        table = self._table("laid.parquet")
        if not table:
            return []
        replicate = table.pop("replicate").astype(int)
        count = self._read["replicates"]
        ends = np.searchsorted(replicate, np.arange(1, count + 2))
        return [{name: of[ends[i] : ends[i + 1]] for name, of in table.items()} for i in range(count)]

    @property
    def shapes(self) -> tuple[Any, Any]:
        """The shapes for ParaView."""
        try:
            series = ElementTree.parse(self.path / "shape.pvd").getroot().iter("DataSet")
        except OSError:
            return np.empty(0), np.empty((0, 0, 0, 3))
        times: list[float] = []
        shapes: list[list[Any]] = []
        for entry in series:
            times.append(float(entry.attrib["timestep"]))
            shapes.append(_lines(self.path / entry.attrib["file"]))
        nodes = max((len(line) for shape in shapes for line in shape), default=0)
        positions = np.full((len(shapes[0]) if shapes else 0, len(times), nodes, 3), np.nan)
        for instant, shape in enumerate(shapes):
            for replicate, line in enumerate(shape):
                positions[replicate, instant, : len(line)] = line
        return np.array(times), positions

    def _over_time(self, name: str) -> dict[str, Any]:
        table = self._table(name)
        if not len(table.get("replicate", ())):
            return {}
        replicate, times = table.pop("replicate").astype(int), table.pop("time_s")
        instants = int(np.searchsorted(replicate, replicate[0], side="right"))
        shaped = {name: self._with_lost(of.reshape(-1, instants), replicate[::instants]) for name, of in table.items()}
        return {"time_s": times[:instants], **shaped}

    def _with_lost(self, rows: Any, replicate: Any) -> Any:
        """The rows of a table, and NaN for each fibre that was lost."""
        if len(rows) == self._read["replicates"]:
            return rows
        every = np.full((self._read["replicates"], rows.shape[1]), np.nan)
        every[replicate - 1] = rows
        every.setflags(write=False)
        return every

    def _table(self, name: str) -> dict[str, Any]:
        if not self.path.exists():
            raise FolderError(f"{self.path}: this folder, with what was recorded, has been removed; make the results again")
        if not (self.path / name).exists():
            return {}
        return read_table(self.path / name)


def _known(number: float | None) -> float:
    """A number; NaN if it is not known."""
    return np.nan if number is None else number


def _lines(path: Path) -> list[Any]:
    """The points of each line of a VTK PolyData file."""
    root = ElementTree.parse(path).getroot()
    points = root.find(".//Points/DataArray")
    offsets = root.find(".//Lines/DataArray[@Name='offsets']")
    if points is None or offsets is None:
        raise FolderError(f"{path}: has no lines")
    numbers = np.array((points.text or "").split(), dtype=float).reshape(-1, 3)
    return np.split(numbers, np.array((offsets.text or "").split(), dtype=int)[:-1])
