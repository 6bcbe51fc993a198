"""`photograd compare`: which representation for which scene."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer
from photograd_course.atomic_io import atomic_write
from photograd_course.cli import DebugOption, JsonOption, SeedOption, ThreadsOption, emit, note
from photograd_course.suggest import choose_from

from photograd._fit_options import FitOptions
from photograd._run_lock import one_run_in
from photograd._signals import StopRequest, stop_on_signals
from photograd.capture.capture import Capture
from photograd.capture.load import load_capture
from photograd.commands.capture import make_capture
from photograd.commands.evaluate import draw_strips
from photograd.commands.fit import first_model, run_with_bar
from photograd.commands.shared import (
    AllowOutsideOption,
    DownscaleOption,
    SizeOption,
    SppOption,
    StepsOption,
    ViewsOption,
    out_option,
    use_threads,
)
from photograd.errors import RangeError, SceneError, message
from photograd.fitting.compare import (
    Candidate,
    Score,
    compare_one,
    markdown,
    parse_candidates,
    source_of,
    worst_view,
)
from photograd.fitting.evaluate import Evaluation
from photograd.fitting.model import Model
from photograd.scenes.registry import scenes

DEFAULTS = FitOptions()
CONTRASTS = ("foliage", "smooth_curves", "fur", "flat_walls")
StartFromOption = Annotated[
    Path | None,
    typer.Option(
        "--start-from",
        help="What a textured_mesh:N starts from, as for 'photograd fit'.",
        metavar="MODEL",
    ),
]
ValidateOption = Annotated[
    bool,
    typer.Option(
        "--validate",
        help="To choose an option: score on every eighth training view, held out from the fit. "
        "The test views are not looked at.",
    ),
]


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("compare")(compare)


def compare(
    context: typer.Context,
    captures: Annotated[
        list[str] | None,
        typer.Argument(
            help=f"Folders of captures, or built-in scenes; by default {', '.join(CONTRASTS)}.",
            metavar="[CAPTURE]...",
        ),
    ] = None,
    out: Annotated[Path, out_option("Folder for models, table and pictures.")] = (
        Path("out/compare")
    ),
    candidates: Annotated[
        str, typer.Option("--candidates", help="Representations with their resolution, or number.")
    ] = "dense_grid:64,dense_grid:128,sparse_sh:128,gaussians:20000",
    start_from: StartFromOption = None,
    steps: StepsOption = 1000,
    rays: Annotated[int, typer.Option("--rays", min=1, help="Rays a step.")] = DEFAULTS.rays,
    views: ViewsOption = 60,
    size: SizeOption = 128,
    spp: SppOption = 64,
    downscale: DownscaleOption = 1,
    allow_outside: AllowOutsideOption = False,
    validate: ValidateOption = False,
    seed: SeedOption = 0,
    threads: ThreadsOption = 0,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001  read by the command line's frame
) -> None:
    """Fit several representations to the same photographs and put the results side by side.

    Writes OUT/table.md, OUT/quality.png (quality against bytes), one picture a capture (its worst
    held-out view), and each model in OUT/CAPTURE/. Stopped by Ctrl-C, the same command line goes
    on where it was.

    An octree_sh:N is cut from the grid of N that stands before it, or from --start-from, and
    refined; a plenoctree:N and leaf_mlps:N from the networks before them; leaf_codes:N take the
    voxels of a grid of N, gaussian_codes:N the Gaussians of N.

    Example: photograd compare foliage fur --candidates dense_grid:128,sparse_sh:128
    """
    use_threads(threads)
    first = first_model(start_from) if start_from else None
    parsed = parse_candidates(candidates, first)
    context.with_resource(one_run_in("compare", out))
    shared = FitOptions(steps=steps, rays=rays, seed=seed)
    scores: list[Score] = []
    pictures: list[Path] = []
    with stop_on_signals() as stopping:
        for given in captures or CONTRASTS:
            folder = photographs_of(given, out, views=views, size=size, spp=spp, seed=seed)
            name = Path(given).name
            capture = load_capture(folder, downscale=downscale, allow_outside=allow_outside)
            if validate:
                name, capture = f"{name}_validation", capture.with_validation_split()
            start = first, str(start_from)
            found = fit_all(name, capture, parsed, shared, out / name, stopping, start)
            scores += [score for score, _ in found]
            pictures.append(out / f"{name}.png")
            draw([evaluation for _, evaluation in found], parsed, name, pictures[-1])
    pictures.append(draw_plot(scores, out / "quality.png"))
    table = out / "table.md"
    atomic_write(table, markdown(scores).encode())
    rows = [asdict(score) for score in scores]
    protocols = sorted({row.pop("protocol") for row in rows})
    emit(
        {"scores": rows, "protocols": protocols, "table": table, "pictures": pictures},
        as_json=as_json,
        title="compare",
    )


def draw_plot(scores: list[Score], path: Path) -> Path:
    """All scores beside each other."""
    from photograd_course.viz import save_figure

    from photograd.fitting.quality_plot import quality_plot

    return save_figure(quality_plot(scores), path)


def fit_all(
    name: str,
    capture: Capture,
    candidates: list[Candidate],
    shared: FitOptions,
    out: Path,
    stopping: StopRequest,
    start_from: tuple[Model | None, str],
) -> list[tuple[Score, Evaluation]]:
    """Fit and score all candidates on one capture, under progress bars.

    `start_from` is the model of that option, and its file.

    Raises RangeError for a capture without held-out views, typer.Exit if it was stopped.
    """
    if not capture.test:
        raise RangeError(
            message("compare", "CAPTURE", "held-out views", f"none in {capture.source}")
        )
    found = []
    first, first_name = start_from
    folder = {candidate: out / candidate.label.replace(":", "_") for candidate in candidates}
    for candidate in candidates:
        note(f"{name}: {candidate.label}")
        source = source_of(candidate, candidates, first)
        with one_run_in("compare", folder[candidate]):
            result = compare_one(
                name,
                capture,
                candidate,
                folder[candidate],
                candidate.options(shared),
                lambda job, folder: run_with_bar(job, folder, stopping),
                source=folder[source] if isinstance(source, Candidate) else source,
                source_name=first_name,
            )
        if result is None:
            note("stopped; the same command goes on from here")
            raise typer.Exit(stopping.exit_code or 1)
        found.append(result)
    return found


def photographs_of(given: str, out: Path, *, views: int, size: int, spp: int, seed: int) -> Path:
    """The folder of a capture that `given` names; a built-in scene is photographed once.

    Raises SceneError if it is neither a folder nor a scene.
    """
    if Path(given).is_dir():
        return Path(given)
    if given not in scenes():
        remedy = choose_from(given, scenes())
        raise SceneError(
            message("compare", "CAPTURE", "a folder or a built-in scene", repr(given), remedy)
        )
    # Other numbers make other photographs, which may not stand in for these.
    folder = out / given / f"capture_{views}_{size}_{spp}_{seed}"
    if not (folder / "transforms_train.json").exists():  # which is written last
        make_capture(
            given, folder, views=views, test_views=8, size=size, spp=spp, seed=seed, overwrite=True
        )
    return folder


def draw(evaluations: list[Evaluation], candidates: list[Candidate], name: str, path: Path) -> None:
    """Truth, rendering and error of every candidate at the view that all find hardest."""
    caption = f"The held-out view with the lowest mean PSNR of all. {evaluations[0].protocol}."
    labels = [candidate.label for candidate in candidates]
    draw_strips(worst_view(evaluations), labels, path, title=name, caption=caption)
