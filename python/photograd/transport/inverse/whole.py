"""A recovery from beginning to end, in one call."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from photograd._descend import progress_bar, run_folder
from photograd._typed import typed_call
from photograd.transport.inverse.job import FILE_NAME, InverseRendering
from photograd.transport.inverse.options import RecoveryOptions, RecoveryResult
from photograd.transport.inverse.parameters import Parameter
from photograd.transport.scene import Scene


@typed_call
def recover(
    scene: Scene,
    targets: Any,
    parameters: Sequence[Parameter | str],
    *,
    options: RecoveryOptions | None = None,
    folder: str | Path | None = None,
    resume: bool = False,
    bar: bool = False,
) -> RecoveryResult:
    """Find parameters of a scene from pictures of it, through all bounces of light.

    Minimizes the squared difference of the path traced pictures and the targets with Adam
    [Kingma2015]. A path traced picture is noisy, and the derivative of a squared error is a product
    of two things that both contain that noise: how wrong a pixel is, and what changes it. If both
    come from the same random numbers, the mean of their product is not the product of their means,
    and the search walks to a place where the picture is darker or smoother than the target, not to
    the target. Each step therefore draws two half pictures with independent seeds, and each half's
    derivative is taken of the other half's difference: the gradient is right on average, at any
    number of samples (`dual_buffer_loss`). Inverse path tracing: [Azinovic2019]; the adjoint of a
    path: [Vicini2021].

    Geometry cannot be found: edges of shadows and silhouettes have no derivative here. Neither can
    parameters whose derivative is incomplete (`PathTracer.incomplete`): a search would walk away
    from the truth. For eta of smooth glass, take the rough model, `rough_dielectric`.

    Args:
        scene: all that is known; `parameters` begin at its values unless they have a start.
        targets: (H, W, 3) linear radiance as the scene's camera sees it, or `Target`s with cameras
            of their own, or several of either.
        parameters: names among `PathTracer.params`, or `Parameter`s with a start, bounds and rate.
        options: steps, samples, rates, seed.
        folder: for the checkpoint, DIR/recovery.npz, written every 30 s and at the end.
        resume: go on from the checkpoint in `folder`, to the same bits as without interruption.
        bar: show progress on stderr.

    Returns:
        Values, the scene with them, losses and curves.

    Raises:
        RangeError: parameters that the scene does not have or whose derivative is incomplete,
            starts out of bounds, a checkpoint of another recovery, a folder that holds one already
            without `resume`.
        ShapeError: pictures that their cameras do not take.
        IoError: a checkpoint that cannot be written, or is not there to resume from.
        Error: a loss or derivative that is not finite.

    Example:
        >>> room = photograd.builtin_scene("cornell-box", 8)
        >>> truth = photograd.PathTracer(room)
        >>> truth.params["materials.red.albedo"][:] = 0.5
        >>> photograph = truth.render(spp=64, seed=0).mean
        >>> options = photograd.RecoveryOptions(steps=10, spp=2)
        >>> found = photograd.recover(room, photograph, ["materials.red.albedo"], options=options)
        >>> step, loss, rate = found.history.T
        >>> found.params["materials.red.albedo"].shape
        (3,)
    """
    into = None if folder is None else Path(folder)
    with run_folder("recover", into, FILE_NAME, resume=resume):
        job = InverseRendering(scene, targets, parameters, options)
        if resume and into is not None:
            job.load(into)
        with progress_bar("recover", job, shown=bar) as on_step:
            return job.run(into, on_step=on_step)
