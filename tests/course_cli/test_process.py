"""The installed command as a process of its own."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import photograd_course
import pytest

MODULE = [sys.executable, "-m", "photograd_course"]


def run_process(command: list[str], folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    environment = dict(os.environ)
    if folder is not None:
        environment["PYTHONPATH"] = str(folder)
    return subprocess.run(
        command, check=False, capture_output=True, text=True, env=environment, encoding="utf-8"
    )


@pytest.fixture
def plugin_folder(tmp_path: Path) -> Path:
    """A distribution on the path, with one good entry point and one broken."""
    (tmp_path / "waiting_plugin.py").write_text(
        "import sys, time\n"
        "def register(app):\n"
        "    @app.command()\n"
        "    def wait():\n"
        "        print('waiting', flush=True)\n"
        "        time.sleep(60)\n"
    )
    info = tmp_path / "waiting_plugin-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: waiting-plugin\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(
        "[photograd.commands]\nwaiting = waiting_plugin:register\nlost = no_such_module:register\n"
    )
    return tmp_path


def test_the_script_and_the_module_tell_the_same_version() -> None:
    script = Path(sys.executable).with_name("photograd")
    if not script.exists():
        pytest.skip("the photograd script is not installed beside this Python")
    for command in ([str(script)], MODULE):
        done = run_process([*command, "--version"])
        assert done.returncode == 0
        assert done.stdout == f"photograd {photograd_course.__version__}\n"


def test_version_as_json_is_the_last_line_on_stdout() -> None:
    done = run_process([*MODULE, "version", "--json"])
    assert done.returncode == 0
    result = json.loads(done.stdout.splitlines()[-1])
    assert result["course_version"] == photograd_course.__version__
    assert result["threads"] >= 1
    assert {"core_version", "instruction_set", "python", "numpy", "commands_of"} <= set(result)


def test_installed_plugins_are_found_and_broken_ones_reported(plugin_folder: Path) -> None:
    done = run_process([*MODULE, "--help"], plugin_folder)
    assert done.returncode == 0
    assert "wait" in done.stdout
    lines = [line for line in done.stderr.splitlines() if "'lost'" in line]
    assert len(lines) == 1
    assert "no_such_module" in lines[0]
    state = json.loads(run_process([*MODULE, "version", "--json"], plugin_folder).stdout)
    assert state["commands_of"]["waiting"] == "ok"
    assert state["commands_of"]["lost"].startswith("ModuleNotFoundError")


def test_without_the_core_its_commands_say_so() -> None:
    code = (
        "import sys; sys.modules['photograd'] = None\n"
        "from photograd_course.cli import run; sys.exit(run(sys.argv[1:]))"
    )
    done = run_process([sys.executable, "-c", code, "fit", "capture", "--steps", "10"])
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.splitlines()[-1].startswith("error: photograd fit: core not installed")
    assert "Traceback" not in done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="sends a POSIX signal")
def test_ctrl_c_exits_with_130(plugin_folder: Path) -> None:
    environment = dict(os.environ) | {"PYTHONPATH": str(plugin_folder)}
    with subprocess.Popen(
        [*MODULE, "wait"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
        # Tests may run in the background, where shells have programs ignore it.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # noqa: PLW1509
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        assert process.stdout.readline() == "waiting\n"
        time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=20) == 130
        error = process.stderr.read()
    assert error.splitlines()[-1] == "interrupted"
    assert "Traceback" not in error
