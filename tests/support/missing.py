"""What a test needs and this machine lacks."""

from __future__ import annotations

import os
from typing import NoReturn

import pytest


def missing(reason: str) -> NoReturn:
    """Skip the test; fail it in continuous integration, where everything has to be there."""
    if os.environ.get("CI") == "true":
        pytest.fail(f"{reason} (continuous integration has to have it)")
    pytest.skip(reason)
