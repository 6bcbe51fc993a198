"""What tests of captures share: where the real captures lie."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def posed() -> Path:
    """Folder of real captures beside the repository; tests that want it are skipped without it."""
    folder = Path(__file__).resolve().parents[2].parent / "shared" / "data" / "posed"
    if not folder.is_dir():
        pytest.skip("no real captures beside the repository (../shared/data/posed)")
    return folder
