"""The door to pycolmap: politely stopped, politely missed, and, where it is installed, right."""

from __future__ import annotations

import _thread
import shutil
import sys
import threading
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from photograd.capture import load_capture
from photograd.capture.sfm.engine import Settings, _Pycolmap, open_engine
from photograd.capture.sfm.reconstruct import reconstruct
from photograd.errors import IoError

from support.missing import need_module
from tests.sfm.fake import photographs, similarity

CONNECTED = ("0423", "0424", "0425", "0426", "0437", "0438")


class Token:
    """What pycolmap calls a cancellation token."""

    def __init__(self) -> None:
        self.cancelled = threading.Event()

    def cancel(self) -> None:
        self.cancelled.set()


def door() -> _Pycolmap:
    found = _Pycolmap.__new__(_Pycolmap)
    found.module = SimpleNamespace(CancellationToken=Token)
    return found


def test_an_interruption_waits_for_the_stage_to_end() -> None:
    ended = []

    def stage(*, cancellation_token: Token) -> None:
        _thread.interrupt_main()
        assert cancellation_token.cancelled.wait(20)
        _thread.interrupt_main()  # a second one, while it ends
        cancellation_token.cancelled.wait(0)
        ended.append(True)

    with pytest.raises(KeyboardInterrupt):
        door()._run(stage)
    assert ended == [True]


def test_answers_and_failures_come_back() -> None:
    def stage(value: int, *, cancellation_token: Token) -> int:
        assert not cancellation_token.cancelled.is_set()
        return 7 // value

    assert door()._run(stage, 7) == 1
    with pytest.raises(ZeroDivisionError):
        door()._run(stage, 0)


def test_without_pycolmap_the_command_to_install_it_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pycolmap", None)
    with pytest.raises(IoError, match="got none \\(pip install 'photograd\\[sfm\\]'\\)"):
        open_engine(tmp_path, tmp_path, Settings(), 0)
    photographs(tmp_path / "in")
    with pytest.raises(IoError, match=r"photograd\[sfm"):
        reconstruct(tmp_path / "in", tmp_path / "out", Settings(), note=print)
    assert not (tmp_path / "out").exists()  # said before anything is copied


def test_an_old_pycolmap_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pycolmap", SimpleNamespace(__version__="3.10"))  # type: ignore[arg-type]
    with pytest.raises(
        IoError, match=r"from 4\.2 on, got 3\.10 \(pip install --upgrade pycolmap\)"
    ):
        open_engine(tmp_path, tmp_path, Settings(), 0)


def test_the_alignment_is_right() -> None:
    g = np.random.default_rng(1)
    points = g.normal(size=(7, 3))
    turn = np.linalg.qr(g.normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    scale, rotation, shift = similarity(points, 2.5 * points @ turn.T + [1, 2, 3])
    np.testing.assert_allclose(scale, 2.5)
    np.testing.assert_allclose(rotation, turn, atol=1e-12)
    np.testing.assert_allclose(shift, [1, 2, 3])


@pytest.mark.slow
def test_bananas_from_nothing_but_photographs(shared_data: Path, tmp_path: Path) -> None:
    """Six reduced photographs of a real scene, twice: the same bits on two threads and on one."""
    need_module("pycolmap", by_choice=True)  # extra sfm
    (tmp_path / "in").mkdir()
    for name in CONNECTED:
        shutil.copy(shared_data / f"posed/banana/images/dsc_{name}.jpg", tmp_path / "in")
    models = []
    for threads in (2, 1):
        out = tmp_path / f"{threads}"
        settings = Settings(max_size=376, max_features=1500)
        capture, report = reconstruct(tmp_path / "in", out, settings, threads=threads, note=print)
        models.append([file.read_bytes() for file in sorted((out / "sparse/0").glob("*.bin"))])
    assert models[0] == models[1]
    assert report.registered == 6
    assert report.points > 500  # measured 833
    assert report.error < 0.5  # measured 0.25 px of 752
    ours = {view.name: view.camera for view in capture.views}
    theirs = {view.name: view.camera for view in load_capture(shared_data / "posed/banana").views}
    here = np.array([camera.position for camera in ours.values()])
    there = np.array([theirs[name].position for name in ours])
    scale, rotation, shift = similarity(here, there)
    off = np.linalg.norm(scale * here @ rotation.T + shift - there, axis=1)
    spread = np.sqrt(np.square(there - there.mean(axis=0)).sum(axis=1).mean())
    assert off.max() / spread < 0.02  # measured 0.0076
    for name, camera in ours.items():
        turn = (rotation @ camera.world_from_camera[:3, :3]).T @ theirs[name].world_from_camera[
            :3, :3
        ]
        assert np.degrees(np.arccos(min((np.trace(turn) - 1) / 2, 1))) < 0.8  # measured 0.26
        assert camera.fx == pytest.approx(1302.35, rel=0.02)  # measured 1296.2
