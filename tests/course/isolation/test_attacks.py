"""Submissions that misbehave end as the right kind of failure, and leave nothing behind.

What must not be left (processes of the worker's user, its folder) is asserted by the fixture
`home` after each test.
"""

from __future__ import annotations

import textwrap
from dataclasses import replace
from typing import Any

import pytest
from photograd_course.grading import StudentFailure
from photograd_course.worker.home import WorkerHome

from course.isolation.support import CALL_SECONDS, LIMITS, PATIENT, submission

# Frames as `worker/codec.py` describes them, sent on every open descriptor but the standard ones.
FORGE = """
import json, os, struct, time

def send(header, body=b"", announced=None):
    head = json.dumps(header).encode()
    size = len(body) if announced is None else announced
    send_bytes(struct.pack(">4sIQ", b"PGF1", len(head), size) + head + body)

def send_bytes(data):
    for descriptor in range(3, 64):
        try:
            os.write(descriptor, data)
        except OSError:
            continue

def frame(number, kind="result"):
    return {"kind": kind, "number": number, "value": 1.0, "arrays": []}
"""

# Name: source of a module with f(x), and how the call must end.
ATTACKS = {
    "endless loop": ("while True: pass", "timeout"),
    "sleep": ("import time; time.sleep(1000)", "timeout"),
    "swallowed interruption": (
        """
        import signal
        while True:
            try:
                for n in (signal.SIGTERM, signal.SIGINT): signal.signal(n, signal.SIG_IGN)
                while True: pass
            except BaseException: pass
        """,
        "timeout",
    ),
    "flood": ("while True: print('x' * 100_000, flush=True)", "timeout"),
    "half a frame": ("send(frame(3), announced=50_000_000)\ntime.sleep(1000)", "timeout"),
    "null pointer": ("import ctypes; ctypes.string_at(0)", "died"),
    "early exit": ("os._exit(0)", "died"),
    "closed pipe": ("os.closerange(0, 64)", "died"),
    "another number": ("send(frame(77))\nreturn 0.0", "protocol"),
    "an unknown kind": ("send(frame(3, 'loaded'))\nreturn 0.0", "protocol"),
    "gigantic frame": ("send(frame(3), announced=1 << 60)\nreturn 0.0", "protocol"),
    "nonsense": ("send_bytes(b'x' * 64)\nreturn 0.0", "protocol"),
    "endless callbacks": (
        "while True: send({**frame(3, 'callback'), 'value': {'map': {}}})",
        ("protocol", "timeout"),
    ),
    "huge answer": ("import numpy\nreturn numpy.zeros(9_000_000)", "protocol"),
    "gigantic header": (
        "send_bytes(struct.pack('>4sIQ', b'PGF1', 1 << 31, 0))\nreturn 0.0",
        "protocol",
    ),
    "long message": ("raise ValueError('x' * 10**7)", "raised"),
    "reads standard input": ("input()", "raised"),
}
# What only an enforcing mode stops: source of f(x), and the exception that stops it.
FORBIDDEN = {
    "fork": ("os.fork()", "PermissionError"),
    "another program": ("os.execv('/bin/true', ['true'])", "PermissionError"),
    "socket": ("import _socket; _socket.socket()", "PermissionError"),
    "signal to the parent": ("os.kill(os.getppid(), 9)", "PermissionError"),
    "file here": ("open('file', 'w')", "PermissionError"),
    "file elsewhere": ("open('/tmp/photograd-attempt', 'w')", "PermissionError"),
    "change of rights": ("os.chmod('.', 0)", "PermissionError"),
    "folder": ("os.mkdir('folder')", "PermissionError"),
    "anonymous file": ("os.memfd_create('file')", "PermissionError"),
    "more memory": (
        "import resource; resource.setrlimit(resource.RLIMIT_AS, (1 << 40, 1 << 40))",
        "ValueError",  # "not allowed to raise maximum limit"
    ),
    "another processor": ("os.sched_setaffinity(os.getppid(), {0})", "PermissionError"),
    "the grader": ("import photograd_course", "ModuleNotFoundError"),
    "the core": ("import photograd", "ModuleNotFoundError"),
    "a neighbor of NumPy": ("import matplotlib", "ModuleNotFoundError"),
    "accounts": ("open('/etc/passwd')", ("PermissionError", "FileNotFoundError")),
    "big array": ("import numpy; numpy.ones(10**9)", "MemoryError"),
    "many objects": ("x = []\nwhile True: x.append(bytearray(1 << 20))", "MemoryError"),
    "threads": (
        """
        import threading
        for _ in range(2000): threading.Thread(target=time.sleep, args=(60,), daemon=True).start()
        """,
        ("RuntimeError", "MemoryError"),
    ),
}
NEEDED = ("_socket", "ctypes", "resource", "signal", "threading")


def module(body: str) -> str:
    return FORGE + "\ndef f(x):\n" + textwrap.indent(textwrap.dedent(body).strip(), "    ") + "\n"


