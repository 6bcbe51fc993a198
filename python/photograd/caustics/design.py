"""A lens whose caustic is a picture: heights by descent through refraction.

    h        = start + s (I + smoothness L)^-1 u                s: spacing of the vertices
    rays     = light through a grid of cells of the front, at places that are new in each step
    power    = what lands on each cell of the receiver (receiver.py), behind all lenses (chains.py)
    loss     = pyramid loss of the power against the target + power beyond the receiver
    u       -= Adam step on dL/du = s (I + smoothness L)^-1 dL/dh

The derivative is attached: where light lands moves with the heights [NimierDavid2019]. The start is
the lens of optimal transport [Schwartzburg2014], or a plane. The solve makes smooth steps: a slope
that is wanted at one vertex moves its surroundings along [Nicolet2021].

The target is scaled to the power that the lenses transmit at the start, so that a picture is
reached by moving light and not by losing it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.optim import Adam
from photograd_course.schedules import exponential

from photograd._arrays import Arguments
from photograd._checks import require_instance
from photograd._descend import Progress, Run, changing, descend
from photograd._typed import typed_call
from photograd.caustics.chains import trace_chains_backward
from photograd.caustics.lens import Lens
from photograd.caustics.light import Light, check_light
from photograd.caustics.loss import PyramidLoss
from photograd.caustics.measure import Caustic, correlation, measure, trace_lenses
from photograd.caustics.options import CausticOptions
from photograd.caustics.receiver import land_backward, outside, outside_backward, splat_backward
from photograd.caustics.smoothing import CosineBasis
from photograd.caustics.start import transport_lens
from photograd.caustics.state import digest, load_design, save_design
from photograd.errors import Error, RangeError, message
from photograd.transport.particles import IrradianceSensor
from photograd.types import Array, FloatArray

DARK = 1e-290
"""Pictures that sum up to less have no light: scaled to a power, their numbers would overflow."""
BEYOND = 8.0
"""Loss of all power one cell beyond the receiver."""
MEASURED = 8
"""Rays a cell along each axis, for what a result reports."""
MEMORY = 0.95
"""Adam's beta_2."""


@typed_call
@dataclass(frozen=True, eq=False)
class CausticResult:
    """What was found.

    Attributes:
        lenses: with their heights.
        caustic: by rays that the descent did not see.
        target: (H, W) W/m^2, scaled to the transmitted power.
        correlation: of the irradiance with the target.
        history: (steps, 3) step, loss, learning rate.
        finished: whether all steps were done.
        seconds: of the last run.
    """

    lenses: tuple[Lens, ...]
    caustic: Caustic
    target: FloatArray
    correlation: float
    history: FloatArray
    finished: bool
    seconds: float


