"""Where the page of a handout is looked for, and written."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from photograd_course.build.kits import find_kit
from photograd_course.errors import IoError
from photograd_course.student import reading
from photograd_course.student.reading import kit_page, page_to_read
from photograd_course.student.starting import lay_out


def test_in_a_checkout_the_page_is_written_beside_you(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    path = page_to_read(find_kit("00"), None)
    assert path == tmp_path / "00_setup.html"
    assert b'src="data:image/png' in path.read_bytes()


def test_in_a_kit_its_own_page_is_opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kit = find_kit("00")
    lay_out({**kit.files, "handout.html": b"mine"}, tmp_path / "00_setup")
    monkeypatch.chdir(tmp_path)
    path = page_to_read(kit, None)
    assert path == tmp_path / "00_setup" / "handout.html"
    assert path.read_bytes() == b"mine"
    assert page_to_read(kit, tmp_path / "00_setup") == path
    path.unlink()  # an older kit, without it
    assert page_to_read(kit, None) == path
    with pytest.raises(IoError, match="course start 00"):
        page_to_read(kit, tmp_path)


def test_where_it_cannot_be_made_what_to_do_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(reading, "TOOLS", ("no_such_module",))
    assert kit_page(find_kit("00").files) is None
    with pytest.raises(
        IoError, match=r"pip install 'photograd-course\[handouts\]', or read README"
    ):
        page_to_read(find_kit("00"), None)
    with pytest.raises(IoError, match="got no handout"):
        page_to_read(replace(find_kit("00"), files={}), None)
