"""What the core adds to `photograd version`."""

from __future__ import annotations

from photograd._compiled import _core


def describe_core() -> dict[str, object]:
    """Instruction set of the kernels and number of threads; an entry point of `photograd.info`."""
    return {"instruction_set": _core.instruction_set(), "threads": _core.thread_count()}
