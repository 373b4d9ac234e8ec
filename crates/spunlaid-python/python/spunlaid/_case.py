"""Cases, and what can be given instead of one."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from ._spunlaid import Case

CaseLike = Case | str | os.PathLike[str] | Mapping[str, Any]
"""A case, the path of a case file, or a dict of its tables or its keys."""


def case_of(case: CaseLike) -> Case:
    """The case that is meant."""
    if isinstance(case, Case):
        return case
    if isinstance(case, Mapping):
        return Case.from_dict(case)
    if isinstance(case, (str, os.PathLike)):
        return Case.read(case)
    raise TypeError(f"a case is a spunlaid.Case, the path of a case file or a dict of its tables, not {type(case).__name__}")
