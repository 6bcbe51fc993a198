"""What can a gradient say about a voxel that does not exist? By experiment.

Nothing: there is no parameter to have one. The picture shows what follows. Three fits of one scene
see the same photographs and take the same steps on a grid that is never refined: one keeps every
voxel; one is pruned once, too early and without mercy; one is pruned at the same step, and from
then on dilated by a voxel every few steps and pruned again, so that matter can grow back at its
rim. `python docs/figures_sparse.py` writes it.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.capture.camera import Camera
from photograd.capture.capture import Capture
from photograd.capture.orbit import orbit_cameras
from photograd.capture.view import View
from photograd.fields import DenseGrid, SparseSh
from photograd.fields.active_voxels import ActiveVoxels
from photograd.fields.march import MarchPolicy
from photograd.fitting import FitOptions
from photograd.fitting.evaluate import evaluate, render_camera
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model
from photograd_course.color import srgb_encode, unpremultiply
from photograd_course.row_map import RowMap
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
IMAGES = Path(__file__).resolve().parent / "images"
BOX = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])
RESOLUTION = 32
STEPS, EARLY, AGAIN = 300, 20, 20
PANEL = 2.4  # inches
THRESHOLD = 0.12  # six times that of a fit
BALLS = (  # center, radius, linear color
    ((-0.4, 0.1, 0.0), 0.35, (0.8, 0.2, 0.1)),
    ((0.35, -0.25, 0.3), 0.28, (0.1, 0.5, 0.2)),
    ((0.3, 0.35, -0.35), 0.24, (0.15, 0.25, 0.8)),
)


@dataclass(frozen=True)
class Curve:
    """One policy: held-out PSNR and share of active voxels over steps, and where voxels are."""

    name: str
    steps: list[int]
    psnr: list[float]
    share: list[float]
    mask: Array


def truth() -> DenseGrid:
    """Hard balls in 64^3 voxels."""
    c = (np.arange(64) + 0.5) / 32 - 1
    position = np.stack(np.meshgrid(c, c, c, indexing="ij"), -1)
    values = np.zeros((64, 64, 64, 4), np.float32)
    for center, radius, color in BALLS:
        inside = np.linalg.norm(position - center, axis=-1) < radius
        values[inside] = (*color, 60.0)
    policy = MarchPolicy(
        ((-1, -1, -1), (1, 1, 1)), 0.02, density_activation="relu", color_activation="identity"
    )
    return DenseGrid(values, policy)


def capture(size: int = 48) -> Capture:
    """Sixteen training views and five held-out ones."""
    model = Model(truth(), None, FitOptions(), {}, np.zeros((0, 3)))

    def view(name: str, camera: Camera) -> View:
        """One photograph, straight alpha in display values."""
        color, opacity, _ = render_camera(model, camera, stop=0.0)
        straight = np.clip(srgb_encode(unpremultiply(color, opacity)), 0, 1)
        rgba = np.concatenate([straight, opacity[..., None]], -1, dtype=np.float32)
        return View(name, camera, rgba)

    train = [c for e in (35.0, -15.0) for c in orbit_cameras(BOX, 8, size=size, elevation=e)]
    test = orbit_cameras(BOX, 5, size=size, elevation=12.0)
    views = [
        tuple(view(f"{split}_{n}", camera) for n, camera in enumerate(group))
        for split, group in (("train", train), ("test", test))
    ]
    return Capture(*views, "memory", Path("memory"), "display", True, bounds=BOX)


def prune(fit: Fit, *, dilate: bool) -> None:
    """Drop all voxels below the threshold; `refine` dilates by one, which is undone if unwanted."""
    field = fit.model
    assert isinstance(field, SparseSh)
    weight = field.greatest_weights(fit.data.batches(1 << 20))
    if dilate:
        rows = field.refine(0, {"weight": weight, "threshold": np.array(THRESHOLD)})
        assert rows is not None
        fit.optimizer.apply_row_map(rows, field.params)
        return
    mask = np.zeros(field.active.shape, bool)
    i, j, k = field.active.voxels[weight >= THRESHOLD].T
    mask[i, j, k] = True
    after = ActiveVoxels(mask)
    i, j, k = after.voxels.T
    source = field.active.rows[i, j, k]
    density, coefficients = (field.params[name][source] for name in ("density", "sh"))
    fit.model = SparseSh(
        after, density, coefficients, field.policy, background_density=field.background_density
    )
    fit.optimizer.apply_row_map(RowMap(source, len(field.active)), fit.model.params)


def run(name: str, photographs: Capture, policy: str) -> Curve:
    """Fit under one policy: "keep", "prune" or "dilate"."""
    options = FitOptions(
        representation="sparse_sh",
        resolution=RESOLUTION,
        steps=STEPS,
        rays=2048,
        degree=0,
        refine_at=(0.0, 0.0),
        prune=0.0,
        total_variation=0.0,
    )
    fit = Fit.start(photographs, options)
    steps, psnr, share = [], [], []
    while True:
        field = fit.model
        assert isinstance(field, SparseSh)
        if fit.step_number % 10 == 0:
            model = Model(field, None, options, {}, np.zeros((0, 3)))
            steps.append(fit.step_number)
            psnr.append(evaluate(model, photographs.test).psnr)
            share.append(float(field.active.mask.mean()))
        if fit.step_number == STEPS:
            return Curve(name, steps, psnr, share, field.active.mask)
        late = fit.step_number > EARLY and fit.step_number % AGAIN == 0
        if policy != "keep" and fit.step_number == EARLY:
            prune(fit, dilate=policy == "dilate")
        elif policy == "dilate" and late and fit.step_number < 0.8 * STEPS:
            prune(fit, dilate=True)
        fit.step()


def curves() -> list[Curve]:
    """The three policies on the same photographs."""
    photographs = capture()
    return [
        run("every voxel is kept", photographs, "keep"),
        run("pruned too early", photographs, "prune"),
        run("pruned, and dilated again and again", photographs, "dilate"),
    ]


COLORS = (style.BLUE, style.RED, style.ORANGE)


def figure(found: list[Curve]) -> Figure:
    """PSNR and active voxels over the steps, and what exists at the end, seen along Z."""
    kept, early, grown = found
    with style.house_style():
        page = style.new_figure(3 * PANEL + 1.3, 2 * PANEL + 1.5)
        quality = style.place_axes(page, 0.6, 0.35, 2 * PANEL - 0.2, PANEL - 0.1)
        voxels = style.place_axes(page, 2 * PANEL + 1.15, 0.35, PANEL - 0.1, PANEL - 0.1)
        for n, curve in enumerate(found):
            line = "-" if curve is not grown else "--"  # it runs along the first
            quality.plot(curve.steps, curve.psnr, line, label=curve.name, color=COLORS[n])
            voxels.plot(curve.steps, 100 * np.array(curve.share), color=COLORS[n])
            left = 0.2 + n * (PANEL + 0.4)
            seen = style.place_axes(page, left, PANEL + 0.95, PANEL - 0.1, PANEL - 0.1)
            seen.imshow(curve.mask.any(axis=2).T, origin="lower", cmap="Greys", vmin=0, vmax=1.6)
            seen.set_title(curve.name)
            seen.set_xticks([])
            seen.set_yticks([])
        quality.set(xlabel="step", ylabel="held-out PSNR, dB")
        quality.legend(loc="lower right")
        voxels.set(xlabel="step", ylabel="active voxels, %", yscale="log")
        style.write_caption(
            page,
            f"Pruning at step {EARLY} drops what the fit has not found yet, and no gradient can "
            f"bring it back: {early.psnr[-1]:.1f} dB instead of {kept.psnr[-1]:.1f}. Pruning, but "
            f"growing by a voxel every {AGAIN} steps, ends at {grown.psnr[-1]:.1f} dB with "
            f"{100 * grown.share[-1]:.0f} % of the voxels. Second row: those that exist at the "
            "end, seen along Z.",
            left=0.15,
            right=0.15,
        )
    return page


def main() -> None:
    """Write docs/images/sparse_topology.png."""
    found = curves()
    save_figure(figure(found), IMAGES / "sparse_topology.png")


if __name__ == "__main__":
    main()
