"""Screenshots of `photograd view`: `python docs/figures_viewer.py DEMO`, made by `photograd demo`.

Headless Chromium opens the page at 1280 x 720, clicks, and writes docs/images/viewer.jpg; then it
chooses the layer of gradients, and writes docs/images/viewer_gradient.jpg.
Needs viser, and chromium on the PATH.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from tests.commands.browser import Browser, chromium, free_port, photograd, waited  # noqa: E402

IMAGES = ROOT / "docs" / "images"
SIZE = 1280, 720
CLICK = 600, 400
"""Where the picture is clicked on."""
CLOSES = ".mantine-Notification-closeButton"
PAUSE = 6.0  # seconds


def settled(browser: Browser) -> Any:
    """The page after a pause; without a screenshot now and then, a headless page draws nothing."""
    for _ in range(2):
        time.sleep(PAUSE)
        waited(browser.picture)
    return waited(browser.picture)


def store(pixels: Any, name: str) -> None:
    """Write a screenshot."""
    assert pixels.shape == (SIZE[1], SIZE[0], 3)
    Image.fromarray(pixels.astype(np.uint8)).save(IMAGES / name, quality=88, optimize=True)


def main() -> None:
    """Take the screenshots."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("demo", type=Path)
    demo = parser.parse_args().demo
    port = free_port()
    words = ("view", demo / "model", "--capture", demo / "capture", "--port", port)
    with photograd(*words), TemporaryDirectory() as folder, chromium(Path(folder), SIZE) as browser:
        browser.open(f"http://127.0.0.1:{port}")
        settled(browser)
        # That Chromium has no GPU, a notice says in a corner; it is no part of the page.
        browser.value(f"document.querySelectorAll({CLOSES!r}).forEach(e=>e.click())")
        browser.click(*CLICK)
        store(settled(browser), "viewer.jpg")
        assert "Voxel (" in browser.text()
        browser.choose("Layer", "gradient")
        browser.says("the largest along each ray")
        store(settled(browser), "viewer_gradient.jpg")


if __name__ == "__main__":
    main()
