"""Signals that end a program: heard once, the second acts, ignored ones and others' stay."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
import time
from typing import Any

import pytest
from photograd._signals import ENDING, stop_on_signals

DESCENT = """
import signal, sys
from pathlib import Path
from photograd._descend import changing, descend

class Job:
    step_number, steps, changing = 0, 10**9, False
    def step(self):
        if self.step_number == 5:
            print("ready", flush=True)
        with changing(self):
            self.step_number += 1
        return 0.0
    def save(self, folder):
        (folder / "saved").write_text(str(self.step_number))
        return folder / "saved"

if sys.argv[2] == "nohup":
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
descend(Job(), Path(sys.argv[1]), lambda run: None)
"""


@pytest.mark.parametrize("number", ENDING)
def test_each_is_a_request_and_the_handlers_come_back(number: signal.Signals) -> None:
    before = [signal.getsignal(each) for each in ENDING]
    with stop_on_signals() as stopping:
        assert not stopping()
        assert stopping.exit_code == 0
        signal.raise_signal(number)
        assert stopping()
        assert stopping.exit_code == 128 + number
        assert [signal.getsignal(each) for each in ENDING] == before  # the second one acts
    assert [signal.getsignal(each) for each in ENDING] == before


def test_what_is_ignored_or_handled_by_the_program_stays() -> None:
    seen: list[int] = []

    def own(number: int, _frame: Any) -> None:
        seen.append(number)

    before = {each: signal.getsignal(each) for each in (signal.SIGHUP, signal.SIGTERM)}
    try:
        signal.signal(signal.SIGHUP, signal.SIG_IGN)
        signal.signal(signal.SIGTERM, own)
        with stop_on_signals() as stopping:
            signal.raise_signal(signal.SIGHUP)
            signal.raise_signal(signal.SIGTERM)
            assert not stopping()
        assert seen == [signal.SIGTERM]
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def test_what_a_shell_ignores_in_the_background_is_heard() -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with stop_on_signals() as stopping:
            signal.raise_signal(signal.SIGINT)
        assert stopping()
        with pytest.raises(KeyboardInterrupt):
            stopping.deliver()
    finally:
        signal.signal(signal.SIGINT, before)


def test_another_thread_hears_nothing() -> None:
    found: list[bool] = []

    def run() -> None:
        with stop_on_signals() as stopping:
            found.append(stopping())

    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    assert found == [False]


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_script_saves_before_it_ends(number: signal.Signals, tmp_path: Any) -> None:
    words = [sys.executable, "-c", DESCENT, str(tmp_path), "plain"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        process.send_signal(number)
        assert process.wait(60) == -number
    assert int((tmp_path / "saved").read_text()) > 0


def test_nohup_is_respected(tmp_path: Any) -> None:
    words = [sys.executable, "-c", DESCENT, str(tmp_path), "nohup"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        process.send_signal(signal.SIGHUP)
        time.sleep(0.2)
        assert process.poll() is None
        process.send_signal(signal.SIGTERM)
        assert process.wait(60) == -signal.SIGTERM
