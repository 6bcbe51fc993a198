"""The tutorials of the book run as they are printed: their commands and their Python, in order.

Blocks say how they are checked, as README's do; `<!-- check: shell -->` is lines of shell that are
run, in the same folder and in the order of the page.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from photograd_course.cli import run
from tests.house.test_readme import KINDS, blocks, faults

from support.tree import ROOT

PAGES = sorted(
    path.relative_to(ROOT).as_posix() for path in (ROOT / "docs" / "tutorials").glob("*.md")
)


@pytest.fixture(autouse=True)
def registry_as_before() -> Iterator[None]:
    from photograd.fields import representations
    from photograd.representation import REGISTERED

    representations()  # imports all of the package's own
    before = dict(REGISTERED)
    yield
    for name in REGISTERED.keys() - before.keys():
        del REGISTERED[name]


def lines(body: str) -> list[str]:
    """The lines of a block that are commands."""
    return [line for line in body.splitlines() if line.strip() and not line.startswith("#")]


def follow(page: str) -> dict[str, Any]:
    """Run a page from its first block to its last; the names that its Python leaves."""
    names: dict[str, Any] = {"__name__": "tutorial"}
    for number, (kind, body) in enumerate(blocks(page)):
        if kind == "shell":
            for line in lines(body):
                words = shlex.split(line, comments=True)
                if words[0] == "mkdir":
                    Path(words[1]).mkdir()
                    continue
                assert words[0] == "photograd", line
                assert run(words[1:]) == 0, line
        elif kind == "run":
            # What the page promises to print as True is asserted.
            code = re.sub(r"print\((.*)\)(?=\s+# True)", r"assert \1", body)
            block = compile(code, f"{page} block {number}", "exec", dont_inherit=True)
            exec(block, names)
    return names


def test_there_is_one_for_each_reader() -> None:
    assert [Path(page).stem for page in PAGES] == [
        "inverse_materials",
        "photographs_to_scene",
        "teach_with_it",
        "write_a_representation",
    ]


@pytest.mark.parametrize("page", PAGES)
def test_every_block_says_how_it_is_checked(page: str) -> None:
    assert [body for kind, body in blocks(page) if kind not in KINDS | {"shell"}] == []
    promised = [body for kind, body in blocks(page, "run") if "# True" in body]
    assert promised, "nothing is asserted"
    named = [line for _, body in blocks(page, "commands") for line in lines(body)]
    assert [fault for line in named for fault in faults(line)] == []


@pytest.mark.slow
@pytest.mark.usefixtures("core")
@pytest.mark.parametrize("page", PAGES)
def test_a_tutorial_runs(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    monkeypatch.setenv("PHOTOGRAD_ASSIGNMENTS", str(ROOT / "assignments"))
    follow(page)


def test_a_promise_that_is_not_kept_is_seen(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("<!-- check: run -->\n```python\nprint(1 > 2)  # True\n```\n", "utf-8")
    with pytest.raises(AssertionError):
        follow(str(page))
    page.write_text("<!-- check: shell -->\n```sh\nphotograd dance\n```\n", "utf-8")
    with pytest.raises(AssertionError, match="photograd dance"):
        follow(str(page))
