"""The signals that end a program, heard between two steps, so that what was computed is saved.

    with stop_on_signals() as stopping:
        while not stopping():
            step()
    save()
    stopping.deliver()  # what the signal asked for: KeyboardInterrupt, or the end of the process

Ctrl-C and a notebook's interrupt send SIGINT, a terminal that closes SIGHUP, and the manager of
services SIGTERM. All of them are handled here, and nowhere else.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

_NAMES = ("SIGINT", "SIGTERM", "SIGHUP")
ENDING = tuple(getattr(signal, name) for name in _NAMES if hasattr(signal, name))


class StopRequest:
    """Becomes true when a signal arrives that would end the program.

    Attributes:
        signal: its number, or None.
    """

    def __init__(self) -> None:
        """Begin without a signal."""
        self.signal: int | None = None

    def __call__(self) -> bool:
        """Whether a signal has arrived."""
        return self.signal is not None

    @property
    def exit_code(self) -> int:
        """128 + signal number, as shells expect; 0 without one."""
        return 0 if self.signal is None else 128 + self.signal

    def deliver(self) -> None:
        """Do now what the signal asked for, with the handlers that were there before.

        Raises:
            KeyboardInterrupt: it was SIGINT, as a rule. SIGTERM and SIGHUP end the process.
        """
        if self.signal is not None:
            signal.raise_signal(self.signal)
            if signal.getsignal(self.signal) == signal.SIG_IGN:
                raise KeyboardInterrupt


@contextmanager
def stop_on_signals(
    heard: Callable[[], None] = lambda: None, *, all_of_them: bool = False
) -> Iterator[StopRequest]:
    """Take the first signal that would end the program as a request; a second one acts as usual.

    SIGHUP and SIGTERM stay ignored where they are, as under nohup. SIGINT does not: shells ignore
    it for commands in the background, where the keyboard cannot send it, but `kill -INT` can. What
    the program handles by itself stays with it. Threads other than the main one hear nothing.

    Args:
        heard: called by the handler.
        all_of_them: take also those after the first one as requests.
    """
    request = StopRequest()
    previous: dict[int, Any] = {}

    def restore() -> None:
        for number, handler in previous.items():
            signal.signal(number, handler)

    def note(number: int, _frame: FrameType | None) -> None:
        request.signal = number
        if not all_of_them:
            restore()
        heard()

    if threading.current_thread() is threading.main_thread():
        for number in ENDING:
            handler = signal.getsignal(number)
            ignored = handler == signal.SIG_IGN and number == signal.SIGINT
            if ignored or handler in (signal.SIG_DFL, signal.default_int_handler):
                previous[number] = handler
                signal.signal(number, note)
    try:
        yield request
    finally:
        restore()
