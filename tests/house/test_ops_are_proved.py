"""Every adjoint of `ops/` and `splat/` is in `Ops`, and so proved."""

from __future__ import annotations

import re

import pytest

from support.op_proofs import unproved
from support.tree import ROOT

# Stages of the rasterizer, which tests/splat proves as a whole.
STAGES = {"project.h", "tile_blend.h"}
FOLDERS = ("cpp/photograd/ops", "cpp/photograd/splat", "cpp/bindings/op_adapters")
TEXTS = {
    path.name: path.read_text()
    for folder in FOLDERS
    for path in sorted((ROOT / folder).glob("*.h"))
    if path.name not in STAGES
}


def test_every_adjoint_is_reached_from_a_registered_op() -> None:
    assert unproved(TEXTS) == []


@pytest.mark.parametrize(
    ("adapter", "lost"),
    [
        ("RefractOp", ["refract_backward"]),
        ("Gtr1Op", ["gtr1_D_backward"]),
        ("ConductorOp", ["fresnel_conductor_backward", "quotient_backward"]),
    ],
)
def test_an_op_that_is_left_out_of_the_list_is_seen(adapter: str, lost: list[str]) -> None:
    list_text = re.sub(rf"\b{adapter}\b,", "", TEXTS["op_list.h"])
    assert set(lost) <= set(unproved({**TEXTS, "op_list.h": list_text}))