@typed_call
class CausticDesign:
    """A design in progress.

    Attributes:
        lenses: at the start.
        options: how.
        x: {"heights.INDEX": u} of each lens, float64.
        step_number: steps done.
        history: (step, loss, learning rate) of each.
    """

    def __init__(
        self,
        lenses: Lens | Sequence[Lens],
        light: Light,
        receiver: IrradianceSensor,
        target: Array,
        options: CausticOptions | None = None,
    ) -> None:
        """Check everything, and make the start.

        Args:
            lenses: one or several; light enters through the front of the first. "transport" starts
                with the last one, as if those before it were plane.
            light: a `DirectionalLight` or a `PointLight`.
            receiver: where the picture is formed.
            target: (H, W) or (H, W, C) of the receiver's size, row 0 on top as on the sensor, in
                any unit; of several channels the mean counts.
            options: steps, rates, seed.

        Raises:
            DtypeError: other lights, or no lens.
            ShapeError: a target of another size than the receiver.
            RangeError: a target that is negative, not finite or without light; a light that does
                not light the front; heights that come down to it.
            Error: lenses that trap all light by total reflection, or send none to the receiver.
        """
        name = "CausticDesign"
        self.options = CausticOptions() if options is None else options
        require_instance(name, "options", self.options, CausticOptions)
        require_instance(name, "receiver", receiver, IrradianceSensor)
        self.lenses = [lenses] if isinstance(lenses, Lens) else list(lenses)
        for i, lens in enumerate(self.lenses):
            require_instance(name, f"lenses[{i}]", lens, Lens)
        if not self.lenses:
            raise RangeError(message(name, "lenses", "at least one", "none"))
        check_light(name, light, self.lenses[0])
        self._light, self._receiver = light, receiver
        size = (receiver.height, receiver.width)
        picture = Arguments(name, np.float64).array("target", target, size, (*size, "C"), low=0.0)
        picture = picture if picture.ndim == 2 else picture.mean(axis=2)
        if not float(picture.sum()) > DARK:
            expected, got = "a picture with light", f"one that sums up to {picture.sum():.3g}"
            raise RangeError(message(name, "target", expected, got))
        if self.options.start == "transport":
            self.lenses[-1] = transport_lens(self.lenses[-1], light, receiver, picture)
        found = measure(self.lenses, light, receiver, seed=self.options.seed, rays=2)
        _require_light(found)
        self._power = picture * (found.transmitted / float(picture.sum()))
        self._loss = PyramidLoss(self._power)
        self._bases = [CosineBasis(*lens.heights.shape) for lens in self.lenses]
        self.x = {f"heights.{i}": np.zeros(lens.heights.shape) for i, lens in self._numbered()}
        self.optimizer = Adam(beta_2=MEMORY)
        self._rate = exponential(self.options.final_rate, self.options.steps)
        self.step_number = 0
        self.changing = False
        self.history: list[tuple[float, float, float]] = []

    def _numbered(self) -> list[tuple[int, Lens]]:
        return list(enumerate(self.lenses))

    @property
    def steps(self) -> int:
        """Of the whole descent."""
        return self.options.steps

    @property
    def target(self) -> FloatArray:
        """(H, W) W/m^2 that the receiver should get."""
        return np.asarray(self._power / self._receiver.cell_area)

    def lenses_now(self) -> tuple[Lens, ...]:
        """The lenses with their present heights."""
        smoothness = self.options.rates[1]
        return tuple(
            replace(
                lens,
                heights=lens.heights
                + min(lens.spacing) * basis.smooth(self.x[f"heights.{i}"], smoothness),
            )
            for (i, lens), basis in zip(self._numbered(), self._bases, strict=True)
        )

    def loss_and_gradients(self, step: int) -> tuple[float, dict[str, FloatArray]]:
        """The loss with the rays of a step, and dL/dx of each lens.

        Args:
            step: which rays.
        """
        lenses, receiver = self.lenses_now(), self._receiver
        found = trace_lenses(
            lenses, self._light, receiver, self.options.rays, self.options.seed, step
        )
        beyond = BEYOND / float(self._power.sum())
        loss = self._loss.loss(found.cells)
        loss += beyond * outside(receiver, found.landing, found.power)
        d_cells = self._loss.loss_backward(found.cells)
        one = splat_backward(receiver, found.landing, found.power, d_cells)
        two = outside_backward(receiver, found.landing, found.power, beyond)
        d_x, d_y, d_power = (a + b for a, b in zip(one, two, strict=True))
        chains = found.chains
        d_origin, d_direction = land_backward(receiver, chains.origin, chains.direction, d_x, d_y)
        d_factor = d_power * found.rays.power
        surfaces = trace_chains_backward(found.scene, chains, d_origin, d_direction, d_factor)
        gradients = {}
        for (i, start), lens, basis in zip(self._numbered(), lenses, self._bases, strict=True):
            d_heights = lens.heights_backward(surfaces[3 * i : 3 * i + 3])
            smoothed = basis.smooth(d_heights, self.options.rates[1])
            gradients[f"heights.{i}"] = min(start.spacing) * smoothed
        return loss, gradients

    def step(self) -> float:
        """One step of gradient descent; returns the loss before it.

        Raises:
            Error: a loss or a derivative that is not finite; nothing was changed.
            RangeError: heights that come down to the front.
        """
        loss, gradients = self.loss_and_gradients(self.step_number)
        finite = all(np.isfinite(g).all() for g in gradients.values())
        if not (np.isfinite(loss) and finite):
            got = f"others at step {self.step_number}"
            remedy = "lower the learning rate"
            raise Error(message("CausticDesign.step", "loss", "finite numbers", got, remedy))
        rate = self.options.rates[0] * self._rate(self.step_number)
        with changing(self):
            self.optimizer.step(self.x, gradients, rate)
            self.history.append((self.step_number, loss, rate))
            self.step_number += 1
        return loss

    def run(
        self,
        folder: Path | None = None,
        *,
        on_step: Callable[[Progress], None] | None = None,
        should_stop: Callable[[], bool] = lambda: False,
    ) -> CausticResult:
        """Step until the end or until `should_stop`; the folder then holds the checkpoint.

        Args:
            folder: for the checkpoint; None keeps nothing on disk.
            on_step: called after each step.
            should_stop: asked before each step.

        Raises:
            IoError: the checkpoint cannot be written.
            Error, RangeError: as `step`.
        """

        def after_step(now: float) -> None:
            del now
            if on_step:
                on_step(Progress(self.step_number, self.steps, self.history[-1][1]))

        return descend(self, folder, self.result, after_step=after_step, should_stop=should_stop)

    def result(self, run: Run) -> CausticResult:
        """The lenses as they are now, and the light that they send, measured with other rays.

        Args:
            run: that has led to them.
        """
        lenses = self.lenses_now()
        seed = self.options.seed + 1
        found = measure(lenses, self._light, self._receiver, seed=seed, rays=MEASURED)
        history = np.array(self.history).reshape(-1, 3)
        likeness = correlation(found.irradiance, self.target)
        return CausticResult(
            lenses, found, self.target, likeness, history, run.finished, run.seconds
        )

    def save(self, folder: Path) -> Path:
        """Write the checkpoint atomically.

        Args:
            folder: which exists.
        """
        return save_design(folder, self._identity(), self.x, self.optimizer, self.history)

    def load(self, folder: Path) -> None:
        """Go on where the checkpoint in `folder` ends.

        Args:
            folder: of the checkpoint.

        Raises:
            IoError: a missing or damaged checkpoint.
            RangeError: one of another design.
        """
        self.history = load_design(folder, self._identity(), self.x, self.optimizer)
        self.step_number = len(self.history)

    def _identity(self) -> dict[str, Any]:
        arrays = [self.target, *(lens.back() for lens in self.lenses)]
        arrays.append(np.array([lens.eta for lens in self.lenses]))
        return {"options": asdict(self.options), "design": digest(arrays)}


def _require_light(found: Caustic) -> None:
    """Raise Error where no light passes, or none arrives."""
    name = "CausticDesign"
    if not found.transmitted > 0:
        remedy = "gentler slopes or a smaller eta"
        got = "total reflection of all light"
        raise Error(message(name, "lenses", "lenses that let light pass", got, remedy))
    if not found.received > 0:
        remedy = "move the receiver, or start from transport"
        raise Error(message(name, "receiver", "light on it at the start", "none", remedy))


@typed_call
def design_caustic(
    lenses: Lens | Sequence[Lens],
    light: Light,
    receiver: IrradianceSensor,
    target: Array,
    options: CausticOptions | None = None,
) -> CausticResult:
    """Find heights of lenses whose caustic on a receiver is a picture.

    Args:
        lenses, light, receiver, target, options: as of `CausticDesign`.

    Raises:
        DtypeError, ShapeError, RangeError, Error: as `CausticDesign` and its `step`.
    """
    return CausticDesign(lenses, light, receiver, target, options).run()
