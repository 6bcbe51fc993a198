"""Debian's headless Chromium, spoken to by its debugging protocol, for tests of pages."""

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
from PIL import Image

from support.missing import missing, need_module

PATIENCE = 120  # seconds, on a machine that does much else


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def need_chromium() -> str:
    need_module("viser", by_choice=True)
    found = shutil.which("chromium") or shutil.which("chromium-browser")
    return found or missing("chromium is not installed", by_choice=True)


@contextmanager
def chromium(folder: Path, size: tuple[int, int] = (800, 600)) -> Iterator[Browser]:
    """A headless Chromium with a window of that size."""
    program, debugging = need_chromium(), free_port()
    flags = ["--headless=new", "--no-sandbox", "--use-angle=swiftshader"]
    flags += [f"--window-size={size[0]},{size[1]}", "--enable-unsafe-swiftshader"]
    flags += [f"--remote-debugging-port={debugging}", f"--user-data-dir={folder}", "about:blank"]
    with running([program, *flags], signal.SIGTERM):
        browser = Browser(debugging)
        for domain in ("Page", "Network", "Runtime", "Log"):
            browser.ask(f"{domain}.enable")
        width, height = size
        screen = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        browser.ask("Emulation.setDeviceMetricsOverride", **screen)
        yield browser
        browser.socket.close()


@contextmanager
def photograd(*words: object) -> Iterator[subprocess.Popen[str]]:
    """A command line in a process of its own, interrupted at the end if it still runs."""
    listed = [sys.executable, "-m", "photograd_course", *map(str, words)]
    with running(listed, signal.SIGINT) as process:
        yield process


class Browser:
    """A page of Chromium, spoken to by its debugging protocol."""

    def __init__(self, port: int) -> None:
        from websockets.sync.client import connect

        pages = json.loads(waited(lambda: fetched(f"http://127.0.0.1:{port}/json")))
        page = next(each for each in pages if each["type"] == "page")
        self.socket = connect(page["webSocketDebuggerUrl"], max_size=None, ping_interval=None)
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
        shot = self.ask("Page.captureScreenshot", format="png")
        if "data" not in shot:
            raise OSError("the page is not there yet")
        file = io.BytesIO(base64.b64decode(shot["data"]))
        return np.asarray(Image.open(file).convert("RGB"), np.float64)

    def open(self, address: str) -> None:
        """Go to a page, and forget what the last one did."""
        waited(lambda: fetched(address))
        self.ask("Page.navigate", url="about:blank")
        self.events.clear()
        self.ask("Page.navigate", url=address)

    def value(self, script: str) -> Any:
        """What an expression of JavaScript is."""
        answer = self.ask("Runtime.evaluate", expression=script, returnByValue=True)
        return answer.get("result", {}).get("value")

    def text(self) -> str:
        """All that the page says."""
        return str(self.value("document.body.innerText"))

    def says(self, words: str) -> str:
        """The text of the page, once these words are in it."""
        found: str = waited(lambda: (t := self.text(), t if words in t else None)[1])
        return found

    def middle(self, element: str) -> tuple[float, float]:
        """Where an element is, once it is there; `element` is an expression of JavaScript."""
        script = f"(()=>{{const e={element};if(!e)return null;const r=e.getBoundingClientRect();"
        script += "return r.width?[r.x+r.width/2,r.y+r.height/2]:null})()"
        x, y = waited(lambda: self.value(script))
        return float(x), float(y)

    def click(self, x: float, y: float) -> None:
        self.mouse("mouseMoved", x, y)
        time.sleep(0.3)  # what lies under the pointer is found in a frame of the page
        self.mouse("mousePressed", x, y)
        self.mouse("mouseReleased", x, y)

    def drag(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        self.mouse("mousePressed", *start)
        for share in (0.3, 0.6, 1.0):
            between = (a + share * (b - a) for a, b in zip(start, end, strict=True))
            self.mouse("mouseMoved", *between)
        self.mouse("mouseReleased", *end)

    def press(self, words: str) -> None:
        """Click on the button, or heading of a folder, of these words."""
        self.click(*self.middle(element("*", words)))

    def choose(self, label: str, option: str) -> None:
        """Take an option of a dropdown."""
        parent = "((e)=>{while(e&&!e.querySelector('input'))e=e.parentElement;return e&&"
        parent += "e.querySelector('input')})"
        self.click(*self.middle(f"{parent}({element('label', label)})"))
        self.click(*self.middle(element("[role=option]", option)))

    def faults(self) -> list[Any]:
        """Errors of the console, exceptions, and hosts other than this one."""
        wrong: list[Any] = []
        for event in self.events:
            method, params = event.get("method"), event.get("params", {})
            if method == "Runtime.exceptionThrown":
                wrong.append(params)
            if method == "Runtime.consoleAPICalled" and params["type"] == "error":
                wrong.append(params["args"])
            if method == "Log.entryAdded" and params["entry"]["level"] == "error":
                wrong.append(params["entry"])
            if method == "Network.requestWillBeSent":
                url = urlsplit(params["request"]["url"])
                if url.scheme in ("http", "https", "ws", "wss") and url.hostname != "127.0.0.1":
                    wrong.append(url.geturl())
        return wrong

    def mouse(self, kind: str, x: float, y: float) -> None:
        self.ask(
            "Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1
        )


def element(selector: str, words: str) -> str:
    """JavaScript for the innermost element that a selector finds and that says these words."""
    found = f"[...document.querySelectorAll({json.dumps(selector)})]"
    return f"{found}.findLast(e=>e.textContent.trim()==={json.dumps(words)})"


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
