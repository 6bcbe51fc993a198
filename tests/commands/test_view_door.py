"""The door of `photograd view`: who may come in, broken connections, signals while it reads."""

from __future__ import annotations

import base64
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from photograd.commands import view
from photograd.commands.view_door import may_enter

from support.missing import need_module
from tests.commands.browser import fetched, free_port, waited
from tests.commands.conftest import Photograd

LOCAL = "127.0.0.1"


@pytest.mark.parametrize(
    ("hosts", "origins", "address", "enters"),
    [
        (["127.0.0.1:8080"], [], LOCAL, True),
        (["localhost:8080"], [], LOCAL, True),
        (["LOCALHOST:8080"], ["http://LocalHost:8080"], LOCAL, True),
        (["[::1]:8080"], ["http://[::1]:8080"], "::1", True),
        (["localhost"], [], LOCAL, True),
        (["127.0.0.1:8080"], ["http://localhost:8080"], LOCAL, True),
        (["10.0.0.7:8080"], ["http://10.0.0.7:8080"], "10.0.0.7", True),
        (["render.lab:8080"], ["http://render.lab:8080"], "render.lab", True),
        (["10.0.0.7:8080"], ["http://10.0.0.7:8080"], "0.0.0.0", True),
        ([f"{socket.gethostname()}:8080"], [], "0.0.0.0", True),
        ([], [], LOCAL, False),
        (["127.0.0.1:8080", "evil.example"], [], LOCAL, False),
        (["evil.example"], [], LOCAL, False),
        (["evil.example:8080"], ["http://evil.example:8080"], LOCAL, False),
        (["evil.example:8080"], ["http://evil.example:8080"], "0.0.0.0", False),
        (["127.0.0.1.evil.example:8080"], [], LOCAL, False),
        (["localhost.evil.example:8080"], [], "0.0.0.0", False),
        (["127.0.0.1:8081"], [], LOCAL, False),
        (["10.0.0.7:8080"], [], LOCAL, False),
        (["127.0.0.1:8080"], ["http://evil.example"], LOCAL, False),
        (["127.0.0.1:8080"], ["http://evil.example:8080"], LOCAL, False),
        (["127.0.0.1:8080"], ["http://127.0.0.1:3000"], LOCAL, False),
        (["127.0.0.1:8080"], ["http://localhost"], LOCAL, False),
        (["127.0.0.1:8080"], ["null"], LOCAL, False),
        (["127.0.0.1:8080"], ["file://127.0.0.1:8080"], LOCAL, False),
        (["127.0.0.1:8080"], ["http://127.0.0.1:8080@evil.example"], LOCAL, False),
        (["127.0.0.1:8080"], ["http://127.0.0.1:8080", "http://evil.example"], LOCAL, False),
        ([""], [""], LOCAL, False),
    ],
)
def test_who_may_enter(hosts: list[str], origins: list[str], address: str, *, enters: bool) -> None:
    assert may_enter(hosts, origins, address, 8080) == enters


@pytest.fixture(scope="module")
def server(model_folder: Path) -> Iterator[tuple[subprocess.Popen[str], int]]:
    need_module("viser", by_choice=True)
    port = free_port()
    words = ["view", str(model_folder), "--port", f"{port}"]
    with subprocess.Popen(
        [sys.executable, "-m", "photograd_course", *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        waited(lambda: fetched(f"http://{LOCAL}:{port}"))
        yield process, port
        process.kill()


def answer(port: int, *lines: str, frames: bytes = b"") -> bytes:
    """The beginning of what the server says to a request."""
    with socket.create_connection((LOCAL, port), 20) as door:
        door.settimeout(20)
        door.sendall("\r\n".join(["GET / HTTP/1.1", *lines, "", ""]).encode())
        said = door.recv(1 << 16)
        if frames:
            door.sendall(frames)
            door.settimeout(1)
            try:
                while door.recv(1 << 16):
                    pass
            except OSError:
                pass
        return said


def upgrade(host: str, *more: str) -> list[str]:
    import viser

    key = base64.b64encode(bytes(16)).decode()
    lines = [f"Host: {host}", "Upgrade: websocket", "Connection: Upgrade"]
    lines += [f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13"]
    return [*lines, f"Sec-WebSocket-Protocol: viser-v{viser.__version__}", *more]


def test_pages_of_other_sites_are_refused_at_both_doors(server: Any) -> None:
    process, port = server
    own = f"{LOCAL}:{port}"
    assert b" 101 " in answer(port, *upgrade(own))
    assert b" 101 " in answer(port, *upgrade(own, f"Origin: http://{own}"))
    assert b" 200 " in answer(port, f"Host: {own}", "Connection: close")
    for lines in (
        upgrade(own, "Origin: http://evil.example"),
        upgrade("evil.example"),
        upgrade(f"evil.example:{port}", f"Origin: http://evil.example:{port}"),
        [f"Host: evil.example:{port}", "Connection: close"],
        [f"Host: {own}", "Origin: http://evil.example", "Connection: close"],
    ):
        said = answer(port, *lines)
        assert b" 403 " in said.split(b"\r\n")[0], lines
    assert process.poll() is None


def frame(kind: int, data: bytes, length: int | None = None) -> bytes:
    size = len(data) if length is None else length
    return bytes([0x80 | kind, 0x80 | 127]) + size.to_bytes(8, "big") + bytes(4) + data


def test_broken_connections_say_nothing_on_the_terminal(server: Any) -> None:
    process, port = server
    own = f"{LOCAL}:{port}"
    for frames in (
        frame(2, bytes(range(256))),
        frame(1, b"hello"),
        frame(2, b"xx", 1 << 62),
        b"\xf2\x80\0\0\0\0",
        frame(2, b"\x91" * 60000),
        frame(2, b"\xdd\xff\xff\xff\xff"),
        b"\x82\x01x",
    ):
        answer(port, *upgrade(own), frames=frames)
    with socket.create_connection((LOCAL, port), 20):
        pass  # a browser's spare connection
    with socket.create_connection((LOCAL, port), 20) as half:
        half.sendall(b"GET / HT")
    assert b" 200 " in answer(port, f"Host: {own}", "Connection: close")
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 0
    assert "Traceback" not in err
    assert err.splitlines()[-1].endswith("Ctrl-C ends")  # what it said when it was ready


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)]
)
@pytest.mark.parametrize("swallowed", [False, True], ids=["at once", "in a finalizer"])
def test_a_signal_while_it_reads_ends_it(
    photograd: Photograd,
    monkeypatch: pytest.MonkeyPatch,
    number: signal.Signals,
    code: int,
    *,
    swallowed: bool,
) -> None:
    class Finalized:
        def __del__(self) -> None:
            os.kill(os.getpid(), number)

    def found(*_: Any) -> Any:
        if swallowed:
            Finalized()
            return None, None
        signal.raise_signal(number)
        raise AssertionError("it went on")

    monkeypatch.setattr(view, "_found", found)
    monkeypatch.setattr(view, "Page", lambda *_, **__: None)
    monkeypatch.setattr(sys, "unraisablehook", lambda _: None)
    assert photograd("view", "anything").code == code
