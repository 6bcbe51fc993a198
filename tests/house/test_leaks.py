"""Nothing that belongs to one machine: no absolute path of a user's, no host of a package index."""

from __future__ import annotations

import re

import pytest

from support.tree import ROOT, relative, walk

# Written in pieces, so that this file does not find itself.
HOSTS = ["py" + "pi.org", "python" + "hosted.org", "deb." + "debian.org", "npm" + "js.org"]
LEAK = re.compile(
    r"(?<![\w.$}/-])/(?:work|root|home|Users|opt/py\w+)/[\w.-]+|[A-Z]:\\Users|"
    + "|".join(re.escape(host) for host in HOSTS)
)


def test_no_file_names_a_machine() -> None:
    found = []
    for path in walk(ROOT):
        if path.name == ".git":  # of a second working tree: a file, and no part of the project
            continue
        text = path.read_text(encoding="utf-8", errors="replace")
        found += [f"{relative(path)}: {match.group()}" for match in LEAK.finditer(text)]
    assert found == []


@pytest.mark.parametrize(
    "text", ["see /" + "home/ann/x", "'/" + "work/main'", "https://" + HOSTS[0] + "/simple"]
)
def test_a_leak_is_seen(text: str) -> None:
    assert LEAK.search(text)


@pytest.mark.parametrize("text", ["cpp/work/main.cpp", "out/home/x", "/usr/include/glm", "~/data"])
def test_what_is_no_leak_passes(text: str) -> None:
    assert not LEAK.search(text)
