"""Computes an input with the Python package, and prints its summary and what differs between its arrays and tables.

    same.py COMMAND INPUT FOLDER [KEY=VALUE …]       FOLDER is what the program has made of the same input
"""

from __future__ import annotations

import json
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import polars
import spunlaid

GROUPS = ("end_node", "laydown", "fibre", "energy", "surrogate")


def number(value: float | None) -> float:
    """A number of a summary, where what is not known is null."""
    return float("nan") if value is None else value


def columns_of(result: Any) -> dict[str, np.ndarray]:
    """Arrays of a result by the names of their columns, one replicate after the other."""
    over_time = {**getattr(result, "end_node", {}), **getattr(result, "energy", {})}
    arrays = {name: of.ravel() for name, of in over_time.items() if of.ndim == 2}
    laid = getattr(result, "laid", None) or [{}]
    arrays |= {name: np.concatenate([of[name] for of in laid]) for name in laid[0]}
    return arrays | dict(getattr(result, "stations", {}))


def differing(result: Any, folder: Path) -> list[str]:
    """Measures that are not as in the summary, and columns of files that are not as the arrays."""
    found, compared = [], 0
    if hasattr(result, "case"):
        entries = {name: entry for group in GROUPS for name, entry in result.summary.get(group, {}).items()}
        for name, measure in result.measures.items():
            entry = entries.get(name)
            for attribute in ("mean", "error", "standard_error"):
                own = getattr(measure, attribute)
                if isinstance(entry, dict) and attribute in entry:
                    compared += 1
                    if not np.array_equal(own, number(entry[attribute]), equal_nan=True):
                        found.append(f"measures[{name!r}].{attribute} is {own}, in the summary {entry[attribute]}")
    if hasattr(result, "patches"):
        patches = result.summary["web"]["patches"]
        # Others have another name in the summary.
        for name in [name for name in result.patches if any(name in patch for patch in patches)]:
            of, wanted = result.patches[name], [number(patch.get(name)) for patch in patches]
            compared += 1
            if not np.array_equal(of, wanted, equal_nan=True):
                found.append(f"patches[{name!r}] is {of}, in the summary {wanted}")
        compared += 1
        kept = np.load(folder / "map.npy")
        if not np.array_equal(result.map.astype(kept.dtype), kept):
            found.append("map is not that of map.npy")
    arrays = columns_of(result)
    for file in sorted(folder.glob("*.parquet")):
        table = polars.read_parquet(file)
        for name in [name for name in table.columns if name in arrays and len(table) == len(arrays[name])]:
            compared += 1
            if not np.array_equal(table[name].to_numpy().astype(float), arrays[name].astype(float), equal_nan=True):
                found.append(f"{name} is not that of {file.name}")
    return found if compared else ["nothing of the arrays was compared"]


def main() -> None:
    warnings.simplefilter("ignore")
    command, path, folder, *words = sys.argv[1:]
    changes = dict(word.split("=", 1) for word in words)
    try:
        result = getattr(spunlaid, command)(path, set=changes)
    except spunlaid.Error as error:
        sys.exit(str(error))
    json.dump({"summary": result.summary, "differing": differing(result, Path(folder))}, sys.stdout)


main()
