"""`photograd view` in Debian's headless Chromium: it opens, draws, drags and closes, offline.

Needs viser and chromium: `./run test --all` asks for both.
"""

from __future__ import annotations

import base64
import io
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest
from PIL import Image

from support.missing import missing, need_module

PATIENCE = 60  # seconds, on a machine that does much else


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def need_chromium() -> str:
    need_module("viser", by_choice=True)
    found = shutil.which("chromium") or shutil.which("chromium-browser")
    return found or missing("chromium is not installed", by_choice=True)


class Browser:
    """A page of Chromium, spoken to by its debugging protocol."""

    def __init__(self, port: int) -> None:
        from websockets.sync.client import connect

        pages = json.loads(waited(lambda: fetched(f"http://127.0.0.1:{port}/json")))
        page = next(each for each in pages if each["type"] == "page")
        self.socket = connect(page["webSocketDebuggerUrl"], max_size=None)
        self.number, self.events = 0, list[dict[str, Any]]()

    def ask(self, method: str, **params: Any) -> dict[str, Any]:
        self.number += 1
        self.socket.send(json.dumps({"id": self.number, "method": method, "params": params}))
        while True:
            answer: dict[str, Any] = json.loads(self.socket.recv(timeout=PATIENCE))
            if answer.get("id") == self.number:
                found: dict[str, Any] = answer.get("result", {})
                return found
            self.events.append(answer)

    def picture(self) -> Any:
        shot = self.ask("Page.captureScreenshot", format="png")["data"]
        return np.asarray(Image.open(io.BytesIO(base64.b64decode(shot))).convert("RGB"), np.float64)

    def mouse(self, kind: str, x: int, y: int) -> None:
        self.ask(
            "Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1
        )


def fetched(address: str) -> bytes:
    with urllib.request.urlopen(address, timeout=5) as answer:
        content: bytes = answer.read()
        return content


def waited(question: Any) -> Any:
    """The first answer that is something."""
    end = time.monotonic() + PATIENCE
    while True:
        try:
            if (answer := question()) is not None:
                return answer
        except OSError:
            pass
        assert time.monotonic() < end, "no answer"
        time.sleep(0.2)


@contextmanager
def running(words: list[str], ending: int) -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    try:
        yield process
    finally:
        if process.poll() is None:
            process.send_signal(ending)
        try:
            process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        for stream in (process.stdout, process.stderr):
            if stream is not None:
                stream.close()


def colored(picture: Any) -> Any:
    """(H, W) which pixels have a saturated color: the balls have, the white page has not."""
    middle = picture[:, 150:470]  # between the panels
    return (middle.max(axis=2) - middle.min(axis=2)) > 60


@pytest.mark.slow
def test_a_model_is_drawn_and_turned(model_folder: Path, tmp_path: Path) -> None:
    chromium = need_chromium()
    port, debugging = free_port(), free_port()
    view = [sys.executable, "-m", "photograd_course", "view", str(model_folder), "--json"]
    flags = ["--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--window-size=800,600"]
    flags += ["--enable-unsafe-swiftshader", f"--remote-debugging-port={debugging}"]
    flags += [f"--user-data-dir={tmp_path}", "about:blank"]
    with running([*view, "--port", str(port)], signal.SIGINT) as server:
        assert server.stderr is not None
        address = f"http://127.0.0.1:{port}"
        waited(lambda: fetched(address))
        with running([chromium, *flags], signal.SIGTERM):
            browser = Browser(debugging)
            for domain in ("Page", "Network", "Runtime"):
                browser.ask(f"{domain}.enable")
            browser.ask("Page.navigate", url=address)
            before = waited(
                lambda: (p := browser.picture(), p if colored(p).sum() > 500 else None)[1]
            )
            browser.mouse("mousePressed", 300, 380)
            for x in (330, 360, 400):
                browser.mouse("mouseMoved", x, 385)
            browser.mouse("mouseReleased", 400, 385)

            def turned() -> Any:
                after = browser.picture()
                moved = np.abs(after - before)[:, 150:470].max(axis=2) > 60
                return after if moved.sum() > 500 and colored(after).sum() > 500 else None

            waited(turned)
            asked = [e for e in browser.events if e.get("method") == "Network.requestWillBeSent"]
            urls = [urlsplit(each["params"]["request"]["url"]) for each in asked]
            hosts = {url.hostname for url in urls if url.scheme in ("http", "https", "ws", "wss")}
            assert hosts == {"127.0.0.1"}  # nothing is fetched from elsewhere
            wrong = [e for e in browser.events if e.get("method") == "Runtime.exceptionThrown"]
            assert wrong == []
            browser.socket.close()
        server.send_signal(signal.SIGINT)
        out, _ = server.communicate(timeout=PATIENCE)
    assert server.returncode == 0
    assert json.loads(out.splitlines()[-1]) == {"address": address}
