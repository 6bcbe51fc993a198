"""What the picture of pruning claims in its caption."""

from __future__ import annotations

import sys

import pytest

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import figures_sparse as sparse


@pytest.mark.slow
def test_what_was_pruned_too_early_never_comes_back_unless_it_is_dilated() -> None:
    kept, early, grown = sparse.curves()
    assert kept.share[-1] == 1.0
    # Measured: 35.0 dB with all voxels, 29.0 pruned early, 34.9 dilated, with 11 % of them.
    assert early.psnr[-1] < kept.psnr[-1] - 4.0
    assert grown.psnr[-1] > kept.psnr[-1] - 0.5
    assert early.share[-1] < 0.03
    assert early.share[-1] < grown.share[-1] < 0.2
    assert not (early.mask & ~kept.mask).any()
    assert "Second row" in "".join(t.get_text() for t in sparse.figure([kept, early, grown]).texts)
