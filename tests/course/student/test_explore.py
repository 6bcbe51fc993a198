"""Options of the scripts that students play with."""

from __future__ import annotations

import pytest
from photograd_course.explore import option


def test_an_option_has_the_type_of_its_default(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.argv", ["explore.py", "--steps", "7", "--file", "8"])
    assert option("steps", 1.5) == 7.0
    assert option("file", "") == "8"
    assert option("other", 3) == 3
    monkeypatch.setattr("sys.argv", ["explore.py", "--steps", "many"])
    with pytest.raises(ValueError, match="many"):
        option("steps", 1)
