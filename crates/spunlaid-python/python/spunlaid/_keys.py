"""The keys of a case and of a web."""

from __future__ import annotations

from typing import NamedTuple

from . import _spunlaid


class Key(NamedTuple):
    """A key of a case or of a web."""

    name: str
    """Full name, `air.velocity`."""
    unit: str | None
    """The SI unit of its values; None if they are no quantities, an empty text for a plain number."""
    allowed: str
    """What it takes, in words."""
    words: list[str]
    """The words that it takes; empty for numbers."""
    required: bool
    """Whether a case must have it."""
    left_out: str
    """The default, or what it follows from; an example for a required key."""
    meaning: str
    """Its meaning."""
    synonyms: list[str]
    """Other words for it."""
    label: str
    """Its label in figures."""
    varies: bool
    """Whether a study may vary it."""
    in_flight: bool
    """Whether it may change during a flight."""
    usual: tuple[float, float] | None
    """The usual smallest and largest value, in SI units."""


def keys(*, web: bool = False) -> dict[str, Key]:
    """Every key of a case, or of a web, by its full name, in the order of a file: `keys()["air.velocity"].meaning`."""
    return {key[0]: Key(*key) for key in _spunlaid.keys(web)}
