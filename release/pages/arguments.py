"""What the docstrings of the Python package say of arguments, `name: meaning`, as a list."""

from __future__ import annotations

import re
from typing import Any

import griffe

EXPLAINED = re.compile(r"^(\w+(?:, \w+)*): ", re.MULTILINE)


class Arguments(griffe.Extension):
    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        if obj.docstring is not None:
            obj.docstring.value = EXPLAINED.sub(r"- `\1`: ", obj.docstring.value)
