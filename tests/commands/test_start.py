"""Every command starts by importing all commands: what only pictures need must wait for them."""

from __future__ import annotations

import subprocess
import sys

import pytest


@pytest.mark.usefixtures("core")
def test_help_needs_no_drawing() -> None:
    code = (
        "import sys; from photograd_course.cli import run; code = run(['gradients', '--help']);"
        "assert 'photograd.commands.compare' in sys.modules; assert code == 0;"
        "sys.exit('matplotlib' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "--rays" in done.stdout
