"""`photograd info`: what is this capture or model?"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from photograd_course.cli import DebugOption, JsonOption, emit

from photograd.capture.bounds import estimate_bounds
from photograd.capture.load import load_capture
from photograd.commands.shared import AllowOutsideOption
from photograd.fitting.model import Model, load_model


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("info")(info)


def info(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A capture or a model.")],
    allow_outside: AllowOutsideOption = False,
    as_json: JsonOption = False,
    debug: DebugOption = False,  # noqa: ARG001
) -> None:
    """Say what a capture or a model contains.

    Example: photograd info model
    """
    is_model = file.suffix == ".npz" or (file / "model.npz").is_file()
    result = describe_model(file) if is_model else describe_capture(file, allow_outside)
    emit(result, as_json=as_json, title=str(file))


def describe_model(path: Path) -> dict[str, Any]:
    """Step, size, box and options of a model."""
    model = load_model(path)
    params = model.field.params
    last = model.history[-100:, 2] if len(model.history) else np.array([np.nan])
    return {
        "kind": "model",
        "representation": model.field.name,
        "shape": list(model.field.shape),
        "megabytes": sum(values.nbytes for values in params.values()) / 1e6,
        "box": model.field.box,
        **step_of(model),
        "step": model.meta["step"],
        "steps": model.options.steps,
        "batch_psnr": float(last.mean()),
        "capture": model.meta.get("capture", "unknown"),
        "split": model.meta.get("split", "unknown"),
        "seed": model.options.seed,
    }


def step_of(model: Model) -> dict[str, float]:
    """Distance of samples along a ray, in meters, of what is marched."""
    dt = model.field.dt
    return {} if dt is None else {"dt": dt}


def describe_capture(path: Path, allow_outside: bool = False) -> dict[str, Any]:
    """Views, sizes, color space, bounds and conversions of a capture."""
    capture = load_capture(path, allow_outside=allow_outside)
    bounds = estimate_bounds(capture)
    sizes = sorted({f"{v.camera.width}x{v.camera.height}" for v in capture.views})
    return {
        "kind": "capture",
        "format": capture.format,
        "train": len(capture.train),
        "test": len(capture.test),
        "val": len(capture.val),
        "sizes": sizes,
        "color_space": capture.color_space,
        "alpha": capture.has_alpha,
        "points": 0 if capture.points is None else len(capture.points),
        "box": bounds.box,
        "box_rule": bounds.rule,
        "split": capture.split_hash(),
        "conversions": list(capture.conversions),
    }
