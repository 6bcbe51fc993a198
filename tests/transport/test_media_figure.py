"""What the caption of docs/images/media.png says."""

from __future__ import annotations

import sys

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import figures_media as figure


def test_the_caption_is_true() -> None:
    # In a smaller picture with fewer samples; `check` asserts.
    numbers = figure.check(figure.pictures(40, 48), 40)
    assert len(numbers) == 8