def failure(body: str, home: WorkerHome, mode: str) -> StudentFailure:
    home.imports = NEEDED
    student = submission(module(body), home, mode)
    try:
        with pytest.raises(StudentFailure) as caught:
            student.call("toy.f", [1.0], seconds=CALL_SECONDS)
    finally:
        student.close()
    return caught.value


@pytest.mark.parametrize("name", ATTACKS)
@pytest.mark.parametrize("chosen", ["strongest", "E"])
def test_misbehavior_has_a_name(name: str, chosen: str, home: WorkerHome) -> None:
    body, reasons = ATTACKS[name]
    said = failure(body, home, available(chosen))
    assert said.reason in (reasons if isinstance(reasons, tuple) else (reasons,)), said
    assert len(said.text) < 300
    assert len(said.private) < 2100


def test_what_is_forbidden_raises(strict: str, home: WorkerHome) -> None:
    home.imports = NEEDED
    bodies = [textwrap.dedent(body).strip() for body, _ in FORBIDDEN.values()]
    functions = [
        f"def f{k}(x):\n{textwrap.indent(body, '    ')}\n" for k, body in enumerate(bodies)
    ]
    student = submission("import os, time\n" + "".join(functions), home, strict)
    found = {}
    try:
        for k, name in enumerate(FORBIDDEN):
            with pytest.raises(StudentFailure) as caught:
                student.call(f"toy.f{k}", [1.0], seconds=10.0)
            found[name] = caught.value.private.split(":")[0]
    finally:
        student.close()
    assert len(found) == len(FORBIDDEN)
    for name, (_, kinds) in FORBIDDEN.items():
        assert found[name] in (kinds if isinstance(kinds, tuple) else (kinds,)), name


def available(chosen: str) -> str:
    from photograd_course.worker.modes import choose

    from course.isolation.conftest import need

    return choose() if chosen == "strongest" else need(chosen)


@pytest.mark.parametrize("name", ["fork", "file here", "signal to the parent"])
def test_a_laptop_refuses_honest_mistakes_too(name: str, home: WorkerHome) -> None:
    assert "a graded module can" in failure(FORBIDDEN[name][0], home, "E").private


def test_a_worker_that_stops_reading_cannot_block_the_grader(mode: str, home: WorkerHome) -> None:
    import numpy as np

    student = submission(module("send(frame(3))\ntime.sleep(1000)"), home, mode)
    try:
        assert student.call("toy.f", [1.0], seconds=CALL_SECONDS) == 1.0
        with pytest.raises(StudentFailure) as caught:
            student.call("toy.f", [np.zeros(4_000_000)], seconds=CALL_SECONDS)
        assert caught.value.reason == "timeout"
    finally:
        student.close()


def test_the_end_of_a_whole_life_is_told_from_a_slow_answer(home: WorkerHome) -> None:
    student = submission(module("time.sleep(1000)"), home, "E", replace(LIMITS, seconds=6.0))
    try:
        with pytest.raises(StudentFailure) as caught:
            student.call("toy.f", [1.0], seconds=60.0)
    finally:
        student.close()
    assert caught.value.reason == "timeout"
    assert "the time of the whole process is used up" in caught.value.text


@pytest.mark.parametrize(
    "body",
    ["while True: f(x)", "import numpy\nx = numpy.ones(700_000)\nwhile True: f(x)"],
    ids=["small questions, large answers", "large questions"],
)
def test_what_passes_through_a_function_is_limited(body: str, mode: str, home: WorkerHome) -> None:
    import numpy as np
    from photograd_course.worker.process import MOST_SERVED

    kept: list[int] = []

    def asked(x: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
        answer = np.ones(300_000 if len(x) == 1 else 1)
        kept.append(x.nbytes + answer.nbytes)
        return answer

    text = module(body).replace("def f(x)", "def g(f, x)")
    student = submission(text, home, mode, PATIENT)
    try:
        with pytest.raises(StudentFailure) as caught:
            student.call("toy.g", [asked, np.ones(1)], seconds=PATIENT.cpu_seconds)
        assert caught.value.reason == "protocol"
    finally:
        student.close()
    assert 0.9 * MOST_SERVED < sum(kept) < MOST_SERVED + max(kept)


def test_import_time_counts(strict: str, home: WorkerHome) -> None:
    with pytest.raises(StudentFailure) as caught:
        submission("while True: pass", home, strict)
    assert caught.value.reason == "timeout"
    assert "processor time" in caught.value.text


def test_the_flood_is_drained_and_cut(strict: str, home: WorkerHome) -> None:
    from photograd_course.worker.launch import open_worker

    worker = open_worker(home, strict, LIMITS)
    source = {"toy": "def f():\n    for _ in range(300): print('\\xff\\x1b' * 10_000)"}
    load = {"sources": source, "graded": [], "allowed": [], "substitutes": {}}
    assert worker.request("load", load, seconds=10).kind == "loaded"
    frame = worker.request("call", {"function": "toy.f", "args": []}, seconds=10)
    worker.kill()
    assert frame.kind == "result"
    assert 1000 < len(worker.log) <= LIMITS.output_kb << 10
