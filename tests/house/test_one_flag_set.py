"""Objects that share an inline function are compiled with the same flags.

Of an inline function that several objects emit the linker keeps one copy, whichever comes first. If
flags differ, so may the copies, and the order of a link decides what is executed. Only the kernels
have flags of their own: what they emit must carry other names than what all else emits.
"""

from __future__ import annotations

import json
import re
import shlex
import shutil
import subprocess
from collections import defaultdict
from collections.abc import Iterable, Mapping
from pathlib import Path

from support.missing import missing
from support.tree import ROOT

WEAK = {"W", "V", "u", "w", "v"}
# What decides about code; not definitions, paths, warnings and dependency files.
CODE_FLAG = re.compile(r"-(O|f|m|std=|g|pthread)")


def code_flags(command: str) -> tuple[str, ...]:
    return tuple(word for word in shlex.split(command) if CODE_FLAG.match(word))


def object_of(command: str) -> str:
    words = shlex.split(command)
    return words[words.index("-o") + 1]


def by_flags(entries: Iterable[Mapping[str, str]]) -> dict[tuple[str, ...], list[str]]:
    """{flags: objects} of all that goes into the module; test programs are built otherwise."""
    found = defaultdict(list)
    for entry in entries:
        made = object_of(entry["command"])
        if "photograd_tests.dir" not in made:
            found[code_flags(entry["command"])].append(made)
    return dict(found)


def weak_names(listing: str) -> set[str]:
    """Names that `nm -P` marks as weak or unique."""
    rows = (line.split() for line in listing.splitlines())
    return {row[0] for row in rows if len(row) > 1 and row[1] in WEAK}


def shared(groups: Mapping[tuple[str, ...], set[str]]) -> list[str]:
    """Names that two groups of different flags both emit."""
    seen: set[str] = set()
    twice: set[str] = set()
    for names in groups.values():
        twice |= seen & names
        seen |= names
    return sorted(twice)


def builds() -> list[Path]:
    """Folders of builds in this tree whose objects are still there."""
    databases = sorted((ROOT / "build").glob("*/compile_commands.json"))
    return [path.parent for path in databases if next(path.parent.rglob("bvh.cpp.o"), None)]


def commands(build: Path) -> list[dict[str, str]]:
    entries: list[dict[str, str]] = json.loads((build / "compile_commands.json").read_text("utf-8"))
    return entries


def test_all_but_kernels_have_one_set_of_flags() -> None:
    if not builds():
        missing("no build is here")
    for build in builds():
        groups = by_flags(commands(build))
        others = {f for f, made in groups.items() if not all("kernels_" in name for name in made)}
        assert len(others) == 1, others


def test_objects_of_different_flags_share_no_inline_function() -> None:
    if not builds() or shutil.which("nm") is None:
        missing("no build is here, or no nm")
    for build in builds():
        groups = {}
        for flags, made in by_flags(commands(build)).items():
            files = [build / name for name in made if (build / name).exists()]
            command = ["nm", "-P", "--defined-only", *map(str, files)]
            run = subprocess.run(command, capture_output=True, text=True, check=True)
            groups[flags] = weak_names(run.stdout)
        assert max(map(len, groups.values())) > 1000, "nm has found nothing"
        assert shared(groups) == []


def test_other_flags_and_a_shared_function_are_seen() -> None:
    entries = [
        {"command": f"c++ -DA -I/x {flag} -Wall -o core.dir/{name}.o -c {name}.cpp"}
        for name, flag in (("a", "-O3"), ("b", "-O3 -fno-math-errno"), ("c", "-O3 -O1"))
    ]
    groups = by_flags(entries)
    assert groups[("-O3",)] == ["core.dir/a.o"]
    assert len(groups) == 3
    listing = "core.a:\n_ZN3fooEv W 0 2d\n_ZN3barEv T 0 8\n"
    assert weak_names(listing) == {"_ZN3fooEv"}
    assert shared({("-O3",): {"f", "g"}, ("-O1",): {"g"}}) == ["g"]
