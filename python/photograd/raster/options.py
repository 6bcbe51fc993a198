"""What a fragment has to pass to be seen: face, depth and stencil tests."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, get_args

from photograd._arrays import Arguments
from photograd._checks import require_choices, require_types
from photograd._typed import typed_call
from photograd.errors import RangeError, message

Compare = Literal[
    "never", "less", "equal", "less_equal", "greater", "not_equal", "greater_equal", "always"
]
"""Of the new value with the stored one: "less" passes where new < stored."""

StencilOp = Literal[
    "keep",
    "zero",
    "replace",
    "increment_clamp",
    "decrement_clamp",
    "invert",
    "increment_wrap",
    "decrement_wrap",
]

Cull = Literal["none", "back", "front"]

COMPARES, STENCIL_OPS, CULLS = get_args(Compare), get_args(StencilOp), get_args(Cull)


@typed_call
@dataclass(frozen=True)
class Stencil:
    """The stencil test, and what becomes of the stored 8 bits.

    Attributes:
        compare: of reference & read_mask with stored & read_mask.
        reference, read_mask, write_mask: 0 to 255; `write_mask` has the bits that may change.
        on_fail, on_depth_fail, on_pass: what is stored where this test fails, where it passes and
            the depth test fails, and where both pass.

    Raises:
        DtypeError, RangeError: another name, or a number that has not 8 bits.
    """

    compare: Compare = "always"
    reference: int = 0
    read_mask: int = 255
    write_mask: int = 255
    on_fail: StencilOp = "keep"
    on_depth_fail: StencilOp = "keep"
    on_pass: StencilOp = "keep"

    def __post_init__(self) -> None:
        require_types(self)
        require_choices(self)
        call = Arguments("Stencil")
        for name in ("reference", "read_mask", "write_mask"):
            call.integer(name, getattr(self, name), low=0, high=255)

    def numbers(self) -> tuple[int, ...]:
        """The seven numbers that the core takes."""
        operations = (self.on_fail, self.on_depth_fail, self.on_pass)
        return (
            COMPARES.index(self.compare),
            self.reference,
            self.read_mask,
            self.write_mask,
            *(STENCIL_OPS.index(operation) for operation in operations),
        )


@typed_call
@dataclass(frozen=True)
class RasterOptions:
    """How triangles are drawn.

    Attributes:
        near, far: meters along the camera's axis; nothing nearer or farther is seen. A triangle
            that crosses the near plane is cut there.
        cull: faces that are left out: "back" those whose corners run clockwise as the camera sees
            them.
        depth_test: of a fragment's depth with that of the buffer.
        depth_write: whether a fragment that is seen leaves its depth.
        stencil: None draws without a stencil buffer.

    Raises:
        DtypeError, RangeError: a value without meaning.
    """

    near: float = 1e-3
    far: float = float("inf")
    cull: Cull = "none"
    depth_test: Compare = "less"
    depth_write: bool = True
    stencil: Stencil | None = field(default=None)

    def __post_init__(self) -> None:
        require_choices(self)
        Arguments("RasterOptions").number("near", self.near, above=0)
        if not self.far >= self.near:
            expected = f"at least near, {self.near:g}"
            raise RangeError(message("RasterOptions", "far", expected, self.far))
