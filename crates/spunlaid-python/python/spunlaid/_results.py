"""What the results of a run, of a web, of a scan, of a spinline and of a comparison have in common."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from html import escape
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp
from typing import Any
from weakref import finalize

from ._errors import FolderError
from ._spunlaid import Computed, copy_results


def _remove(path: Path, owner: int) -> None:
    # A forked process ends too, and the folder is still its parent's.
    if os.getpid() == owner:
        rmtree(path, ignore_errors=True)


class Place:
    """A folder of its own, as long as the process uses it that has made it."""

    def __init__(self) -> None:
        self.path: Path = Path(mkdtemp(prefix="spunlaid-"))
        finalize(self, _remove, self.path, os.getpid())


def read_files(folder: Path) -> dict[str, bytes]:
    """The files of a folder, by their names in it."""
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def write_files(folder: Path, files: dict[str, bytes]) -> None:
    """Writes what `read_files` has read."""
    for file, content in files.items():
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).write_bytes(content)


class Kept:
    """Results in place of what was computed: the files of their folder.

    path: the folder; without it they are written to one of their own
    files: of results that were pickled, by their names
    name: what they are called
    """

    def __init__(self, path: str | os.PathLike[str] | None, files: dict[str, bytes] | None = None, name: str = "") -> None:
        self.files: dict[str, bytes] | None = files
        self.name: str = name
        if path is None:
            self._place = Place()
            path = self._place.path
            write_files(path, files or {})
        self.path: Path = Path(path)
        try:
            self.summary: str = (self.path / "summary.json").read_text("utf-8")
        except (OSError, ValueError) as error:
            raise FolderError(f"{self.path}: is not the results of a run: summary.json: {error}") from error

    def report(self) -> str:
        """Text of report.html."""
        return (self.path / "report.html").read_text("utf-8")

    def save(self, path: str, force: bool, figures: tuple[Any, Any]) -> None:
        """Copies the folder, as the program replaces one: results there go when the copy is whole, and files of others stay."""
        if figures != (None, None):
            raise ValueError(
                "figures: results that were read from a folder or a pickle are copied with their figures as they are; leave"
                " figures and figure_width out, or compute them again"
            )
        copy_results(self.path, Path(path), force)

    def __reduce__(self) -> tuple[Any, ...]:
        return Kept, (None if self.files else self.path.absolute(), self.files, self.name)


class Results:
    """Results with a summary, a report and a folder. A notebook shows the report.

    computed: what the compiled part has computed, or the files of a folder
    """

    def __init__(self, computed: Computed | Kept) -> None:
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
        return list(self.summary["notes"])

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
        self._save(os.fspath(path), force, (figures, figure_width))

    def _save(self, path: str, force: bool, figures: tuple[Any, Any], whole: bool = True) -> None:
        # whole: whether all that the program writes must be there
        self._computed.save(path, force, figures)

    def _packed(self) -> Kept:
        """What the results are pickled as: their folder."""
        if isinstance(self._computed, Kept):
            return self._computed
        place = Place()
        folder = place.path / "results"
        self._save(str(folder), False, (None, None), whole=False)
        return Kept(None, read_files(folder), self._computed.name)

    def _repr_html_(self) -> str:
        page = escape(self.report(), quote=True)
        # Its scripts run in an origin of their own, not in that of the notebook.
        rights, style = "allow-scripts allow-popups allow-downloads", "width: 100%; height: 720px; border: 1px solid #ccc"
        return f'<iframe sandbox="{rights}" srcdoc="{page}" style="{style}"></iframe>'
