"""Write constraints.txt: the versions that a term can be pinned to, out of what is installed here.

Usage: constraints.py [--check]

Each package that the two distributions require, and each that those require, in the version that
is installed where the tests pass. `pip install --constraint constraints.txt ...` takes them.
`--check` writes nothing; status 1 where a required package has no line, or the line of a version
that its requirement refuses.
"""

from __future__ import annotations

import re
import sys
from importlib import metadata
from pathlib import Path

from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parent.parent
for folder in ("tools", "python"):
    sys.path.insert(0, str(ROOT / folder))
import dependencies  # noqa: E402
import requirements  # noqa: E402

FILE = ROOT / "constraints.txt"
OLDEST = "3.10"  # that students may have
EXTRAS = ("grader", "handouts")
HEAD = """# With these versions the tests of photograd pass (Python {python}). A course that uses
#   pip install --constraint constraints.txt ...
# has them all term long; Python {oldest} gets other versions of what no longer runs there. Written
# by tools/constraints.py.
"""


def stated() -> list[Requirement]:
    """What the two distributions require, and the extras that an instructor installs."""
    course = requirements.read(requirements.PROJECTS[1])["project"]
    lines = [*dependencies.REQUIREMENTS, *course["dependencies"]]
    lines += [line for extra in EXTRAS for line in course["optional-dependencies"][extra]]
    return [Requirement(line) for line in lines]


def required() -> dict[str, list[Requirement]]:
    """What is required here, by canonical name: by the two distributions, and by all of these."""
    found: dict[str, list[Requirement]] = {}
    waiting = stated()
    while waiting:
        need = waiting.pop()
        if need.marker is not None and not need.marker.evaluate({"extra": ""}):
            continue
        name = canonicalize_name(need.name)
        if name not in found:
            waiting += [Requirement(line) for line in metadata.requires(name) or []]
        found.setdefault(name, []).append(need)
    return found


def pinned() -> str:
    """The text of the file."""
    lines = []
    for name in sorted(required()):
        found = metadata.metadata(name)
        old = SpecifierSet(found["Requires-Python"] or "").contains(OLDEST)
        marker = "" if old else f'; python_version > "{OLDEST}"'
        lines.append(f"{name}=={found['Version']}{marker}\n")
    version = f"{sys.version_info.major}.{sys.version_info.minor}"
    return HEAD.format(python=version, oldest=OLDEST) + "".join(lines)


def faults(text: str) -> list[str]:
    """What is wrong with the lines of a file."""
    rows = dict(re.findall(r"^([\w.-]+)==([^\s;]+)", text, re.MULTILINE))
    found = []
    for name, needs in required().items():
        if name not in rows:
            found.append(f"no line for {name}")
            continue
        found += [
            f"{name}=={rows[name]}, but {need} is required"
            for need in needs
            if not need.specifier.contains(rows[name], prereleases=True)
        ]
    return found


def main() -> int:
    """Status of the program."""
    if sys.argv[1:] == ["--check"]:
        wrong = faults(FILE.read_text(encoding="utf-8"))
        print("\n".join(wrong))
        return int(bool(wrong))
    FILE.write_text(pinned(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
