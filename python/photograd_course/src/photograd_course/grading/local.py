"""Code that we trust, called in this very process: the solution, mutants, alternatives.

Values still make the round trip through the codec, so that a check sees exactly what it would see
from a worker. Student code never runs here.
"""

from __future__ import annotations

import importlib
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from types import ModuleType
from typing import Any

from ..worker.codec import FrameError, round_trip
from ..worker.layouts import laid_out, without_functions
from ..worker.modules import SourceFinder, line_of
from .failures import StudentFailure
from .trial import Breach


class LocalStudent:
    """Modules imported from sources into this process.

    The rule that adjoints are written is for students: mutants may break it.

    Args:
        sources: module name to text; later ones may import earlier ones.
        substitutes: "module.function" to the function that replaces it.

    Raises:
        StudentFailure: the sources do not import.
    """

    def __init__(
        self,
        sources: Mapping[str, str],
        substitutes: Mapping[str, Callable[..., Any]] | None = None,
    ) -> None:
        self.breaches: dict[str, Breach] = {}
        self._finder = SourceFinder(sources)
        self._names = list(sources)
        self._used = 0.0
        for name in sources:
            sys.modules.pop(name, None)
        sys.meta_path.insert(0, self._finder)
        try:
            self.modules: dict[str, ModuleType] = {n: importlib.import_module(n) for n in sources}
        except Exception as error:
            text = f"{type(error).__name__}: {error}"
            failure = StudentFailure("broken", "does not import", text, line_of(error, self._names))
            raise failure from error
        finally:
            self._finder.remove()
        for function, replacement in (substitutes or {}).items():
            module, _, attribute = function.rpartition(".")
            setattr(self.modules[module], attribute, replacement)

    def call(self, function: str, args: Sequence[Any], *, seconds: float) -> Any:
        """See Student; there is no clock here."""
        del seconds
        return self._call(function, [_crossing(arg) for arg in args])

    def look(
        self, function: str, args: Sequence[Any], *, seconds: float, layout: str
    ) -> tuple[Any, Any]:
        """See Student."""
        del seconds
        given = laid_out([_crossing(arg) for arg in args], layout)
        value = self._call(function, given)
        return value, round_trip(without_functions(given))

    def watch(self, function: str, args: Sequence[Any], puts: Any, *, seconds: float) -> None:
        """Nothing is watched; see Student for function, args, puts and seconds."""
        del function, args, puts, seconds

    def _call(self, function: str, given: Sequence[Any]) -> Any:
        module, _, attribute = function.rpartition(".")
        target = getattr(self.modules[module], attribute, None)
        if not callable(target):
            raise StudentFailure("missing", f"there is no function {attribute}")
        began = time.process_time()
        try:
            value = target(*given)
        except NotImplementedError as error:
            raise not_implemented(function, str(error), line_of(error, self._names)) from error
        except Exception as error:
            line = line_of(error, self._names)
            text = f"{type(error).__name__}: {error}"
            raise StudentFailure(
                "raised", f"{attribute} raised an exception", text, line
            ) from error
        finally:
            self._used += time.process_time() - began
        try:
            return round_trip(value)
        except FrameError as error:
            raise StudentFailure("output", f"{attribute} returned {error}") from error

    def cpu_seconds(self) -> float | None:
        """Processor time of this process in all calls so far."""
        return self._used

    def close(self) -> None:
        """Nothing is left behind."""


def not_implemented(function: str, text: str, line: tuple[str, int] | None) -> StudentFailure:
    """How a stub ends."""
    # The text of an adapter's stub names the function that is meant; its own name helps nobody.
    module, _, name = function.rpartition(".")
    said = "not implemented yet" if module == "adapters" else f"{name}: not implemented yet"
    return StudentFailure("not implemented", said, text, line)


def _crossing(value: Any) -> Any:
    if not callable(value):
        return round_trip(value)

    def service(*args: Any) -> Any:
        try:
            return round_trip(value(*[round_trip(arg) for arg in args]))
        except Exception as error:
            said = f"a function given to you cannot take these arguments ({type(error).__name__})"
            raise ValueError(said) from error

    return service
