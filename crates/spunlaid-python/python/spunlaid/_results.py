"""What the results of a run, of a web, of a scan, of a spinline and of a comparison have in common."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any


def packed(save: Callable[[str], None]) -> dict[str, bytes]:
    """The files of the folder that `save` writes, by their names in it: what results are pickled as."""
    with TemporaryDirectory() as place:
        folder = Path(place) / "results"
        save(str(folder))
        return {path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def unpack(files: dict[str, bytes], folder: Path) -> None:
    """Writes them into a folder."""
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)


class Results:
    """Results with a summary, a report and a folder. A notebook shows the report.

    computed: what the compiled part has computed, or what was read from a folder
    """

    def __init__(self, computed: Any) -> None:
        self._computed = computed
        self._kept: dict[str, Any] = {}

    def _keep(self, name: str, make: Any) -> Any:
        # Two threads may both make it; the values are equal.
        if name not in self._kept:
            self._kept[name] = make()
        return self._kept[name]

    @property
    def summary(self) -> dict[str, Any]:
        """What `summary.json` of a results folder holds."""
        return dict(self._keep("summary", lambda: json.loads(self._computed.summary)))

    @property
    def notes(self) -> list[str]:
        """Notes and warnings."""
        return list(self._computed.notes)

    def report(self) -> str:
        """The report, one page of HTML that works offline."""
        return self._keep("report", self._computed.report)  # type: ignore[no-any-return]

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        force: bool = False,
        figures: Sequence[str] | str | None = None,
        figure_width: str | float | None = None,
    ) -> None:
        """Writes the folder that the program writes: `spunlaid run`, `spunlaid web`, `spunlaid analyse`, `spunlaid compare` or
        `spunlaid spin`.

        force: whether results that the folder holds are replaced.
        figures: the formats of the figures, `["pdf", "png"]`; SVG and PNG if it is left out
        figure_width: their width in print, `"one-column"`, `"two-columns"`, `"90 mm"` or in metres; PNG then has 300 dpi
        """
        self._computed.save(os.fspath(path), force, (figures, figure_width))

    def _repr_html_(self) -> str:
        page = escape(self.report(), quote=True)
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 720px; border: 1px solid #ccc"></iframe>'
