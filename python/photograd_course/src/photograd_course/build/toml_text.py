"""Write the little TOML that kits need: strings, numbers, lists, tables of these."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from ..errors import DtypeError, message


def toml_value(value: Any) -> str:
    """One value as TOML; lists and tables stay on their line.

    Raises:
        DtypeError: a type that is not needed here.
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _string(value)
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, Mapping):
        inside = ", ".join(f"{toml_key(key)} = {toml_value(item)}" for key, item in value.items())
        return f"{{ {inside} }}" if inside else "{}"
    if isinstance(value, Sequence):
        return "[" + ", ".join(toml_value(item) for item in value) + "]"
    raise DtypeError(message("toml_value", "value", "str, number, list or table", type(value)))


def toml_key(key: str) -> str:
    """A key, in quotes where it needs them ("01.p1" would otherwise be two keys)."""
    bare = key.replace("_", "").replace("-", "")
    return key if bare.isascii() and bare.isalnum() else _string(key)


def tables(name: str, entries: Sequence[Mapping[str, Any]]) -> str:
    """An array of tables, ``[[name]]`` each."""
    parts = [
        f"[[{name}]]\n" + "".join(f"{toml_key(k)} = {toml_value(v)}\n" for k, v in entry.items())
        for entry in entries
    ]
    return "\n".join(parts)


def _string(text: str) -> str:
    # JSON and TOML escape alike, but TOML forbids a bare DEL.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007F")
