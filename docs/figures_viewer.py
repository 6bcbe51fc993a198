"""Screenshots of `photograd view`: `python docs/figures_viewer.py DEMO`, made by `photograd demo`.

Headless Chromium opens the page at 1280 x 720, clicks, and writes docs/images/viewer.jpg and
viewer_gradient.jpg. Needs viser, and chromium on the PATH.
"""

from __future__ import annotations

import argparse
import re
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from tests.commands.browser import Browser, chromium, free_port, photograd  # noqa: E402

IMAGES = ROOT / "docs" / "images"
SIZE = 1280, 720
CLICK = 520, 400
"""Where the picture is clicked on."""
SETTLED = 15.0
"""Seconds after which a picture has its full resolution."""


def save(browser: Browser, name: str) -> None:
    """Write what the page shows."""
    pixels = browser.picture()
    assert pixels.shape == (SIZE[1], SIZE[0], 3)
    Image.fromarray(pixels.astype(np.uint8)).save(IMAGES / name, quality=88, optimize=True)


def close_notices(browser: Browser) -> None:
    """Chromium without a GPU is told so by a notice in a corner, which is no part of the page."""
    browser.says("Software WebGL")
    browser.value(
        "document.querySelectorAll('.mantine-Notification-closeButton').forEach(e=>e.click())"
    )
    time.sleep(2.0)


def main() -> None:
    """Take both screenshots."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("demo", type=Path)
    demo = parser.parse_args().demo
    port = free_port()
    words = ("view", demo / "model", "--capture", demo / "capture", "--port", port)
    with photograd(*words), TemporaryDirectory() as folder, chromium(Path(folder), SIZE) as browser:
        browser.open(f"http://127.0.0.1:{port}")
        close_notices(browser)
        browser.click(*CLICK)
        assert re.search(r"Voxel \(\d+", browser.says("dL/dsigma_t"))
        time.sleep(SETTLED)
        save(browser, "viewer.jpg")
        browser.choose("Layer", "gradient")
        browser.says("the largest along each ray")
        time.sleep(SETTLED)
        save(browser, "viewer_gradient.jpg")


if __name__ == "__main__":
    main()
