"""`photograd view`: look around in a browser, while everything is rendered by this project."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer
from photograd_course.cli import DebugOption, JsonOption, ThreadsOption, emit, note
from photograd_course.cli.failures import INTERRUPTED

from photograd._signals import stop_on_signals
from photograd.capture import Capture, load_capture
from photograd.commands.drawable import TRACED
from photograd.commands.render_subjects import AUTO, UpOption, check_up
from photograd.commands.shared import DepthOption, SppOption, is_given, use_threads
from photograd.commands.view_drawing import Viewed, viewed_file, viewed_scene
from photograd.commands.view_follow import FolderView, is_fit, viewed_folder
from photograd.commands.view_server import LOOPBACK, Page, free_port
from photograd.errors import Error
from photograd.splats.files import is_gaussian_ply
from photograd.transport.builtin import BUILTIN


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("view")(view)


def view(
    context: typer.Context,
    what: Annotated[
        str,
        typer.Argument(
            help="Folder of a fit, finished or running, or its model.npz; a volume; a file of "
            "Gaussians; the folder of a capture; a scene or mesh file, or the name of a built-in "
            "scene.",
            metavar="WHAT",
        ),
    ],
    capture: Annotated[
        Path | None,
        typer.Option(
            "--capture",
            help="Folder of photographs to show as well; by default what a model was fitted to.",
        ),
    ] = None,
    host: Annotated[
        str,
        typer.Option(
            "--host", help="Address to listen at; 0.0.0.0 shows the page to the whole network."
        ),
    ] = LOOPBACK,
    port: Annotated[
        int,
        typer.Option(
            "--port",
            min=1,
            max=65535,
            help="Port to listen at; without this option the first that is free from here on.",
        ),
    ] = 8080,
    size: Annotated[
        int, typer.Option("--size", min=16, help="Pixels along the longer edge of a picture.")
    ] = 1024,
    up: UpOption = AUTO,
    spp: SppOption = 64,
    max_depth: DepthOption = 8,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001  read by the command line's frame
) -> None:
    """Look at a model, Gaussians, a volume, a capture or a scene in a browser, until Ctrl-C.

    Pictures are rendered here, a quarter of the resolution while the camera moves, then all of it;
    scenes go on with more samples. There are layers for depth and opacity, a slider for the steps
    of a fit, and sliders for the materials and lights of a scene. A click on the picture tells
    which voxel, Gaussian or triangle it shows, with its parameters.

    Photographs are frusta. A click on one looks through it, and layers show it over, beside and
    against the rendering. With photographs there is also the gradient of the loss against the
    nearest one, as 'photograd gradients' draws it. The folder of a running fit is shown as it is
    saved; 'photograd fit --view' shows it as it runs.

    It needs the package viser (the extra "viewer"), and no network.

    Example: photograd view model

    Example: photograd view cornell-box
    """
    use_threads(threads)
    check_up(up)
    with _interruptible():
        viewed, photographs = _found(what, capture, up, spp, max_depth)
        port = free_port(host, port, exact=is_given(context, "port"))
        page = Page(viewed, photographs, host=host, port=port, largest=size)
    _serve(page, what)
    emit({"address": page.address}, as_json=as_json, title="view")


def _serve(page: Page, what: str) -> None:
    """Until a signal; the folder of a fit is looked at again and again."""
    folder = FolderView(Path(what)) if is_fit(Path(what)) else None
    note(f"{page.address} shows {what}; Ctrl-C ends")
    try:
        with stop_on_signals() as stopping:
            while not stopping():
                time.sleep(0.1)
                if folder is not None:
                    folder.look(page)
    finally:
        page.close()


@contextmanager
def _interruptible() -> Iterator[None]:
    """A signal ends the command with its status, wherever it arrives while things are read.

    Python throws away an exception that a signal raises within a finalizer; it is asked for again
    at the end.
    """

    def interrupt() -> None:
        raise KeyboardInterrupt

    with stop_on_signals(interrupt) as stopping:
        try:
            yield
        except KeyboardInterrupt as interrupted:
            raise typer.Exit(stopping.exit_code or INTERRUPTED) from interrupted
    if stopping():
        raise typer.Exit(stopping.exit_code)


def _found(
    what: str, capture: Path | None, up: str, spp: int, max_depth: int
) -> tuple[Viewed | None, Capture | None]:
    """What there is to draw, and photographs; one of them may be None."""
    path = Path(what)
    mesh = path.suffix.lower() == ".ply" and path.is_file() and not is_gaussian_ply(path)
    if what in BUILTIN or mesh or (what.lower().endswith(TRACED) and path.suffix.lower() != ".ply"):
        scene = viewed_scene(what, spp=spp, max_depth=max_depth)
        return scene, None if capture is None else _photographs(capture)
    fit = is_fit(path)
    if path.is_dir() and not fit:
        return None, _photographs(path)
    viewed = viewed_folder(path) if fit else viewed_file(path, up)
    if capture is not None:
        return viewed, _photographs(capture)
    if viewed.capture is None or not Path(viewed.capture).exists():
        return viewed, None
    try:
        return viewed, _photographs(Path(viewed.capture))
    except Error as failure:  # the model is there all the same
        note(f"without photographs: {failure}", style="yellow")
        return viewed, None


def _photographs(folder: Path) -> Capture:
    capture = load_capture(folder)
    for line in capture.conversions:
        note(line)
    return capture
