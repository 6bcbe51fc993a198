"""Runs of a derivative under watch, each in modules that were loaded afresh for it.

Nothing that an earlier run has kept in its modules is there in a later one.
"""

from __future__ import annotations

import ast
import builtins
import copy
import importlib
import sys
from collections.abc import Callable, Mapping
from types import CodeType
from typing import Any

from . import refused
from .adjoint_probes import PROBE, Place, instrumented
from .adjoint_trace import Trace
from .modules import SourceFinder


class Watch:
    """Loads a submission with probes, as often as it is asked."""

    def __init__(
        self,
        sources: Mapping[str, str],
        substitutes: Mapping[str, Callable[..., Any]],
        trees: Mapping[str, ast.Module] | None = None,
    ) -> None:
        """Keep it; it is compiled when it first runs.

        Args:
            sources: module name to text, in the order of import.
            substitutes: "module.function" to the function that replaces it.
            trees: what is run instead of the texts of some.
        """
        self.places: list[Place] = []
        self._sources, self._substitutes = sources, substitutes
        self._trees = trees or {}
        self._codes: dict[str, CodeType] = {}

    def run(
        self, function: str, args: list[Any], puts: Mapping[str, Any] | None
    ) -> tuple[Any, dict[str, Any]]:
        """The value of ``function(*args)``, and what its probes saw; see `Trace` for ``puts``."""
        for name in self._sources if not self._codes else ():
            tree = self._trees.get(name) or ast.parse(self._sources[name], f"{name}.py")
            self._codes[name] = instrumented(copy.deepcopy(tree), f"{name}.py", self.places)
        kept = {name: sys.modules.pop(name) for name in self._sources if name in sys.modules}
        finder = _Compiled(self._sources, self._codes)
        trace = Trace(self.places, puts)
        # While modules are loaded, nothing is recorded: what they compute depends on no argument.
        setattr(builtins, PROBE, lambda _, value: value)
        sys.meta_path.insert(0, finder)
        try:
            modules = refused.load(
                lambda: {name: importlib.import_module(name) for name in self._sources}
            )
            for target, stub in self._substitutes.items():
                module, _, attribute = target.rpartition(".")
                setattr(modules[module], attribute, stub)
            module, _, attribute = function.rpartition(".")
            setattr(builtins, PROBE, trace)
            value = getattr(modules[module], attribute)(*args)
            return value, trace.to_frame() if puts is None else {}
        finally:
            setattr(builtins, PROBE, lambda _, value: value)
            finder.remove()
            sys.modules.update(kept)


class _Compiled(SourceFinder):
    """Finds modules whose code is there already."""

    def __init__(self, sources: Mapping[str, str], codes: Mapping[str, CodeType]) -> None:
        super().__init__(sources)
        self._codes = codes

    def get_code(self, fullname: str) -> CodeType:
        """The compiled module ``fullname``."""
        return self._codes[fullname]
