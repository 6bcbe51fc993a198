"""The worker: loads one submission and answers calls until the pipe closes.

Started by `home.BOOT`; standard library and NumPy only. Everything it says may be forged by the
submission once that is loaded: the grader believes nothing but values it can check. Until then it
speaks for itself: "ready" names the layers of isolation that it has found to hold.
"""

from __future__ import annotations

import ast
import importlib
import sys
from types import ModuleType
from typing import Any

from . import refused
from .adjoint_rule import breaches
from .adjoint_watch import Watch
from .channel import Channel
from .codec import FrameError
from .courtesy import behave
from .layouts import laid_out, without_functions
from .modules import SourceFinder, line_of
from .screen import without_forbidden

LONGEST_MESSAGE = 2000


def main() -> None:
    """Start, load, serve."""
    channel = Channel.from_standard_streams()
    start = channel.receive()
    channel.send(
        "ready", {"python": list(sys.version_info[:3]), "layers": apply(start.value, channel)}
    )
    request = channel.receive()
    if request.kind == "screen":
        channel.send("screened", breaches(request.value["sources"], request.value["adjoints"]))
        request = channel.receive()
    load = request.value
    trees: dict[str, ast.Module] = {}
    modules = load_modules(channel, load, trees)
    if modules is None:
        return
    watch = Watch(load["sources"], load["substitutes"], trees)
    while True:
        try:
            request = channel.receive()
        except EOFError:
            return
        if request.kind == "watch":
            answer_watched(channel, watch, request.value)
        else:
            answer(channel, modules, request.value, list(load["sources"]))


def apply(policy: Any, channel: Channel) -> list[str]:
    """Put the layers of the policy in force and name those that hold; without one, be polite."""
    if not policy:
        behave()
        return []
    # Here, since it does not exist on every system.
    from .confine import confine

    return confine(policy, channel.descriptors)


def load_modules(
    channel: Channel, load: dict[str, Any], trees: dict[str, ast.Module]
) -> dict[str, ModuleType] | None:
    """Import the submission, and put the grader's functions in the place of substituted ones.

    "loaded" names the imports that bind stand-ins; ``trees`` gets the modules that have some.
    """
    sources: dict[str, str] = load["sources"]
    own, problems = list(sources), []
    try:
        for name in load["graded"]:
            trees[name], found = without_forbidden(name, sources[name], load["allowed"], own)
            problems += found
    except BaseException as error:
        channel.send("unreadable", describe(error, own))
        return None
    sys.meta_path.append(SourceFinder(sources, trees))
    try:
        modules = refused.load(lambda: {name: importlib.import_module(name) for name in sources})
    except BaseException as error:
        channel.send("broken", describe(error, own))
        return None
    for function, stub in load["substitutes"].items():
        module, _, attribute = function.rpartition(".")
        setattr(modules[module], attribute, stub)
    channel.send("loaded", problems)
    return modules


def answer(
    channel: Channel, modules: dict[str, ModuleType], request: dict[str, Any], own: list[str]
) -> None:
    """Call one function and send what came of it."""
    module, _, attribute = request["function"].rpartition(".")
    try:
        function = getattr(modules[module], attribute, None)
        if not callable(function):
            channel.send("missing", attribute)
            return
        args = request["args"]
        if "layout" in request:
            args = laid_out(args, request["layout"])
        value = function(*args)
        if "layout" in request:
            value = {"value": value, "args": without_functions(args)}
    except BaseException as error:
        channel.send("raised", describe(error, own))
        return
    try:
        channel.send("result", value)
    except FrameError as error:
        channel.send("unsendable", str(error))


def answer_watched(channel: Channel, watch: Watch, request: dict[str, Any]) -> None:
    """Call the function of ``request`` in ``watch`` and send, by ``channel``, value and trace."""
    try:
        value, trace = watch.run(request["function"], request["args"], request["puts"])
        channel.send("result", {"value": value, "trace": trace})
    except BaseException as error:
        channel.send("raised", describe(error, []))


def describe(error: BaseException, own: list[str]) -> dict[str, Any]:
    """Type, text and innermost line of an exception, for the student to read."""
    try:
        text = str(error)[:LONGEST_MESSAGE]
    except BaseException:
        text = "(its text raised another exception)"
    return {"type": type(error).__name__, "text": text, "line": line_of(error, own)}


if __name__ != "photograd_course.worker.__main__":
    main()
