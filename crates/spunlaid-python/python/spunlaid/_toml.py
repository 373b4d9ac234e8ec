"""Writes a study that is given as a dict."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from ._keys import Key, keys
from ._law import LAWS, law_file


def study_toml(study: Mapping[str, Any]) -> str:
    """The text of a study file. Numbers of keys with a dimension are in SI units."""
    known = keys(web="web" in study) | keys()
    lines: list[str] = [] if "design" in study else ['design = "grid"']
    tables: list[str] = []
    for name, value in study.items():
        if name in ("case", "web", "spinline"):
            lines.append(f'{name} = "{name}.toml"')
        elif isinstance(value, Mapping) and name in ("vary", "link", "set"):
            tables.append(f"\n[{name}]")
            for key, of in value.items():
                if name == "vary" and _plain(key) in LAWS and isinstance(of, (list, tuple)):
                    of = [os.fspath(law) if isinstance(law, (str, os.PathLike)) else law_file(key, law) for law in of]
                tables.append(f"{_text(key)} = {_value(key, of, known.get(_plain(key)))}")
        else:
            lines.append(f"{_text(name)} = {_value(name, value, None)}")
    return "\n".join(lines + tables) + "\n"


def _plain(name: Any) -> Any:
    """The name of a key without its layer and row: `line.rows.pitch` of `layer.2.line.rows.1.pitch`."""
    return re.sub(r"^layer\.[^.]+\.|(?<=rows\.)\d+\.", "", name) if isinstance(name, str) else name


def _text(text: Any) -> str:
    if not isinstance(text, str):
        raise TypeError(f"the names in a study must be str, not {type(text).__name__}")
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(name: str, value: Any, key: Key | None) -> str:
    """A value as TOML.

    name: what a message calls it
    key: the key of a case or a web that it belongs to
    """
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, float, np.integer, np.floating)):
        if key is not None and key.unit:
            return f'"{float(value)!r} {key.unit}"'
        return str(int(value)) if isinstance(value, (int, np.integer)) else repr(float(value))
    if isinstance(value, Mapping):
        # The number of levels of a range has no unit.
        parts = (f"{_text(part)} = {_value(name, of, None if part == 'steps' else key)}" for part, of in value.items())
        return "{ " + ", ".join(parts) + " }"
    # Columns of tables, of pandas, polars and Arrow.
    for listed in ("tolist", "to_list", "to_pylist"):
        if not isinstance(value, np.ndarray) and hasattr(value, listed):
            value = getattr(value, listed)()
            break
    if isinstance(value, (list, tuple, np.ndarray, range)):
        return "[" + ", ".join(_value(name, part, key) for part in value) + "]"
    raise TypeError(f"{name} takes texts, numbers, lists and dicts, not {type(value).__name__}")
