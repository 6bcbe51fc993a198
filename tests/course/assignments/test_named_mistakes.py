"""Likely mistakes are named by public checks: by what the numbers show, or by a known answer.

A student meets these before handing in; what names them may stand in the text or in the hint.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from photograd_course.grading.outcome import Outcome, Status

from course.assignments.kept import verdict_on
from course.assignments.support import ASSIGNMENTS, apply_mutant, bundle_of, source

FOLDERS = {"06": "06_real_time_frame", "12": "12_nerf", "13": "13_hash_grids"}
FOLDERS["14"] = "14_edges_and_light"
SIGN = "All of yours are -1 times what is expected (your sign is reversed)"


@dataclass(frozen=True)
class Mistake:
    """A wrong solution.

    Attributes:
        check: the public check that names it.
        said: what stands in its text or its hint.
        mutant: a known mistake of the assignment; or
        change: pairs of an old text of the solution and a new one.
    """

    check: str
    said: str
    mutant: str = ""
    change: tuple[tuple[str, str], ...] = ()

    @property
    def text(self) -> str:
        """The wrong solution."""
        folder = ASSIGNMENTS / FOLDERS[self.check[:2]]
        if self.mutant:
            return apply_mutant(folder, self.mutant)
        text = source(folder)
        for old, new in self.change:
            assert text.count(old) == 1, old
            text = text.replace(old, new)
        return text


RESIDUAL = "return float(np.sum(residual**2) / len(t)), "
MISTAKES = {
    # 12: a network
    "pi missing": Mistake("12.1.values", "lack the factor pi", "encoding_degrees"),
    "columns interleaved": Mistake(
        "12.1.values", "all sines come first, then all cosines", "encoding_coordinates_together"
    ),
    "sign of the cosine's derivative": Mistake(
        "12.1.derivatives", "minus the sine", "encoding_derivative_sign"
    ),
    "bias averaged": Mistake("12.2.differences", "summed over rows", "backward_bias_mean"),
    "W not transposed where it is square": Mistake(
        "12.2.differences", "not by its transpose", "backward_untransposed_squares"
    ),
    "mask of the layer below": Mistake(
        "12.2.differences", "of the layer below", "backward_relu_of_layer_below"
    ),
    "activations overwritten": Mistake(
        "12.2.differences", "changes its second argument", "backward_activations_overwritten"
    ),
    "searchsorted left": Mistake("12.3.known", "side 'right'", "distances_searched_left"),
    "parts of n - 1": Mistake("12.3.strata", "divide by n - 1", "distances_parts_of_n_minus_1"),
    "distances not sorted": Mistake("12.6.first", "are not sorted", "train_unsorted"),
    "softplus without its derivative": Mistake(
        "12.5.differences", "softplus is missing", "loss_density_not_through_softplus"
    ),
    "mean over channels": Mistake("12.5.fog", "divide by a further 3", "loss_mean_of_channels"),
    "mean over channels, of the loss alone": Mistake(
        "12.5.differences",
        "Yours is 3 times",
        change=((RESIDUAL, RESIDUAL.replace(")), ", ") / 3), ")),),
    ),
    "half of the loss": Mistake("12.5.differences", "half of equation (17)", "loss_halved"),
    "float32": Mistake(
        "12.1.values",
        "got dtype float32",
        change=(
            (
                "features, derivatives = [x], [np.ones_like(x)]",
                "x = x.astype(np.float32)\n    features, derivatives = [x], [np.ones_like(x)]",
            ),
            ("omega = 2**k * np.pi", "omega = np.float32(2**k * np.pi)"),
        ),
    ),
    "a new Adam in each step": Mistake("12.6.first", "a new Adam", "train_new_adam_each_step"),
    # 13: hash grids
    "+= where rows repeat": Mistake(
        "13.4.table", "gets only its last contribution", "backward_last_point_counts"
    ),
    "n missing": Mistake("13.4.points", "The factor n is missing", "backward_points_unscaled"),
    "y fastest": Mistake("13.2.dense", "x should", "hash_dense_z_fastest"),
    "+ for exclusive or": Mistake("13.2.hashed", "exclusive or", "hash_added"),
    "k from 0": Mistake(
        "13.6.steps",
        "not finite",
        change=(("d_table, m, v, k + 1, rate)", "d_table, m, v, k, rate)"),),
    ),
    "Adam in place": Mistake("13.5.untouched", "has changed the array v", "adam_in_place"),
    "derivative after the step": Mistake(
        "13.6.steps", "take both before", "train_one_after_another"
    ),
    # 06: a frame
    "affine weights": Mistake(
        "06.1.perspective", "divide each by the depth of its corner", "raster_affine_weights"
    ),
    "sign of the bias": Mistake("06.2.bias", "out of the surface", "shadow_bias_sign"),
    "pose not transposed": Mistake("06.3.sun", "turned the wrong way", "light_sun_transposed"),
    "straight alpha": Mistake("06.3.rest", "has straight alpha", "light_alpha_straight"),
    "ln 2 missing": Mistake("06.5.differences", "1/(ln 2) times", "tone_adjoint_ln2"),
    "half a pixel of u": Mistake("06.6.step", "u is the left edge", "occlusion_u_of_edge"),
    # 14: edges and light
    "perimeter missing": Mistake("14.2.point", "The perimeter is missing", "edges_no_length"),
    "one edge of the stroke": Mistake("14.3.straight", "one of the two edges", "stroke_one_edge"),
    "normal inward": Mistake("14.2.point", SIGN, "edges_normal_inward"),
    "throughput twice": Mistake("14.4.differences", "once more", "replay_beta_twice"),
    "own residual": Mistake("14.5.differences", "must meet the other's", "loss_own_residual"),
    "M missing": Mistake("14.6.flat", "a factor of the number of cells", "lens_no_spacing"),
}


def outcomes_of(mistake: Mistake) -> dict[str, Outcome]:
    """Of the public checks of its task."""
    folder = ASSIGNMENTS / FOLDERS[mistake.check[:2]]
    bundle, task = bundle_of(folder), mistake.check.rpartition(".")[0]
    checks = [c for c in bundle.checks if c.visibility == "public" and c.task == task]
    with np.errstate(all="ignore"):
        outcomes, _ = verdict_on(mistake.text, folder, bundle, checks)
    return {each.id: each for each in outcomes}


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_is_named_before_handing_in(name: str) -> None:
    mistake = MISTAKES[name]
    told = outcomes_of(mistake)[mistake.check]
    assert told.status is Status.FAILED
    assert mistake.said in f"{told.text} | {told.hint}", (told.text, told.hint)


def test_no_hint_leads_away() -> None:
    """What the cases above must not be told."""
    unsaid = {
        "mean over channels, of the loss alone": ("half of equation",),
        "k from 0": ("has changed", "written", "hint"),
        "normal inward": ("row by y", "both colors", "shared between", "density", "points out"),
        "columns interleaved": ("not one half turn more",),
    }
    for name, words in unsaid.items():
        for told in outcomes_of(MISTAKES[name]).values():
            assert not [w for w in words if w in told.hint], (name, told.id, told.hint)


def test_of_values_that_are_not_finite_no_hint_is_given() -> None:
    for told in outcomes_of(MISTAKES["k from 0"]).values():
        if "not finite" in told.text:
            assert told.hint == ""
