"""Shapes to arrays and back."""

from __future__ import annotations

import numpy as np
from photograd.vector import Drawing
from photograd.vector.drawing import joined

from tests.vector.oracle import everything


def test_shapes_come_back_as_they_were() -> None:
    drawing = everything()
    again = Drawing.of(drawing.shapes)
    for kind in ("layout", "parameters"):
        for name, array in vars(getattr(drawing, kind)).items():
            np.testing.assert_array_equal(vars(getattr(again, kind))[name], array, err_msg=name)


def test_drawings_join_in_their_order() -> None:
    drawing = everything()
    both = joined([drawing, drawing])
    assert len(both.shapes) == 2 * len(drawing.shapes)
    np.testing.assert_array_equal(both.parameters.widths, np.tile(drawing.parameters.widths, 2))
