"""The loop of a recovery: draw two half pictures, compare, step downhill.

    a, b         = pictures of the scene as it is now, seeds by (seed, step, view, half)
    loss         = mean w (a - t) (b - t)
    gradient     = its derivative with respect to x, through the picture and the activation
    x           -= Adam step

Every random number is a function of (seed, step), and everything else that a step depends on is in
the checkpoint: a resumed run ends with the same bits as an uninterrupted one.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.optim import Adam
from photograd_course.random import choice, random_words
from photograd_course.schedules import exponential

from photograd._checkpoint import (
    Checkpoint,
    check_arrays,
    check_history,
    check_optimizer,
    checked_step,
    load_checkpoint,
    save_checkpoint,
)
from photograd._checks import require_instance
from photograd._descend import Progress, Run, changing, descend
from photograd._typed import typed_call
from photograd.errors import DtypeError, Error, IoError, RangeError, message
from photograd.transport.inverse.loss import checked_targets, loss_and_gradients, loss_weights
from photograd.transport.inverse.options import RecoveryOptions, RecoveryResult
from photograd.transport.inverse.parameters import Parameter, is_light, scene_with
from photograd.transport.scene import Scene
from photograd.transport.scene_digest import scene_digest
from photograd.transport.tracer import PathTracer
from photograd.types import Array

FEW = 16  # numbers of a parameter whose curves are kept one by one
MEMORY = 0.9
"""Adam's beta_2. A color that walks from 0.5 to 0.05 loses a factor of 200 in its slope with
respect to x; with 0.999 the first slopes would be remembered, and steps be short, long
after the end."""
SMOOTH = 10  # steps over which the shown loss is averaged


@typed_call
class InverseRendering:
    """Inverse rendering in progress.

    Attributes:
        scene: as it was given.
        targets: the pictures, each with a camera.
        parameters: what is looked for, by name.
        options: how.
        x: {name: numbers before the activation}, float64.
        step_number: steps done.
        history: (step, loss, learning rate) of each.
        curves: {name: [value, or means of its channels]}, one more than steps.
    """

    def __init__(
        self,
        scene: Scene,
        targets: Any,
        parameters: Sequence[Parameter | str],
        options: RecoveryOptions | None = None,
    ) -> None:
        """Check everything, and begin at the parameters' starts.

        Args:
            scene: with a first guess.
            targets: pictures (H, W, 3) in linear radiance, or `Target`s.
            parameters: names, or `Parameter`s.
            options: steps, samples, rates, seed; None takes the defaults.

        Raises:
            DtypeError: no `Scene`, no sequence of parameters, or no `RecoveryOptions`.
            RangeError: no parameter, one twice, one that the scene does not have or whose
                derivative is incomplete, or out of bounds.
            ShapeError: no picture, or one that its camera does not take.
        """
        require_instance("recover", "scene", scene, Scene, "read_scene reads a file")
        if isinstance(parameters, str | Parameter):
            got, remedy = repr(parameters), "put it into a list"
            raise DtypeError(message("recover", "parameters", "a sequence", got, remedy))
        self.scene = scene
        self.options = RecoveryOptions() if options is None else options
        require_instance("recover", "options", self.options, RecoveryOptions)
        self.targets = checked_targets(targets, scene)
        self._weights = [loss_weights(target, self.options.loss) for target in self.targets]
        given = [Parameter(each) if isinstance(each, str) else each for each in parameters]
        self.parameters = {each.name: each for each in given}
        if not given or len(self.parameters) < len(given):
            got = "none" if not given else "one twice"
            raise RangeError(message("recover", "parameters", "names of parameters", got))
        if self.options.views > len(self.targets):
            expected = f"at most the {len(self.targets)} pictures"
            raise RangeError(message("recover", "views", expected, self.options.views))
        tracer = PathTracer(scene)
        starts = {name: each.start_in(tracer) for name, each in self.parameters.items()}
        self._activations = {n: each.activation_in(scene) for n, each in self.parameters.items()}
        self.x = {n: self._activations[n].inverse(value) for n, value in starts.items()}
        self.optimizer = Adam(beta_2=MEMORY)
        self._rate = exponential(self.options.final_rate, self.options.steps)
        self.step_number = 0
        self.changing = False
        self.history: list[tuple[float, float, float]] = []
        self.curves = {name: [_summary(value)] for name, value in self.values().items()}
        self._sampled = self.values()
        self._tracer = PathTracer(scene_with(scene, self._sampled))

    def values(self) -> dict[str, Array]:
        """The parameters as they are now, float64."""
        return {name: self._activations[name].value(x) for name, x in self.x.items()}

    def tracer(self) -> PathTracer:
        """A tracer with the parameters as they are now."""
        for name, value in self.values().items():
            self._tracer.params[name] = np.array(value, self._tracer.dtype, order="C")
        return self._tracer

    def loss_and_gradients(self, step: int) -> tuple[float, dict[str, Array]]:
        """The loss with the random numbers of a step, and its gradient."""
        tracer, chosen = self.tracer(), self._chosen(step)
        loss, total = 0.0, {name: np.zeros_like(x) for name, x in self.x.items()}
        for view in chosen:
            target = self.targets[view]
            part, gradients = loss_and_gradients(
                tracer,
                target.image,
                self._weights[view],
                spp=self.options.spp,
                seeds=self.seeds(step, view),
                camera=target.camera,
                options=self.options.path,
                names=self.x,
            )
            loss += part / len(chosen)
            for name, gradient in gradients.items():
                total[name] += gradient / len(chosen)
        return loss, total

    @property
    def steps(self) -> int:
        """Of the whole descent."""
        return self.options.steps

    def step(self) -> float:
        """One step of gradient descent; returns the loss before it.

        Raises:
            Error: a loss or a derivative that is not finite; nothing was changed.
        """
        step = self.step_number
        if step and step % self.options.resample_every == 0 and any(map(is_light, self.x)):
            self._sampled = self.values()
            self._tracer = PathTracer(scene_with(self.scene, self._sampled))
        loss, d_values = self.loss_and_gradients(step)
        finite = all(np.isfinite(d_value).all() for d_value in d_values.values())
        if not (np.isfinite(loss) and finite):
            got = f"others at step {step}"
            remedy = "lower the learning rate"
            raise Error(message("InverseRendering.step", "loss", "finite numbers", got, remedy))
        gradients = {
            name: np.asarray(self._activations[name].value_backward(self.x[name], d_value))
            for name, d_value in d_values.items()
        }
        rate = self.options.learning_rate * self._rate(step)
        rates = {name: rate * each.rate for name, each in self.parameters.items()}
        with changing(self):
            self.optimizer.step(self.x, gradients, rates)
            self.history.append((step, loss, rate))
            for name, value in self.values().items():
                self.curves[name].append(_summary(value))
            self.step_number += 1
        return loss

    def run(
        self,
        folder: Path | None = None,
        *,
        on_step: Callable[[Progress], None] | None = None,
        should_stop: Callable[[], bool] = lambda: False,
        checkpoint_seconds: float = 30.0,
    ) -> RecoveryResult:
        """Step until the end or until `should_stop`; the folder then holds the checkpoint.

        Args:
            folder: for the checkpoint; None keeps nothing on disk.
            on_step: called after each step.
            should_stop: asked after each step; True saves and ends the run.
            checkpoint_seconds: between two checkpoints.

        Raises:
            IoError: the checkpoint cannot be written.
            Error: as `step`.
        """

        def after_step(now: float) -> None:
            del now
            if on_step:
                recent = [loss for _, loss, _ in self.history[-SMOOTH:]]
                on_step(Progress(self.step_number, self.options.steps, float(np.mean(recent))))

        def result(run: Run) -> RecoveryResult:
            return self.result(run.seconds)

        return descend(
            self,
            folder,
            result,
            after_step=after_step,
            should_stop=should_stop,
            checkpoint_seconds=checkpoint_seconds,
        )

    def result(self, seconds: float = 0.0) -> RecoveryResult:
        """What has been found so far.

        Args:
            seconds: of the last run.
        """
        params = self.values()
        return RecoveryResult(
            params,
            scene_with(self.scene, params),
            np.array(self.history).reshape(-1, 3),
            {name: np.array(rows) for name, rows in self.curves.items()},
            self.step_number,
            self.step_number >= self.options.steps,
            seconds,
        )

    def save(self, folder: Path) -> Path:
        """Write the checkpoint DIR/recovery.npz atomically; IoError if that fails.

        Args:
            folder: DIR, which exists.
        """
        return save_state(folder, self, self._sampled)

    def load(self, folder: Path) -> None:
        """Go on where the checkpoint in `folder` ends.

        Raises:
            IoError: a missing or damaged checkpoint.
            RangeError: one of another scene, other pictures, parameters or options.
        """
        self._sampled = load_state(folder, self)
        self._tracer = PathTracer(scene_with(self.scene, self._sampled))

    def _chosen(self, step: int) -> list[int]:
        count = self.options.views
        if count in (0, len(self.targets)):
            return list(range(len(self.targets)))
        return [int(k) for k in choice(self.options.seed, len(self.targets), count, step=step)]

    def seeds(self, step: int, view: int) -> tuple[int, int]:
        """64 random bits for each half: they share nothing, with each other or other steps.

        Args:
            step: of the descent.
            view: number of the target.
        """
        buffer, words = np.arange(2)[:, None], np.arange(2)[None, :]
        drawn = random_words(
            self.options.seed, step=step, pixel=view, sample=buffer, dimension=words
        ).astype(np.uint64)
        one, two = (int(low) | int(high) << 32 for low, high in drawn)
        return one, two


def _summary(value: Array) -> Array:
    """What is kept of a value for its curve."""
    if value.size <= FEW:
        return np.array(value, np.float64).reshape(-1)
    return np.asarray(value.reshape(-1, value.shape[-1]).mean(axis=0))


# A recovery on disk: what it needs to go on, and what shows that it is the same one.


FILE_NAME = "recovery.npz"


def save_state(folder: Path, job: InverseRendering, sampled: dict[str, Array]) -> Path:
    """Write DIR/recovery.npz; `sampled` are the values that the tracer was built with.

    Args:
        folder: DIR, which exists.
        job: at any step.
        sampled: {name: value} by which lights are sampled.
    """
    state = {f"sampled.{name}": value for name, value in sampled.items()}
    state |= {f"curves.{name}": np.array(rows) for name, rows in job.curves.items()}
    meta = {"step": job.step_number, **fingerprint(job)}
    history = np.array(job.history, np.float64).reshape(-1, 3)
    return save_checkpoint(
        folder / FILE_NAME, Checkpoint(meta, dict(job.x), job.optimizer.state(), state, history)
    )


def load_state(folder: Path, job: InverseRendering) -> dict[str, Array]:
    """Bring a job to where its checkpoint ends; the values that its tracer was built with.

    Args:
        folder: of the checkpoint.
        job: that was just begun.

    Raises:
        IoError: a missing or damaged checkpoint.
        RangeError: one of another recovery.
    """
    path = folder / FILE_NAME
    if not path.is_file():
        expected = f"a recovery ({FILE_NAME})"
        raise IoError(message("recover", "folder", expected, f"none in {folder}"))
    saved = load_checkpoint(path)
    _require_same(fingerprint(job), saved.meta)
    try:
        job.step_number = _checked_step(saved, job)
    except Error as failure:
        expected = "a checkpoint of a recovery"
        raise IoError(message("recover", f"{path}", expected, failure)) from failure
    job.x = {name: saved.params[name] for name in job.x}
    sampled = {name: saved.state[f"sampled.{name}"] for name in job.x}
    job.curves = {name: list(saved.state[f"curves.{name}"]) for name in job.x}
    job.optimizer.load_state(saved.optimizer)
    job.history = [(float(a), float(b), float(c)) for a, b, c in saved.history]
    return sampled


def _checked_step(saved: Checkpoint, job: InverseRendering) -> int:
    """Steps done. Raises Error unless the arrays are those of a recovery of the same parameters."""
    step = checked_step(saved)
    kinds, state = ("float64",), {}
    for name, x in job.x.items():
        state[f"sampled.{name}"] = (kinds, x.shape)
        state[f"curves.{name}"] = (kinds, (step + 1, *job.curves[name][0].shape))
    check_arrays("params", saved.params, {name: (kinds, x.shape) for name, x in job.x.items()}, {})
    check_arrays("state", saved.state, state, {})
    check_optimizer(saved.optimizer, saved.params)
    check_history(saved.history, step)
    return step


def _require_same(own: dict[str, Any], saved: dict[str, Any]) -> None:
    """Raise RangeError that says in what a checkpoint is of another recovery."""
    remedy = "resume with what it was started with, or choose another folder"
    for name, value in own.items():
        other = saved.get(name)
        if other == value:
            continue
        got = f"other {name}"
        if isinstance(other, dict) and isinstance(value, dict):
            differing = [key for key in value if other.get(key) != value[key]]
            got = f"another {', '.join(differing)}"
        expected = f"the {name} of the checkpoint"
        raise RangeError(message("recover", name, expected, got, remedy))


def fingerprint(job: InverseRendering) -> dict[str, Any]:
    """The options, and short texts that change with the scene, the pictures and the parameters.

    Args:
        job: at any step.
    """
    pictures = hashlib.sha256()
    for target in job.targets:
        camera = target.camera
        assert camera is not None
        pictures.update(target.image.tobytes())
        pictures.update(b"" if target.weight is None else target.weight.tobytes())
        pictures.update(repr((camera.fx, camera.fy, camera.cx, camera.cy)).encode())
        pictures.update(camera.world_from_camera.tobytes())
    parameters = hashlib.sha256()
    for each in job.parameters.values():
        start = "" if each.start is None else np.asarray(each.start, np.float64).tobytes().hex()
        told = (each.name, start, each.bounds, each.activation, each.rate)
        parameters.update(repr(told).encode())
    texts = {
        "scene": scene_digest(job.scene, without=("name", "camera")),  # targets have their own
        "targets": pictures.hexdigest(),
        "parameters": parameters.hexdigest(),
    }
    return {**{name: text[:16] for name, text in texts.items()}, "options": asdict(job.options)}
