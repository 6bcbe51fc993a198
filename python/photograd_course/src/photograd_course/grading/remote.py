"""A submission in a worker process, as the checks see it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from ..worker.codec import Frame
from ..worker.process import WorkerDied, WorkerLied, WorkerStarved, WorkerTimeout, contains_function
from ..worker.screen import PURE
from .failures import MachineTooBusy, StudentFailure
from .local import not_implemented
from .trial import Breach

START_SECONDS = 30.0
MOST_REFUSED = 5  # imports that are named
USES_REFUSED = "uses a module that it may not import"


@dataclass(frozen=True)
class Hand:
    """What a worker loads.

    Attributes:
        sources: module name to text, in the order of import.
        graded: names of those that the student wrote; their imports are screened.
        allowed: top-level modules these may import.
        substitutes: "module.function" to the function that replaces it.
        adjoints: functions that the rule is about that adjoints are written.
    """

    sources: Mapping[str, str]
    graded: Sequence[str]
    allowed: Sequence[str]
    substitutes: Mapping[str, Callable[..., Any]] = field(default_factory=dict)
    adjoints: Sequence[str] = ()


class Connection(Protocol):
    """A started worker; `worker.process.WorkerProcess` is one."""

    def request(self, kind: str, value: Any, *, seconds: float, callbacks: int = ...) -> Frame:
        """Send a frame and wait for its answer."""

    @property
    def spent(self) -> float:
        """Seconds that requests have taken, without the waiting that is not the worker's own."""

    def cpu_seconds(self) -> float | None:
        """Processor time of the worker and its children, measured from outside."""

    def kill(self) -> None:
        """End it, and all that it has started."""


class RemoteStudent:
    """Loads the submission into a started worker and forwards calls.

    Attributes:
        refused: a sentence for each import that its modules may not have.
    """

    def __init__(self, connection: Connection, hand: Hand) -> None:
        self._connection = connection
        self.breaches: dict[str, Breach] = {}
        self.refused: tuple[str, ...] = ()
        try:
            if hand.adjoints:
                self._screen(hand)
            self._load(hand)
        except BaseException:
            connection.kill()
            raise

    def _screen(self, hand: Hand) -> None:
        """Nothing of the submission runs yet, so what the worker says is its own word."""
        sources = {name: hand.sources[name] for name in hand.graded}
        value = {"sources": sources, "adjoints": list(hand.adjoints)}
        found = self._ask("screen", value, START_SECONDS, "while being read").value
        for function, breach in found.items():
            file, line, what = breach["file"], breach["line"], breach["what"]
            said = f"{function} {what} ({file}, line {line}): write its derivative"
            self.breaches[function] = said, (file, line)

    def _load(self, hand: Hand) -> None:
        frame = self._ask(
            "load",
            {
                "sources": dict(hand.sources),
                "graded": list(hand.graded),
                "allowed": list(hand.allowed),
                "substitutes": dict(hand.substitutes),
            },
            START_SECONDS,
            "while being imported",
        )
        if frame.kind == "loaded":
            self.refused = _refused(frame.value, hand.allowed)
            return
        if frame.kind in {"unreadable", "broken"}:
            says = "cannot be read as Python" if frame.kind == "unreadable" else "does not import"
            kind, text, line = _described(frame.value)
            where = f"{line[0]}, line {line[1]}: " if line else ""
            raise StudentFailure(frame.kind, f"{where}{says}: {kind}", f"{kind}: {text}", line)
        raise StudentFailure("protocol", "the submission interfered with the worker")

    def call(self, function: str, args: Sequence[Any], *, seconds: float) -> Any:
        """See Student."""
        return self._call({"function": function, "args": list(args)}, seconds)

    def look(
        self, function: str, args: Sequence[Any], *, seconds: float, layout: str
    ) -> tuple[Any, Any]:
        """See Student."""
        request = {"function": function, "args": list(args), "layout": layout}
        found = self._call(request, seconds)
        if not isinstance(found, dict) or set(found) != {"value", "args"}:
            raise StudentFailure("protocol", "the submission interfered with the worker")
        return found["value"], found["args"]

    def watch(
        self, function: str, args: Sequence[Any], puts: Any, *, seconds: float
    ) -> tuple[Any, Any]:
        """See Student for function, args, puts and seconds."""
        request = {"function": function, "args": list(args), "puts": puts}
        found = self._call(request, seconds, "watch")
        if not isinstance(found, dict) or set(found) != {"value", "trace"}:
            raise StudentFailure("protocol", "the submission interfered with the worker")
        return found["value"], found["trace"]

    def _call(self, request: dict[str, Any], seconds: float, kind: str = "call") -> Any:
        function = request["function"]
        name = function.rpartition(".")[2]
        frame = self._ask(kind, request, seconds, f"in {name}")
        if frame.kind == "result" and not contains_function(frame.value):
            return frame.value
        if frame.kind == "raised":
            kind, text, line = _described(frame.value)
            if kind == "NotImplementedError":
                raise not_implemented(function, text, line)
            if kind == "ImportRefused":
                raise StudentFailure("forbidden", f"{name} {USES_REFUSED}", text, line)
            where = f" ({line[0]}, line {line[1]})" if line else ""
            said = f"{name} raised {kind}{where}"
            raise StudentFailure("raised", said, f"{kind}: {text}", line)
        if frame.kind == "missing":
            raise StudentFailure("missing", f"there is no function {name}")
        if frame.kind == "unsendable":
            raise StudentFailure("output", f"{name} returned {str(frame.value)[:200]}")
        raise StudentFailure("protocol", "the submission interfered with the worker")

    def cpu_seconds(self) -> float | None:
        """See Student."""
        return self._connection.cpu_seconds()

    def close(self) -> None:
        """End the worker."""
        self._connection.kill()

    def _ask(self, kind: str, value: Any, seconds: float, where: str) -> Frame:
        try:
            return self._connection.request(kind, value, seconds=seconds)
        except WorkerTimeout as late:
            said = f"{str(late) or f'no answer within {seconds:g} seconds'} {where}"
            raise StudentFailure("timeout", said) from None
        except WorkerStarved as error:
            raise MachineTooBusy(str(error)) from None
        except WorkerDied:
            said = f"the process ended {where} (a crash, an exit, or out of memory)"
            raise StudentFailure("died", said) from None
        except WorkerLied as error:
            said = f"what came back {where} is no valid answer"
            raise StudentFailure("protocol", said, str(error)) from None


def _described(value: Any) -> tuple[str, str, tuple[str, int] | None]:
    """Type, text and line out of a frame that may hold anything."""
    if not isinstance(value, dict):
        return "an exception", "", None
    kind, text, line = value.get("type"), value.get("text"), value.get("line")
    place = None
    if isinstance(line, list) and len(line) == 2 and isinstance(line[1], int):
        place = (str(line[0])[:80], line[1])
    name = kind[:60] if isinstance(kind, str) and kind.isidentifier() else "an exception"
    return name, str(text)[:2000], place


def _refused(problems: Any, allowed: Sequence[str]) -> tuple[str, ...]:
    """What is said of imports: the worker names them, and may be lied to."""
    permitted = ", ".join(sorted({*allowed, *PURE}))
    found = []
    for problem in problems[:MOST_REFUSED] if isinstance(problems, list) else []:
        if isinstance(problem, dict) and isinstance(problem.get("line"), int):
            file, module = (str(problem.get(key))[:60] for key in ("file", "module"))
            found.append(
                f"{file}, line {problem['line']}: imports {module}; functions that use it get no "
                f"points. A graded module may import {permitted}"
            )
    return tuple(found)
