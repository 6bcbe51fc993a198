"""A running fit that is looked at: the same bits, and what is shown is the fit as it was then."""

from __future__ import annotations

import shutil
import socket
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.capture import load_capture
from photograd.capture.orbit import orbit_cameras
from photograd.commands.view_drawing import Shown, Viewed
from photograd.commands.view_follow import (
    FitView,
    FolderView,
    frozen_copy,
    is_fit,
    viewed_folder,
    words,
)
from photograd.commands.view_panel import StepSlider
from photograd.commands.view_server import free_port
from photograd.errors import IoError
from photograd.fitting import FitOptions
from photograd.fitting.loop import Fit
from photograd.fitting.options import options_for

from tests.commands.conftest import Photograd

pytestmark = pytest.mark.usefixtures("core")


class Watching:
    """Draws every state that it is shown, in a thread of its own, as a page does."""

    watched = True

    def __init__(self) -> None:
        self.said: list[str] = []
        self.drawn: list[Any] = []
        self.threads: list[threading.Thread] = []

    def replace(self, viewed: Viewed, said: str = "") -> None:
        self.said.append(said)
        (camera,) = orbit_cameras(viewed.box, 1, size=24)

        def draw() -> None:
            self.drawn.append([p for p in viewed.draw(camera) if p is not None][-1].color)

        self.threads.append(threading.Thread(target=draw))
        self.threads[-1].start()


def options(name: str) -> FitOptions:
    chosen: dict[str, Any] = {"steps": 12, "seed": 3}
    if name == "gaussians":
        return options_for(name, gaussians=300, **chosen)
    return options_for(name, resolution=16, rays=256, **chosen)


@pytest.mark.parametrize("name", ["dense_grid", "sparse_sh", "gaussians", "hash_grid"])
def test_a_fit_that_is_looked_at_ends_with_the_same_bits(
    name: str, capture_folder: Path, tmp_path: Path
) -> None:
    capture = load_capture(capture_folder)
    alone = Fit.start(capture, options(name))
    alone.run(tmp_path / "alone")
    seen, page = Fit.start(capture, options(name)), Watching()
    look = FitView(page, seconds=0.0).look
    seen.run(tmp_path / "seen", on_step=lambda _: look(seen))
    for thread in page.threads:
        thread.join()
    assert len(page.drawn) == 12
    assert page.said[3].startswith("step 4 of 12, loss ")
    assert np.abs(page.drawn[0] - page.drawn[-1]).max() > 0
    assert alone.history == seen.history
    for group, values in alone.model.params.items():
        np.testing.assert_array_equal(values, seen.model.params[group])


def test_a_copy_stays_as_it_was(capture_folder: Path) -> None:
    job = Fit.start(load_capture(capture_folder), options("dense_grid"))
    before = job.model.params["values"].copy()
    copied = frozen_copy(job.model, job.options)
    job.step()
    assert copied() is copied()
    np.testing.assert_array_equal(copied().params["values"], before)
    assert np.abs(job.model.params["values"] - before).max() > 0
    assert words(job).startswith("step 1 of 12, loss ")


def test_nobody_looks_nothing_is_copied() -> None:
    page = Watching()
    page.watched = False
    FitView(page).look(None)  # type: ignore[arg-type]
    assert page.said == []


def test_a_page_that_fails_does_not_end_the_fit(
    capture_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    class Broken(Watching):
        def replace(self, viewed: Viewed, said: str = "") -> None:
            del viewed, said
            raise ValueError("a socket that is gone")

    job = Fit.start(load_capture(capture_folder), options("dense_grid"))
    view = FitView(Broken(), seconds=0.0)
    view.look(job)
    view.look(job)
    assert capsys.readouterr().err.count("a socket that is gone") == 1


def test_the_folder_of_a_running_fit_is_shown_as_it_is_saved(
    model_folder: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "running"
    (folder / "snapshots").mkdir(parents=True)
    assert not is_fit(folder)
    first, *rest = sorted((model_folder / "snapshots").glob("*.npz"))
    shutil.copy(first, folder / "snapshots")
    assert is_fit(folder)
    viewed = viewed_folder(folder)  # before the first checkpoint
    assert sorted(viewed.steps) == [0]
    page, following = Watching(), FolderView(folder, seconds=0.0)
    following.look(page)
    assert page.said == []
    for path in rest:
        shutil.copy(path, folder / "snapshots")
    (folder / "model.npz").write_bytes(b"half a file")
    following.look(page)
    assert page.said == []  # left for the next look
    shutil.copy(model_folder / "model.npz", folder)
    following.look(page)
    following.look(page)
    for thread in page.threads:
        thread.join()
    assert len(page.said) == len(page.drawn) == 1
    assert page.said[0].startswith("step 40")


class Parts:
    """What a slider needs of viser's GUI."""

    def __init__(self) -> None:
        self.value, self.content, self.calls = 0, "", list[Any]()
        self.sliders = 0

    def add_folder(self, _: str) -> Parts:
        return self

    def add_slider(self, _: str, *, initial_value: int, **__: Any) -> Parts:
        self.value, self.calls = initial_value, []
        self.sliders += 1
        return self

    def add_markdown(self, text: str) -> Parts:
        self.content = text
        return self

    def on_update(self, call: Any) -> None:
        self.calls.append(call)

    def remove(self) -> None:
        self.calls = []

    def __enter__(self) -> None:
        return None

    def __exit__(self, *_: object) -> None:
        return None

    def move(self, value: int) -> None:
        self.value = value
        for call in self.calls:
            call(None)


def test_the_slider_stays_where_it_is_or_with_the_newest() -> None:
    def nothing(_: Any) -> Any:
        return iter(())

    a, b, c, d = (Shown(nothing) for _ in range(4))
    gui, shown = Parts(), list[Shown]()
    slider = StepSlider(gui, shown.append)
    slider.replace({0: a}, b)
    assert gui.sliders == 0
    slider.replace({0: a, 5: b}, c)
    assert (gui.sliders, gui.value) == (1, 1)
    gui.move(0)
    assert gui.content == "step 0 of the fit"
    slider.replace({0: a, 5: b, 9: c}, d)
    assert (gui.sliders, gui.value) == (2, 0)
    gui.move(2)
    slider.replace({0: a, 5: b, 9: c}, b)
    assert shown == [b, c, a, a, d, b]


def test_a_port_in_use_is_named_with_the_next_one() -> None:
    with socket.socket() as held:
        held.bind(("127.0.0.1", 0))
        held.listen()
        port = held.getsockname()[1]
        free = free_port("127.0.0.1", port, exact=False)
        assert port < free < port + 100
        with pytest.raises(IoError, match=rf"{port}, which is in use \(--port {free} is free\)"):
            free_port("127.0.0.1", port, exact=True)
    assert free_port("127.0.0.1", port, exact=True) == port
    with pytest.raises(IoError, match=r"--host: expected an address of this machine"):
        free_port("192.0.2.1", port, exact=False)


def test_pictures_fitted_by_a_network_have_no_page(
    photograd: Photograd, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capture_folder: Path
) -> None:
    picture = next(capture_folder.rglob("*.png"))
    done = photograd("fit", picture, "--out", tmp_path / "a", "--view")
    assert done.code == 1
    assert "--view" in done.err
    monkeypatch.setitem(sys.modules, "viser", None)
    done = photograd("fit", capture_folder, "--out", tmp_path / "b", "--view", "--steps", "2")
    assert done.code == 1
    assert "pip install 'photograd[viewer]'" in done.err
    assert not (tmp_path / "b" / "model.npz").exists()
