"""Pieces of Python that may end their process, run in one of their own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping

from support.tree import ROOT

RUNNER = """
import json, sys
begin, cases = json.loads(sys.stdin.read())
start = {}
exec(begin, start)
for name, code in cases.items():
    own = dict(start)
    try:
        exec(code, own)
        answer = str(own.get("answer"))
    except Exception as failure:
        answer = f"{type(failure).__name__}: {failure}"
    print(json.dumps([name, answer]), flush=True)
"""


def answers(begin: str, cases: Mapping[str, str]) -> dict[str, str]:
    """What each piece of code leaves in `answer`, or its error, one after another.

    `begin` runs before all of them. Where the process dies, the piece that it died of has the
    number that it ended with, and those after it have no answer.
    """
    paths = os.pathsep.join([str(ROOT / "tests"), str(ROOT)])
    child = subprocess.run(
        [sys.executable, "-c", RUNNER],
        input=json.dumps([begin, dict(cases)]),
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | {"PYTHONPATH": paths},
    )
    found = dict(json.loads(line) for line in child.stdout.splitlines())
    if len(found) < len(cases):
        died = next(name for name in cases if name not in found)
        found[died] = f"ended with {child.returncode}: {child.stderr[-300:]}"
    return found
