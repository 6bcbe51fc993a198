"""How good a model is: PSNR and SSIM on held-out views, under a protocol that is printed with them.

Rankings move with the background, the resolution and the rounding, so there is one protocol: full
resolution of the capture, truth and rendering composited over white in display (sRGB) values,
clipped and rounded to 8 bits, PSNR and SSIM averaged over views.

Only what was photographed is scored. Undistortion leaves a border without truth, and a mask says
which pixels are none: PSNR is that of the valid pixels, SSIM that of the windows that hold no
others. A view without such a window has no score; it is named and left out of both means.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd_course.metrics import psnr, ssim, whole_windows

from photograd._checks import require_instance
from photograd._notebook import EDGE, as_html, png_of_sheet, sheet
from photograd.capture.camera import Camera
from photograd.capture.view import View, display_color
from photograd.errors import DtypeError, RangeError, message
from photograd.fitting.drawing import display_field, over_white, render_field
from photograd.fitting.model import Model
from photograd.types import Array

WORST = 4
"""Views that a notebook shows of an evaluation."""


@dataclass(frozen=True)
class ViewScore:
    """One view's score and pictures (H, W, 3), display values in multiples of 1/255.

    Scored are the pixels that `valid` (H, W) says the photograph has.
    """

    name: str
    psnr: float
    ssim: float
    truth: Array
    render: Array
    valid: NDArray[np.bool_]

    @property
    def valid_share(self) -> float:
        """Valid pixels, as a fraction of all of the view."""
        return float(self.valid.mean())

    def _repr_png_(self) -> bytes:
        """The photograph and the rendering beside it."""
        return png_of_sheet(sheet([self.truth, self.render], 2, EDGE // 2))


@dataclass(frozen=True)
class Evaluation:
    """Scores of all views, their means, and the protocol they hold under.

    `left_out` names the views that have no 11 x 11 window of valid pixels.
    """

    views: tuple[ViewScore, ...]
    protocol: str
    left_out: tuple[str, ...] = ()

    def _repr_html_(self) -> str:
        """The means, and the worst views with their renderings."""
        worst = sorted(self.views, key=lambda view: view.psnr)[:WORST]
        pictures = [image for view in worst for image in (view.truth, view.render)]
        facts = {"PSNR": f"{self.psnr:.2f} dB", "SSIM": f"{self.ssim:.3f}"}
        facts |= {"protocol": self.protocol, "shown": ", ".join(view.name for view in worst)}
        return as_html("Evaluation", facts, png_of_sheet(sheet(pictures, 4, EDGE // 2)))

    @property
    def psnr(self) -> float:
        """Mean PSNR in dB."""
        return float(np.mean([view.psnr for view in self.views]))

    @property
    def ssim(self) -> float:
        """Mean SSIM."""
        return float(np.mean([view.ssim for view in self.views]))


def render_camera(
    model: Model, camera: Camera, *, stop: float = 1e-4
) -> tuple[Array, Array, Array]:
    """Premultiplied color (H, W, 3), opacity (H, W) and depth (H, W) seen by a camera.

    Colors are linear or display values, as the field's `color_space` says.

    Args:
        model: what is drawn.
        camera: where it is seen from.
        stop: transmittance below which a ray ends.
    """
    return render_field(model.field, camera, stop)


def display_image(model: Model, camera: Camera) -> Array:
    """The model (H, W, 3) in display values, over white or its learned background.

    Args:
        model: what is drawn.
        camera: where it is seen from.
    """
    return display_field(model.field, model.background, camera)


def truth_image(view: View) -> Array:
    """The photograph (H, W, 3) under the same protocol.

    Args:
        view: the photograph.
    """
    rgba = view.rgba().astype(np.float64)
    color = display_color(rgba[..., :3], view.color_space)
    return over_white(color, rgba[..., 3])


def score_view(model: Model, view: View) -> ViewScore | None:
    """Score the model on one photograph; None if that has no 11 x 11 window of valid pixels.

    Args:
        model: what is scored.
        view: a photograph that it has not seen.
    """
    valid = view.valid_mask()
    if not whole_windows(valid).any():
        return None
    truth, render = truth_image(view), display_image(model, view.camera)
    scores = psnr(render, truth, valid=valid), ssim(render, truth, valid=valid)
    return ViewScore(view.name, *scores, truth, render, valid)


def evaluate(
    model: Model, views: Sequence[View], *, on_view: Callable[[int], None] | None = None
) -> Evaluation:
    """Score the model on `views`, normally the test split.

    Args:
        model: as `fit` and `load_model` return it.
        views: photographs that it has not seen, such as `capture.test`.
        on_view: called after each view with the number of views that are scored.

    Returns:
        PSNR and SSIM, means and those of each view, and the protocol that they hold under.

    Raises:
        DtypeError: no `Model`, or no sequence of `View`s.
        RangeError: no views, or none with an 11 x 11 window of valid pixels.
        IoError: a photograph or a mask that cannot be read.

    Example:
        >>> capture = photograd.load_capture("photos")
        >>> model = photograd.fit(capture, resolution=16, steps=20, rays=256)
        >>> scores = photograd.evaluate(model, capture.test)
        >>> scores.psnr > 5, [view.name for view in scores.views]
        (True, ['test/r_000'])
    """
    require_instance("evaluate", "model", model, Model, "load_model reads one, fit makes one")
    if not isinstance(views, Sequence) or not all(isinstance(view, View) for view in views):
        expected, got = "a sequence of Views", type(views).__name__
        raise DtypeError(message("evaluate", "views", expected, got, "such as capture.test"))
    if not views:
        raise RangeError(
            message(
                "evaluate",
                "views",
                "at least one held-out view",
                "none",
                "the capture has no test split",
            )
        )
    found = []
    for number, view in enumerate(views):
        found.append(score_view(model, view))
        if on_view:
            on_view(number + 1)
    scores = tuple(score for score in found if score is not None)
    left_out = tuple(v.name for v, score in zip(views, found, strict=True) if score is None)
    if not scores:
        expected = "a view with an 11x11 window of valid pixels"
        got = f"none in {', '.join(left_out)}"
        remedy = "look at their masks and their lens"
        raise RangeError(message("evaluate", "views", expected, got, remedy))
    return Evaluation(scores, protocol(model, scores, left_out), left_out)


def protocol(model: Model, scores: Sequence[ViewScore], left_out: Sequence[str] = ()) -> str:
    """The sentence that belongs next to every number.

    Args:
        model: that was scored.
        scores: of its views.
        left_out: names of views without a score.
    """
    sizes = sorted({(score.valid.shape[1], score.valid.shape[0]) for score in scores})
    size = ", ".join(f"{w}x{h}" for w, h in sizes)
    behind = "white" if model.background is None else "white, render over its learned background"
    sentence = (
        f"{len(scores)} held-out views at {size}, composited over {behind} in sRGB, "
        "rounded to 8 bits; mean of per-view PSNR and SSIM (11x11 Gaussian window)"
    )
    valid = sum(int(score.valid.sum()) for score in scores)
    pixels = sum(score.valid.size for score in scores)
    if valid < pixels:
        sentence += f" over valid pixels, {100 * valid / pixels:.1f} % of all"
    if left_out:
        sentence += f"; left out, without a window of valid pixels: {', '.join(left_out)}"
    return sentence


def as_result(evaluation: Evaluation) -> dict[str, Any]:
    """The evaluation for tables and the machine-readable last line."""
    return {
        "psnr": evaluation.psnr,
        "ssim": evaluation.ssim,
        "protocol": evaluation.protocol,
        "views": [
            {"name": v.name, "psnr": v.psnr, "ssim": v.ssim, "valid_share": v.valid_share}
            for v in evaluation.views
        ],
        "left_out": list(evaluation.left_out),
    }


# How much the step of the march matters: the same views again, with half the step.


VISIBLE = 1e-3
"""Of white, linear: a quarter of one of 256 levels near white."""
MAX_VIEWS = 3


@dataclass(frozen=True)
class StepChange:
    """By how much pixels change when the step is halved: the largest of their three channels."""

    largest: float
    mean: float
    share: float  # of the pixels that change by more than VISIBLE
    views: int


def step_change(
    model: Model, views: Sequence[View], *, max_views: int = MAX_VIEWS
) -> StepChange | None:
    """Compare at most `max_views` of the views, evenly spaced; None for a field without steps.

    Colors are premultiplied and as the field has them, so that no background takes part; rays are
    not stopped early.

    Args:
        model: whose step is halved.
        views: whose cameras are taken.
        max_views: at most so many of them.
    """
    dt = model.field.dt
    if dt is None or not views:
        return None
    chosen = views[:: -(-len(views) // max_views)]
    models = model, replace(model, field=model.field.with_dt(0.5 * dt))
    changes = []
    for view in chosen:
        coarse, fine = (render_camera(each, view.camera, stop=0.0)[0] for each in models)
        changes.append(np.abs(fine - coarse).max(axis=-1).ravel())
    change = np.concatenate(changes)
    return StepChange(
        float(change.max()),
        float(change.mean(dtype=np.float64)),
        float((change > VISIBLE).mean()),
        len(chosen),
    )


def as_entry(change: StepChange | None) -> dict[str, Any]:
    """{"half_step": ...} for the result of `photograd evaluate`; {} where there is no step.

    Args:
        change: what `step_change` returned.
    """
    return {} if change is None else {"half_step": asdict(change)}
