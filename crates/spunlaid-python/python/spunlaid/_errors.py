"""The exceptions and warnings of spunlaid."""

from __future__ import annotations

from typing import Any, NamedTuple


class Error(Exception):
    """Any error of spunlaid."""


class SpunlaidWarning(UserWarning):
    """What the program prints as a warning: the results may mislead. `warnings.filterwarnings("error", category=...)` makes an
    error of it."""

    def __init__(self, text: str, key: str | None = None) -> None:
        super().__init__(text)
        self.key = key
        """The key that it is about, `air.velocity`; None if it is about none."""

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.args[0], self.key)


class Diagnostic(NamedTuple):
    """One reason why a case, a study or a web cannot be run."""

    key: str | None
    """The key, `air.velocity`; None if it is not about a key."""
    value: str | None
    """The value as it was written."""
    message: str
    """What is wrong."""
    remedy: str | None
    """What to do about it."""
    file: str | None
    """The file where it was written; None for a value that was given in Python."""
    line: int | None
    """The line, counted from 1."""
    column: int | None
    """The column, counted from 1."""
    text: str
    """All of it as one sentence."""


class CaseError(Error, ValueError):
    """A case, a study or a web that cannot be run. `problems` lists all reasons; the other attributes are those of the
    first one."""

    def __init__(self, text: str, problems: list[tuple[Any, ...]] | None = None) -> None:
        super().__init__(text)
        self.problems: list[Diagnostic] = [Diagnostic(*problem) for problem in problems or []]

    @property
    def first(self) -> Diagnostic | None:
        """The first problem."""
        return self.problems[0] if self.problems else None

    @property
    def key(self) -> str | None:
        """The key, `air.velocity`."""
        return self.first.key if self.first else None

    @property
    def value(self) -> str | None:
        """The value as it was written."""
        return self.first.value if self.first else None

    @property
    def file(self) -> str | None:
        """The file where it was written."""
        return self.first.file if self.first else None

    @property
    def line(self) -> int | None:
        """The line of the file, counted from 1."""
        return self.first.line if self.first else None

    @property
    def remedy(self) -> str | None:
        """What to do about it."""
        return self.first.remedy if self.first else None

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.args[0], [tuple(problem) for problem in self.problems])


class FileError(Error):
    """A file that cannot be used: it is not there, or it is not what it should be."""


class FolderError(Error):
    """A folder of results that cannot be written or read."""


class FlightError(Error):
    """Fibres that cannot be simulated together, or a simulation that cannot do what is asked of it."""


class FibreLost(Error):
    """A fibre whose computation diverges, or that does not reach the belt."""


class ClusterError(Error):
    """Machines that do not agree about a study."""


class Interrupted(Error):
    """A computation that was stopped from outside."""


class InternalError(Error):
    """A fault of spunlaid itself. Please report it."""
