"""`photograd view` and `fit --view` in Debian's headless Chromium, offline.

Pages open, draw, turn, tell what a click hits, show layers, follow a fit and close; nothing is
fetched from elsewhere, and the console has no error. Needs viser and chromium: `./run test --all`
asks for both.
"""

from __future__ import annotations

import hashlib
import json
import re
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from support.missing import need_module
from tests.commands.browser import (
    PATIENCE,
    Browser,
    chromium,
    fetched,
    free_port,
    photograd,
    waited,
)
from tests.commands.conftest import FIT

pytestmark = pytest.mark.slow
ADDRESS = re.compile(r"http://127\.0\.0\.1:\d+")


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with chromium(tmp_path_factory.mktemp("chromium")) as opened:
        yield opened


def address_of(server: subprocess.Popen[str]) -> str:
    """What the command says that it shows, on stderr."""
    assert server.stderr is not None
    lines = []
    for line in server.stderr:
        lines.append(line)
        if found := ADDRESS.search(line):
            return found[0]
    raise AssertionError("".join(lines))


def ended(server: subprocess.Popen[str], code: int) -> dict[str, Any]:
    """The JSON line of a command that was interrupted, or ends by itself."""
    out, err = server.communicate(timeout=PATIENCE)
    assert server.returncode == code, err
    found: dict[str, Any] = json.loads(out.splitlines()[-1])
    return found


def middle(picture: Any) -> Any:
    """What lies left of the panel."""
    return picture[:, 120:470]


def colored(picture: Any) -> Any:
    """(H, W) which pixels have a saturated color: the balls have, the white page has not."""
    shown = middle(picture)
    return (shown.max(axis=2) - shown.min(axis=2)) > 60


def seen(browser: Browser, wanted: Any) -> Any:
    """The first picture of the page for which something holds."""
    return waited(lambda: (p := browser.picture(), p if wanted(p) else None)[1])


def test_a_model_is_drawn_and_turned(browser: Browser, model_folder: Path) -> None:
    port = free_port()
    with photograd("view", model_folder, "--json", "--port", port) as server:
        address = f"http://127.0.0.1:{port}"
        browser.open(address)
        before = seen(browser, lambda p: colored(p).sum() > 500)
        browser.drag((300, 380), (400, 385))

        def turned(after: Any) -> bool:
            moved = np.abs(middle(after - before)).max(axis=2) > 60
            return bool(moved.sum() > 500 and colored(after).sum() > 500)

        seen(browser, turned)
        assert browser.faults() == []
        server.send_signal(signal.SIGINT)
        assert ended(server, 0) == {"address": address}


def test_gradients_picks_and_photographs(browser: Browser, model_folder: Path) -> None:
    with photograd("view", model_folder, "--json", "--port", free_port()) as server:
        browser.open(address_of(server))
        seen(browser, lambda p: colored(p).sum() > 500)
        browser.click(270, 330)
        told = browser.says("dL/dsigma_t")
        assert re.search(r"Voxel \(\d+, \d+, \d+\)", told)
        assert "along the ray" in told
        browser.choose("Layer", "gradient")
        browser.says("the largest along each ray")
        red = seen(browser, lambda p: (middle(p)[..., 0] - middle(p)[..., 2] > 60).sum() > 300)
        assert (middle(red)[..., 1] > 250).any()
        browser.choose("Layer", "difference")
        browser.says("Click on a photograph")
        browser.press("Look through the nearest")
        browser.says("mean over the channels")

        def compared(picture: Any) -> bool:  # the map begins with purple
            purple = np.abs(middle(picture) - [68, 1, 84]).max(axis=2) < 12
            return bool(purple.sum() > 5000)

        seen(browser, compared)
        browser.press("Home")
        browser.says("Click on a photograph")
        assert browser.faults() == []
        server.send_signal(signal.SIGINT)
        ended(server, 0)


