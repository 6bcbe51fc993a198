"""The core's commands on a machine without the core: listed, and honest about what is missing."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from importlib.util import find_spec

import typer

from .failures import UnavailableError
from .plugins import PluginProblem

CORE_COMMANDS: tuple[tuple[str, str], ...] = (
    ("capture", "Render photographs of a built-in scene."),
    ("fit", "Recover a scene from photographs."),
    ("render", "Render a recovered scene along a path of cameras."),
    ("view", "Look around in a scene in a browser."),
    ("trace", "Path trace a described scene."),
    ("frame", "Draw a scene as a real-time engine does: rasterized, lit pass by pass."),
    ("bake-ao", "Bake how much of the sky each texel of a mesh sees."),
    ("simplify", "Make a mesh of few triangles look like the mesh it comes from."),
    ("recover", "Recover materials, textures and lights of a path traced scene from pictures."),
    ("vectorize", "Draw a picture with curves, as SVG."),
    ("convert", "Write Gaussians, scenes, fits and cameras as files of other programs."),
    ("evaluate", "Compare a recovered scene with held-out photographs."),
    ("gradients", "Draw where the loss wants matter to appear and to vanish."),
    ("compare", "Fit several representations to the same photographs, side by side."),
    ("demo", "Capture, fit, evaluate and gradients on a built-in scene."),
    ("info", "Say what a capture or a model contains."),
)

INSTALL = "run 'pip install .' in a checkout of photograd, or 'pip install' its wheel"


def add_missing_core_commands(
    app: typer.Typer, present: Iterable[str], problems: Sequence[PluginProblem]
) -> None:
    """Stand in for every core command that no plugin has brought.

    A stand-in takes any arguments, says why it cannot work and exits with code 2.
    """
    known = set(present)
    reason = why_missing(problems)
    for name, summary in CORE_COMMANDS:
        if name not in known:
            _add_stand_in(app, name, summary, reason)


def why_missing(problems: Sequence[PluginProblem]) -> str:
    """Whether the core is not there at all or does not load, and what to do about it."""
    if find_spec("photograd") is None:
        return f"core not installed: only photograd-course is ({INSTALL})"
    if problems:
        failed = "; ".join(f"{problem.name}: {problem.reason()}" for problem in problems)
        return f"core installed, but it does not load: {failed} (build it again: {INSTALL})"
    return f"core incomplete: it brings no such command (install it again: {INSTALL})"


def _add_stand_in(app: typer.Typer, name: str, summary: str, reason: str) -> None:
    @app.command(
        name,
        help=f"{summary}\n\nNot available: {reason}",
        short_help=summary,
        rich_help_panel="Commands of the core (not available here)",
        add_help_option=False,  # so that `photograd fit --help` too says what is missing
        context_settings={"allow_extra_args": True, "ignore_unknown_options": True},
    )
    def stand_in(context: typer.Context) -> None:
        raise UnavailableError(f"{context.command_path}: {reason}")
