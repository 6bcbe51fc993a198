"""A graph of passes: which buffers each pass reads and writes, in the order in which they run.

    graph = PassGraph([Pass("light", light, reads=("gbuffer",), writes=("color",)), ...], ["scene"])
    result = graph.run({"scene": scene})
    result["color"], result.milliseconds["light"]

Each buffer is written once, by one pass, before anything reads it: a pass that read its own target
would read what it is writing. So every buffer can be looked at afterwards.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from photograd_course.suggest import choose_from

from photograd._typed import typed_call
from photograd.errors import RangeError, message

PREVIOUS = "previous."
"""Prefix of buffers of the frame before, which a pass may read under the name of its own target."""


@typed_call
@dataclass(frozen=True)
class Pass:
    """One step of a frame.

    Attributes:
        name: of its own.
        run: called with the buffers that it reads, in their order; returns what it writes, a tuple
            if that is more than one buffer.
        reads, writes: names of buffers.
    """

    name: str
    run: Callable[..., Any]
    reads: tuple[str, ...]
    writes: tuple[str, ...]


@typed_call
@dataclass(frozen=True)
class FrameResult:
    """What a graph has made.

    Attributes:
        buffers: by name, inputs included.
        milliseconds: that each pass took, by name, in their order.
    """

    buffers: Mapping[str, Any]
    milliseconds: Mapping[str, float] = field(default_factory=dict)

    def __getitem__(self, name: str) -> Any:
        """A buffer.

        Raises:
            RangeError: no buffer of this name; suggests another.
        """
        return _named("FrameResult", name, self.buffers)


@typed_call
class PassGraph:
    """Passes in the order in which they run."""

    def __init__(self, passes: Iterable[Pass], inputs: Iterable[str] = ()) -> None:
        """Check that all passes can run.

        Args:
            passes: in their order.
            inputs: names of buffers that are given.

        Raises:
            RangeError: two passes of a name, a buffer that a pass reads before it is written, that
                two passes write, or that a pass reads and writes.
        """
        self.passes: tuple[Pass, ...] = tuple(passes)
        self.inputs: tuple[str, ...] = tuple(inputs)
        writer = dict.fromkeys(self.inputs, "the inputs")
        names: set[str] = set()
        for each in self.passes:
            if each.name in names:
                raise _refused("passes", "names of their own", f"two of the name '{each.name}'")
            names.add(each.name)
            _check_reads(each, writer)
            for target in each.writes:
                if target in writer:
                    got = f"'{target}' of '{each.name}', which '{writer[target]}' has written"
                    remedy = "write a buffer of another name"
                    raise _refused("writes", "a buffer that nothing has written", got, remedy)
                writer[target] = each.name

    @property
    def buffers(self) -> tuple[str, ...]:
        """Names of all buffers, inputs first, in the order in which they are written."""
        return (*self.inputs, *(target for each in self.passes for target in each.writes))

    def needed_for(self, wanted: Collection[str]) -> tuple[Pass, ...]:
        """The passes without which the buffers `wanted` cannot be made, in their order.

        Raises:
            RangeError: a name of no buffer.
        """
        for name in wanted:
            _named("PassGraph.needed_for", name, dict.fromkeys(self.buffers))
        open_reads = set(wanted)
        found = []
        for each in reversed(self.passes):
            if open_reads.intersection(each.writes):
                found.append(each)
                open_reads.update(each.reads)
        return tuple(reversed(found))

    def run(
        self,
        given: Mapping[str, Any],
        wanted: Collection[str] | None = None,
        report: Callable[[str], None] | None = None,
        clock: Callable[[], float] = time.perf_counter,
    ) -> FrameResult:
        """Run the passes.

        Args:
            given: the inputs.
            wanted: buffers that are asked for: passes that do not serve them are left out, and
                other buffers are dropped after their last reader. None runs and keeps all.
            report: is called with the name of each pass before it runs.
            clock: seconds; `time.process_time` counts this process alone, all its threads together.

        Raises:
            RangeError: an input that is not given, or a name of no buffer.
            Error: what a pass raises.
        """
        passes = self.passes if wanted is None else self.needed_for(wanted)
        buffers: dict[str, Any] = {}
        for name in self.inputs:
            if name not in given:
                got = ", ".join(given) or "none"
                raise RangeError(message("PassGraph.run", "given", f"a buffer '{name}'", got))
            buffers[name] = given[name]
        milliseconds = {}
        for number, each in enumerate(passes):
            if report is not None:
                report(each.name)
            start = clock()
            made = each.run(*(buffers[name] for name in each.reads))
            milliseconds[each.name] = 1e3 * (clock() - start)
            buffers.update(zip(each.writes, _as_tuple(each, made), strict=True))
            if wanted is not None:
                still = {name for later in passes[number + 1 :] for name in later.reads}
                kept = still.union(wanted)
                buffers = {name: value for name, value in buffers.items() if name in kept}
        return FrameResult(buffers, milliseconds)

    def table(self) -> str:
        """The passes as lines of text: name, what it reads, what it writes."""
        rows = [(p.name, ", ".join(p.reads), ", ".join(p.writes)) for p in self.passes]
        rows.insert(0, ("pass", "reads", "writes"))
        widths = [max(len(row[k]) for row in rows) for k in range(2)]
        return "\n".join(f"{a:<{widths[0]}}  {b:<{widths[1]}}  {c}".rstrip() for a, b, c in rows)


def _check_reads(each: Pass, writer: Mapping[str, str]) -> None:
    for name in each.reads:
        if name in each.writes:
            got = f"'{each.name}', which reads and writes '{name}'"
            remedy = f"write another buffer, or read '{PREVIOUS}{name}'"
            raise _refused("passes", "a pass that does not read its own target", got, remedy)
        if name not in writer:
            got = f"'{name}' of '{each.name}'"
            near = choose_from(name, writer)
            raise _refused("reads", "a buffer that an earlier pass writes", got, near)


def _as_tuple(each: Pass, made: Any) -> Sequence[Any]:
    if len(each.writes) == 1:
        return (made,)
    if not isinstance(made, tuple) or len(made) != len(each.writes):
        expected = f"a tuple of {len(each.writes)} buffers from '{each.name}'"
        got = f"{len(made)} of them" if isinstance(made, tuple) else type(made).__name__
        raise RangeError(message("PassGraph.run", "run", expected, got))
    return made


def _named(function: str, name: str, known: Mapping[str, Any]) -> Any:
    if name not in known:
        raise RangeError(
            message(function, "name", "a buffer", f"'{name}'", choose_from(name, known))
        )
    return known[name]


def _refused(argument: str, expected: str, got: str, remedy: str = "") -> RangeError:
    return RangeError(message("PassGraph", argument, expected, got, remedy))
