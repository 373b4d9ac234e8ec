"""Packages that only some functions need."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def needed(module: str, extra: str, purpose: str) -> Any:
    """A module of a package that may be absent.

    extra: the extra of spunlaid that installs it
    purpose: what needs it
    """
    try:
        return import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        raise ImportError(f'{purpose} needs {package}, which is not installed: pip install "spunlaid[{extra}]"') from error
