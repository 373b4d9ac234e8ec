"""Results from their folders."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from ._errors import FolderError
from ._results import Kept


def load(path: str | os.PathLike[str]) -> Any:
    """The results in a folder, as the program or `save` wrote them: a Run, a Web, a Scan, a Spinline or a Study.

    A run has what the files hold: summary, measures, end_node, energy, shapes, laid and the report; no curves. A web and a scan
    have their map, and a study can be continued. Results of another kind raise FolderError.
    """
    folder = Path(path)
    if (folder / "study.toml").is_file():
        from ._study import of_folder

        return of_folder(folder)
    kept = Kept(folder)
    try:
        summary = json.loads(kept.summary)
    except ValueError as error:
        raise FolderError(f"{folder}: is not the results of a run: summary.json: {error}") from error
    holds = set(summary) if isinstance(summary, dict) else set()
    if "spinline" in holds and not {"end_node", "laydown"} & holds:
        from ._spinline import Spinline

        return Spinline(kept)
    if "web" in holds and isinstance(summary["web"], dict):
        from ._scan import Scan
        from ._web import Web

        try:
            weights = np.asarray(np.load(folder / "map.npy"), dtype=float)
        except (OSError, ValueError) as error:
            raise FolderError(f"{folder}: holds no map that can be read: map.npy: {error}") from error
        return (Scan if "scan" in holds else Web)(kept, weights)
    from ._run import of_kept

    return of_kept(kept)
