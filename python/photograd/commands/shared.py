"""What the core's commands share: threads, types and checks of arguments."""

from __future__ import annotations

import errno
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from photograd._compiled import _core
from photograd._run_lock import one_run_for, one_run_in
from photograd.errors import IoError, message
from photograd.images.kind import LINEAR_SUFFIXES

PICTURES = (*LINEAR_SUFFIXES, ".png")
SIGNED_PICTURES = tuple(suffix for suffix in PICTURES if suffix != ".hdr")
"""Files that hold numbers below 0, too."""
CaptureArgument = Annotated[
    Path,
    typer.Argument(
        help="Folder of a capture: NeRF/Blender, nerfstudio, COLMAP, LLFF or OpenSfM.",
        metavar="CAPTURE",
    ),
]
ModelArgument = Annotated[
    Path, typer.Argument(help="Folder that a fit wrote, or its model.npz.", metavar="MODEL")
]
DownscaleOption = Annotated[
    int, typer.Option("--downscale", min=1, metavar="N", help="Reduce images N times first.")
]
SizeOption = Annotated[int, typer.Option("--size", min=8, help="Pixels along an edge.")]
SppOption = Annotated[int, typer.Option("--spp", min=1, help="Samples a pixel.")]
StepsOption = Annotated[int, typer.Option("--steps", min=1, help="Steps of gradient descent.")]
ViewsOption = Annotated[int, typer.Option("--views", min=2, help="Training views of a scene.")]
DepthOption = Annotated[
    int, typer.Option("--max-depth", min=1, help="Segments of the longest path.")
]
RadiusOption = Annotated[
    float,
    typer.Option("--radius", help="Meters within which a surface occludes, or photons count."),
]
AllowOutsideOption = Annotated[
    bool,
    typer.Option(
        "--allow-outside",
        help="Let the capture name files outside of its folder; only if you trust it.",
    ),
]


def out_path(text: str | Path) -> Path:
    """The value of --out, checked before the work that it is for.

    Raises:
        BadParameter: an empty name, or one that is too long for this system.
    """
    if not str(text).strip():
        raise typer.BadParameter("expected the name of a file or folder, got an empty one")
    try:
        # Hidden files beside it have longer names: .NAME.sums.npz.PID.tmp
        os.lstat(f"{text}{'x' * 24}")
    except OSError as failure:
        if failure.errno == errno.ENAMETOOLONG:
            got = f"one of {len(Path(text).name)} characters"
            expected = "a name that this system can store"
            raise typer.BadParameter(f"expected {expected}, got {got} (shorten it)") from failure
    return Path(text)


def out_option(help_text: str) -> Any:
    """The option --out of a command."""
    return typer.Option("--out", parser=out_path, metavar="PATH", help=help_text)


def use_threads(threads: int) -> None:
    """Limit the core's threads; 0 means all cores."""
    _core.set_thread_count(threads)


def check_output_name(
    command: str,
    out: Path,
    suffixes: Sequence[str] = PICTURES,
    *,
    folder: str = "",
    parents: bool = False,
) -> None:
    """Refuse an --out of `command` that cannot be written, before the work and not after it.

    Args:
        command: on whose behalf the error speaks.
        out: the name.
        suffixes: ends of names of files that can be written.
        folder: what a folder would hold, where a name without a suffix means one; "" where not.
        parents: whether the folder that it lies in is made.

    Raises:
        IoError: another end of the name, a file where a folder should be or the other way round, or
            a folder that is not there.
    """
    suffix = out.suffix.lower()
    if folder and not suffix:
        if out.exists() and not out.is_dir():
            raise IoError(message(command, "--out", f"a folder for {folder}", f"{out}, a file"))
        return
    if suffix not in suffixes:
        *others, last = suffixes
        expected = f"a name that ends in {', '.join(others)}{' or ' if others else ''}{last}"
        expected += f", or one without a suffix: a folder for {folder}" if folder else ""
        raise IoError(message(command, "--out", expected, out))
    if not (parents or out.parent.is_dir()) or out.is_dir():
        raise IoError(message(command, "--out", "a file in a folder that exists", out))


def hold_output(
    context: typer.Context,
    command: str,
    out: Path,
    suffixes: Sequence[str] = PICTURES,
    *,
    beside: Sequence[Path] = (),
    folder: str = "",
    parents: bool = False,
) -> None:
    """Find out before the work whether `out` can be written, and hold it for this run alone.

    Args:
        context: of the command, with which the hold ends.
        command: on whose behalf the error speaks.
        out: a file, or a folder where `folder` says so.
        suffixes: as for `check_output_name`.
        beside: other files that the command writes.
        folder, parents: as for `check_output_name`.

    Raises:
        IoError: what `check_output_name` refuses, a place that cannot be written to, or that
            another run holds.
    """
    check_output_name(command, out, suffixes, folder=folder, parents=parents)
    if folder and not out.suffix:
        context.with_resource(one_run_in(command, out))
    else:
        context.with_resource(one_run_for(command, out, *beside, parents=parents))


def is_given(context: typer.Context, name: str) -> bool:
    """Whether the command line names an option."""
    source = context.get_parameter_source(name)
    return source is not None and source.name == "COMMANDLINE"
