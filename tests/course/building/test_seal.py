from __future__ import annotations

import io
import json
import os
import stat
import zipfile
from pathlib import Path

import pytest
from photograd_course.build.archive import zip_bytes
from photograd_course.build.seal import (
    SealError,
    bundle_files,
    open_bundle,
    read_bundle,
    seal_bundle,
)
from photograd_course.build.secret import course_secret, read_secret, secret_beside
from photograd_course.errors import IoError, SceneError

from .support import SECRET, TOY


@pytest.fixture(scope="module")
def sealed() -> bytes:
    return seal_bundle(bundle_files(TOY, {"key": "You forgot the sign."}), SECRET)


def contents(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_what_was_sealed_is_read(sealed: bytes, tmp_path: Path) -> None:
    (tmp_path / "hidden.zip").write_bytes(sealed)
    bundle = read_bundle(tmp_path / "hidden.zip", SECRET)
    assert [check.id for check in bundle.checks] == [
        "90.1.value",
        "90.1.hidden",
        "90.2.differences",
        "90.2.cost",
        "90.3.services",
    ]
    assert not bundle.is_public
    assert bundle.secret == SECRET
    assert bundle.hints == {"key": "You forgot the sign."}


def test_the_seal_names_ids_and_points(sealed: bytes) -> None:
    seal = json.loads(contents(sealed)["seal.json"])
    assert seal["assignment"] == "90"
    assert sum(check["points"] for check in seal["checks"]) == 15
    assert SECRET.decode() not in sealed.decode("latin-1")


def test_any_altered_byte_is_refused(sealed: bytes) -> None:
    for place in range(0, len(sealed), 11):
        altered = bytearray(sealed)
        altered[place] ^= 1
        with pytest.raises(SealError):
            open_bundle(bytes(altered), SECRET)


def test_another_secret_is_refused(sealed: bytes) -> None:
    with pytest.raises(SealError, match="the seal of this course's secret"):
        open_bundle(sealed, SECRET + b"!")


@pytest.mark.parametrize("how", ["dropped", "added", "replaced", "points", "unsealed"])
def test_a_zip_made_anew_is_refused(sealed: bytes, how: str) -> None:
    files = contents(sealed)
    if how == "dropped":
        del files["toy.py"]
    elif how == "added":
        files["answers.py"] = b""
    elif how == "replaced":
        files["checks/task_1.py"] = files["checks/task_1.py"].replace(b"points=3", b"points=9")
    elif how == "points":
        files["seal.json"] = files["seal.json"].replace(b'"points": 3', b'"points": 9')
    else:
        del files["seal.json"]
    with pytest.raises(SealError):
        open_bundle(zip_bytes(files), SECRET)


@pytest.mark.parametrize("data", [b"", b"no zip", b"PK\x05\x06" + bytes(18)])
def test_what_is_no_bundle_is_refused(data: bytes) -> None:
    with pytest.raises(SealError):
        open_bundle(data, SECRET)


def test_a_bundle_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(IoError, match="a sealed bundle"):
        read_bundle(tmp_path / "none.zip", SECRET)


def test_a_secret_is_made_once_and_ignored_by_git(tmp_path: Path) -> None:
    place = secret_beside(tmp_path / "course")
    first = course_secret(None, [place])
    assert first == (place.read_bytes().strip(), place, True)
    assert course_secret(None, [place]) == (first.value, place, False)
    assert len(first.value) == 64
    assert (place.parent / ".gitignore").read_text("utf-8") == "*\n"
    if os.name == "posix":
        assert stat.S_IMODE(place.stat().st_mode) == 0o600
    assert course_secret(None, [secret_beside(tmp_path / "other")]).value != first.value


def test_a_secret_is_written_where_it_is_asked_for(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    asked, other = tmp_path / "mine" / "of_2027.txt", tmp_path / "default.txt"
    made = course_secret(asked, [other])
    assert (made.place, made.is_new) == (asked, True)
    assert [path.name for path in asked.parent.iterdir()] == ["of_2027.txt"]  # nothing is ignored
    assert not other.exists()
    assert "keep it" in made.explained()
    assert str(asked) in made.explained()
    assert made.value.decode() not in made.explained()
    assert course_secret(asked, [other]) == (made.value, asked, False)


def test_the_secret_of_a_build_serves_its_zips(tmp_path: Path) -> None:
    built, zipped = tmp_path / "built.txt", tmp_path / "zipped.txt"
    beside = course_secret(None, [built, zipped])
    assert beside.place == zipped  # nothing was built yet
    first = course_secret(built, [])
    assert course_secret(None, [built, zipped]) == (first.value, built, False)


def test_a_secret_of_the_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PHOTOGRAD_COURSE_SECRET", SECRET.decode())
    given = course_secret(None, [tmp_path / "secret.txt"])
    assert given == (SECRET, None, False)
    assert "PHOTOGRAD_COURSE_SECRET" in given.explained()
    assert not list(tmp_path.iterdir())


def test_a_short_secret_is_refused(tmp_path: Path) -> None:
    (tmp_path / "secret.txt").write_text("hush\n", "utf-8")
    with pytest.raises(SceneError, match="at least 16 characters"):
        read_secret(tmp_path / "secret.txt")
