"""Which adjoints the proofs reach, as functions from texts that can be tested."""

from __future__ import annotations

import re
from collections.abc import Mapping

_DEFINITION = re.compile(r"\bvoid\s+(\w*_backward\w*)\s*\(")
_CALL = re.compile(r"\b(\w*_backward\w*)\s*(?:<[^;{}()]*>\s*)?\(")
_ADAPTER = re.compile(r"\bstruct\s+(\w+Op)\s*\{")
_LIST = re.compile(r"using\s+Ops\s*=\s*TypeList<(.*?)>;", re.DOTALL)


def unproved(texts: Mapping[str, str]) -> list[str]:
    """Adjoints defined in headers that no adapter of `Ops` reaches; `texts` maps names to sources.

    Files named `*op_list.h` hold the adapters. An adjoint that a proved one calls is proved, too.
    """
    headers = {name: text for name, text in texts.items() if not name.endswith("op_list.h")}
    lists = [text for name, text in texts.items() if name.endswith("op_list.h")]
    bodies: dict[str, str] = {}
    for text in headers.values():
        for match in _DEFINITION.finditer(text):
            bodies[match[1]] = bodies.get(match[1], "") + _block(text, match.end())
    reached = {call for body in _registered(lists) for call in _CALL.findall(body)}
    fresh = set(reached)
    while fresh:
        fresh = {c for name in fresh for c in _CALL.findall(bodies.get(name, ""))} - reached
        reached |= fresh
    return sorted(set(bodies) - reached)


def _registered(lists: list[str]) -> list[str]:
    """Bodies of the adapters that `Ops` names."""
    (names,) = (match for text in lists for match in _LIST.findall(text))
    wanted = set(re.findall(r"\b\w+Op\b", names))
    bodies = {m[1]: _block(text, m.end() - 1) for text in lists for m in _ADAPTER.finditer(text)}
    return [bodies[name] for name in sorted(wanted)]


def _block(text: str, start: int) -> str:
    """From the next brace after `start` to the one that closes it."""
    first = text.index("{", start)
    depth = 0
    for at in range(first, len(text)):
        depth += {"{": 1, "}": -1}.get(text[at], 0)
        if depth == 0:
            return text[first : at + 1]
    raise ValueError("a brace is not closed")