def test_a_scene_has_sliders(browser: Browser) -> None:
    words = ("cornell-box", "--spp", 4, "--size", 256, "--max-depth", 3, "--json")
    with photograd("view", *words, "--port", free_port()) as server:
        browser.open(address_of(server))
        dark = seen(browser, lambda p: colored(p).sum() > 500)
        browser.click(200, 300)
        assert "material: " in browser.says("Triangle ")
        browser.press("lamp")
        browser.press("Home")  # the folder has opened; a slider is moved by its keys
        slider = browser.middle("document.querySelector('[role=slider]')")
        browser.click(*slider)
        for _ in range(3):
            for kind in ("keyDown", "keyUp"):
                browser.ask("Input.dispatchKeyEvent", type=kind, key="End", code="End")
        seen(browser, lambda p: middle(p).mean() > middle(dark).mean() + 20)
        assert browser.faults() == []
        server.send_signal(signal.SIGINT)
        ended(server, 0)


def test_a_capture_alone_is_looked_through(browser: Browser, capture_folder: Path) -> None:
    with photograd("view", capture_folder, "--json", "--port", free_port()) as server:
        browser.open(address_of(server))
        browser.says("Click on a photograph")
        browser.press("Look through the nearest")
        browser.says("the photograph, over what is rendered")
        seen(browser, lambda p: colored(p).sum() > 500)
        assert browser.faults() == []
        server.send_signal(signal.SIGINT)
        ended(server, 0)


def digest(folder: Path) -> str:
    with np.load(folder / "model.npz") as saved:
        total = hashlib.sha256()
        for name in sorted(saved.files):
            if saved[name].dtype.kind in "fiu":
                total.update(name.encode() + saved[name].tobytes())
    return total.hexdigest()


def test_a_fit_that_is_watched_ends_with_the_same_bits(
    browser: Browser, capture_folder: Path, tmp_path: Path
) -> None:
    options = (*FIT, "--steps", 400, "--json")
    with photograd("fit", capture_folder, "--out", tmp_path / "a", *options) as alone:
        assert ended(alone, 0)["finished"]
    with photograd("fit", capture_folder, "--out", tmp_path / "b", *options, "--view") as watched:
        address = address_of(watched)
        browser.open(address)
        assert ended(watched, 0)["finished"]
        with pytest.raises(OSError, match="refused"):
            fetched(address)
    assert digest(tmp_path / "a") == digest(tmp_path / "b")


def test_a_fit_is_followed_until_it_is_interrupted(
    browser: Browser, capture_folder: Path, tmp_path: Path
) -> None:
    options = (*FIT, "--steps", 100_000, "--json", "--view", "--out", tmp_path / "a")
    with photograd("fit", capture_folder, *options) as fit:
        browser.open(address_of(fit))
        first = re.search(r"step (\d+) of 100000, loss", browser.says("of 100000, loss"))
        assert first is not None

        def later() -> Any:
            found = re.search(r"step (\d+) of 100000", browser.text())
            return found if found and int(found[1]) > int(first[1]) else None

        waited(later)
        seen(browser, lambda p: colored(p).sum() > 500)
        assert browser.faults() == []
        fit.send_signal(signal.SIGINT)
        assert not ended(fit, 130)["finished"]
    assert (tmp_path / "a" / "model.npz").exists()


def test_a_port_in_use_is_refused_with_the_next_free_one(model_folder: Path) -> None:
    need_module("viser", by_choice=True)
    port = free_port()
    with photograd("view", model_folder, "--port", port) as first:
        waited(lambda: fetched(f"http://127.0.0.1:{port}"))
        with photograd("view", model_folder, "--port", port, "--json") as second:
            refused = ended(second, 1)
            assert f"got {port}, which is in use" in json.dumps(refused)
            assert re.search(rf"--port (?!{port} )\d+ is free", json.dumps(refused))
        assert first.poll() is None
