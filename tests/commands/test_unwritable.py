"""Every command says that it cannot write its output before it reads or computes anything.

The inputs named here do not exist: a command that looks at one of them first complains of that.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer
from photograd.commands import register
from photograd.commands import render_output as rendering
from typer.main import get_group

from tests.commands.conftest import Photograd

# Of each command with an output: the words before it, and the names that it may have.
INPUTS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "capture": ((), ("folder",)),
    "fit": (("absent",), ("folder",)),
    "render": (("absent",), ("a.gif", "a.png", "a.npz", "a.mp4", "folder")),
    "trace": (("absent.toml",), ("a.exr", "a.hdr", "a.pfm", "a.png")),
    "frame": (("absent.toml",), ("a.exr", "a.png")),
    "bake-ao": (("absent.toml",), ("a.exr", "a.png")),
    "simplify": (("absent.obj", "--triangles", "50"), ("a.glb", "a.npz")),
    "recover": (
        ("absent.toml", "--target", "absent.exr", "--parameter", "materials.red.albedo"),
        ("folder",),
    ),
    "vectorize": (("absent.png",), ("a.svg",)),
    "convert": (("absent",), ("a.glb", "a.ply", "a.spz", "a.vdb", "a.json", "folder")),
    "evaluate": (("absent", "absent"), ("a.png",)),
    "gradients": (("absent", "absent"), ("folder",)),
    "compare": (("absent", "--candidates", "dense_grid:8"), ("folder",)),
    "demo": ((), ("folder",)),
}
CASES = [(command, name) for command, (_, names) in INPUTS.items() for name in names]


def test_these_are_all_commands_with_an_output() -> None:
    app = typer.Typer()
    register(app)
    commands: dict[str, Any] = get_group(app).commands
    writing = {
        name
        for name, command in commands.items()
        for each in command.params
        if "--out" in each.opts or (each.name == "target" and each.param_type_name == "argument")
    }
    assert writing == set(INPUTS)


@pytest.fixture
def frozen(tmp_path: Path) -> Iterator[Path]:
    """A folder that takes no files: immutable for the superuser, without the right for others."""
    folder = tmp_path / "frozen"
    folder.mkdir()
    (folder / "old").mkdir()
    chattr = shutil.which("chattr")
    if os.geteuid() != 0:
        folder.chmod(0o555)
        yield folder
        folder.chmod(0o755)
    elif chattr and not subprocess.run([chattr, "+i", folder], check=False).returncode:
        yield folder
        subprocess.run([chattr, "-i", folder], check=True)
    else:
        pytest.skip("this file system cannot refuse the superuser")


def refused(photograd: Photograd, command: str, out: Path, tmp_path: Path) -> str:
    """What the command says of an output; nothing else was said or made."""
    words, _ = INPUTS[command]
    before = sorted(tmp_path.rglob("*"))
    place = [out] if command == "convert" else ["--out", out]
    done = photograd(command, *words, *place)
    assert done.code == 1, (done.out, done.err)
    assert done.out == ""
    text = " ".join(done.err.split())
    argument = "OUT" if command == "convert" else "--out"
    assert text.startswith(f"error: {command}: {argument}: expected "), text
    assert "absent" not in text
    assert sorted(tmp_path.rglob("*")) == before
    return text


@pytest.mark.parametrize(("command", "name"), CASES)
def test_a_folder_that_takes_no_files(
    photograd: Photograd,
    frozen: Path,
    tmp_path: Path,
    command: str,
    name: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(rendering, "require_video_writer", lambda _: None)
    text = refused(photograd, command, frozen / name, tmp_path)
    assert "not permitted" in text or "Permission denied" in text


@pytest.mark.parametrize(("command", "name"), CASES)
def test_a_folder_that_cannot_exist(
    photograd: Photograd, tmp_path: Path, command: str, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rendering, "require_video_writer", lambda _: None)
    (tmp_path / "file").write_text("mine")
    refused(photograd, command, tmp_path / "file" / "deeper" / name, tmp_path)
    assert (tmp_path / "file").read_text() == "mine"


@pytest.mark.parametrize(("command", "name"), [case for case in CASES if "." in case[1]])
def test_a_file_that_cannot_be_replaced(
    photograd: Photograd, tmp_path: Path, command: str, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rendering, "require_video_writer", lambda _: None)
    target = tmp_path / name
    target.write_bytes(b"mine")
    chattr = shutil.which("chattr")
    if not chattr or subprocess.run([chattr, "+i", target], check=False).returncode:
        pytest.skip("no immutable files here")
    try:
        text = refused(photograd, command, target, tmp_path)
        assert "a file that can be replaced" in text
        assert target.read_bytes() == b"mine"
    finally:
        subprocess.run([chattr, "-i", target], check=True)


def test_a_file_of_mode_0444_is_replaced(photograd: Photograd, tmp_path: Path) -> None:
    out = tmp_path / "a.png"
    out.write_bytes(b"old")
    out.chmod(0o444)
    words = ("trace", "cornell-box", "--size", 8, "--spp", 1, "--out", out)
    assert photograd(*words).code == 0
    assert out.read_bytes() != b"old"


def test_convert_makes_folders(photograd: Photograd, capture_folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "new" / "deeper" / "transforms.json"
    done = photograd("convert", capture_folder, out)
    assert done.code == 0, done.err
    assert out.is_file()
    assert not list(out.parent.glob(".*"))


def test_what_fails_while_it_is_written_names_the_option(
    photograd: Photograd, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    words = ("trace", "cornell-box", "--size", 8, "--spp", 1, "--out", tmp_path / "a.png")
    done = photograd(*words)
    assert done.code == 1
    text = " ".join(done.err.split())
    assert "error: trace: --out: expected room on the disk for" in text
    assert "atomic_write" not in text
