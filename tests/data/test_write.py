"""Written captures: the Blender convention to the letter, and all or nothing."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from photograd.capture import Camera, load_capture, write_blender_capture
from photograd.capture.write import Frame
from photograd_course.errors import Error, IoError, RangeError, SceneError, ShapeError

from support.capture_files import edit_json, look_at, orbit, picture, write_blender

BOX = np.array([[-1.0, -0.5, -0.25], [1.0, 2.0, 3.0]])


def frames(cameras: list[Camera], *, radiance: bool = True) -> list[Frame]:
    """Frames as a renderer would hand them over."""
    result: list[Frame] = []
    for index, camera in enumerate(cameras):
        image = picture(camera) / np.float32(255.0)
        linear = image.copy()
        linear[..., :3] = 3.0 * image[..., :3] ** 2.2 * image[..., 3:]
        result.append((f"r_{index}", camera, image, linear if radiance else None))
    return result


def test_round_trip(tmp_path: Path) -> None:
    train, test = frames(orbit(6)), frames(orbit(5)[3:])
    write_blender_capture(tmp_path / "c", {"train": train, "test": test}, aabb=BOX)
    for space in ("display", "linear"):
        capture = load_capture(tmp_path / "c", color_space=space)  # type: ignore[arg-type]
        assert capture.color_space == space
        assert capture.has_alpha
        assert capture.bounds is not None
        np.testing.assert_allclose(capture.bounds, BOX, atol=1e-15)
        for views, written in ((capture.train, train), (capture.test, test)):
            assert len(views) == len(written)
            for view, (name, camera, image, radiance) in zip(views, written, strict=True):
                assert view.name.endswith(name)
                pose = view.camera.world_from_camera
                np.testing.assert_allclose(pose, camera.world_from_camera, atol=1e-6)
                assert view.camera.fx == pytest.approx(camera.fx, rel=1e-14)
                assert radiance is not None
                rgba = view.rgba()
                if space == "display":
                    np.testing.assert_array_equal(rgba, image)
                else:
                    np.testing.assert_allclose(rgba[..., :3] * rgba[..., 3:], radiance[..., :3])
    assert not [entry for entry in tmp_path.iterdir() if entry.name != "c"]


def test_the_convention_by_hand(tmp_path: Path) -> None:
    """A camera on our +Z axis that looks at the origin: in Blender it sits on -Y."""
    camera = Camera(24, 20, 26.0, 26.0, 12.0, 10.0, look_at(np.array([0.0, 0, 4]), np.zeros(3)))
    write_blender_capture(tmp_path / "c", {"train": frames([camera], radiance=False)})
    content = json.loads((tmp_path / "c/transforms_train.json").read_text())
    assert content["camera_angle_x"] == pytest.approx(2.0 * math.atan(12.0 / 26.0))
    assert content["frames"][0]["file_path"] == "./train/r_0"
    # Columns: right (+X), up (+Z), backwards (-Y), position.
    expected = [[1, 0, 0, 0], [0, 0, -1, -4], [0, 1, 0, 0], [0, 0, 0, 1]]
    np.testing.assert_allclose(content["frames"][0]["transform_matrix"], expected, atol=1e-15)
    assert (tmp_path / "c/train/r_0.png").is_file()
    assert not (tmp_path / "c/train/r_0.exr").exists()


def test_existing_folders_are_kept_unless_asked(tmp_path: Path) -> None:
    target = tmp_path / "c"
    target.mkdir()
    (target / "notes.txt").write_text("keep me")
    with pytest.raises(IoError, match="expected a new folder"):
        write_blender_capture(target, {"train": frames(orbit(1))})
    assert (target / "notes.txt").read_text() == "keep me"
    others = write_blender_capture(target, {"train": frames(orbit(2))}, overwrite=True)
    assert others == ["notes.txt"]
    assert len(load_capture(target, trust_poses=True).views) == 2
    assert (target / "notes.txt").read_text() == "keep me"


def test_only_files_that_were_written_are_replaced(tmp_path: Path) -> None:
    write_blender_capture(tmp_path, {"train": frames(orbit(3)), "test": frames(orbit(1))})
    (tmp_path / "train/mask.png").write_bytes(b"mine")
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis/one.tex").write_text("years")
    others = write_blender_capture(
        tmp_path, {"train": frames(orbit(2), radiance=False)}, overwrite=True
    )
    assert others == ["thesis", "train/mask.png"]
    files = sorted(str(p.relative_to(tmp_path)) for p in tmp_path.rglob("*") if p.is_file())
    ours = ["train/r_0.png", "train/r_1.png", "transforms_train.json"]
    assert files == sorted(["capture.json", "thesis/one.tex", "train/mask.png", *ours])


def test_a_capture_of_another_hand_is_not_replaced(tmp_path: Path) -> None:
    write_blender(tmp_path, orbit(2), orbit(1))
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(IoError, match=r"did not write, got .*transforms_train.json \(move it away"):
        write_blender_capture(tmp_path, {"train": frames(orbit(2))}, overwrite=True)
    assert sorted(tmp_path.rglob("*")) == before
    # Nor does a manifest that names files elsewhere bring them into danger.
    capture, elsewhere = tmp_path / "c", tmp_path / "transforms_test.json"
    write_blender_capture(capture, {"train": frames(orbit(1))})
    (capture / "linked").symlink_to(tmp_path / "test")
    names = ["../transforms_test.json", str(elsewhere), "linked/0000.png"]
    edit_json(capture / "capture.json", lambda content: content["files"].extend(names))
    write_blender_capture(capture, {"train": frames(orbit(1))}, overwrite=True)
    assert elsewhere.exists()
    assert (tmp_path / "test/0000.png").exists()


def test_a_disk_that_fails_while_files_are_moved_gives_the_old_capture_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "c"
    write_blender_capture(target, {"train": frames(orbit(2))})
    before = {path: path.read_bytes() for path in target.rglob("*") if path.is_file()}
    rename = Path.replace

    def fails(self: Path, other: Path) -> Path:
        if self.parts[-3:] == (".capture.partial", "train", "r_1.png"):
            raise OSError(5, "Input/output error")
        return rename(self, other)

    monkeypatch.setattr(Path, "replace", fails)
    with pytest.raises(IoError, match="writable folder, got Input/output error"):
        write_blender_capture(target, {"train": frames(orbit(3))}, overwrite=True)
    assert {path: path.read_bytes() for path in target.rglob("*") if path.is_file()} == before


def test_what_a_killed_run_left_is_in_nobodys_way(tmp_path: Path) -> None:
    for name in (".capture.partial/train/r_9.png", ".capture.replaced/train/r_0.png"):
        (tmp_path / name).parent.mkdir(parents=True)
        (tmp_path / name).write_bytes(b"half")
    (tmp_path / ".photograd.lock").write_text("99999 photograd capture")
    assert write_blender_capture(tmp_path, {"train": frames(orbit(2))}) == []
    assert [path.name for path in tmp_path.glob(".*")] == [".photograd.lock"]


def test_a_failure_leaves_the_old_capture(tmp_path: Path) -> None:
    target = tmp_path / "c"
    write_blender_capture(target, {"train": frames(orbit(2))})
    bad = frames(orbit(3))
    bad[2][2][0, 0] = np.nan
    with pytest.raises(RangeError, match="finite"):
        write_blender_capture(target, {"train": bad}, overwrite=True)
    assert len(load_capture(target).views) == 2
    assert [entry.name for entry in tmp_path.iterdir()] == ["c"]
    (tmp_path / "file").write_text("")
    with pytest.raises(IoError, match="writable folder"):
        write_blender_capture(tmp_path / "file" / "c", {"train": frames(orbit(2))})


def test_what_the_format_cannot_say_is_refused(tmp_path: Path) -> None:
    good = frames(orbit(2))

    def altered(**members: float) -> list[Frame]:
        name, camera, image, radiance = good[1]
        return [good[0], (name, replace(camera, **members), image, radiance)]

    cases: list[tuple[dict[str, list[Frame]], type[Error], str]] = [
        ({}, SceneError, "no training frames"),
        ({"train": good, "other": good}, SceneError, "unknown"),
        ({"train": [good[0], good[0]]}, SceneError, "a name twice"),
        ({"train": altered(cx=11.0)}, RangeError, "principal point in the middle"),
        ({"train": altered(fx=30.0, fy=30.0)}, RangeError, "one focal length"),
        ({"train": altered(width=26, cx=13.0)}, RangeError, "one size"),
        ({"train": [("../x", *good[0][1:])]}, SceneError, "plain file name"),
        ({"train": [("x", good[0][1], good[0][2][:5], None)]}, ShapeError, "image"),
    ]
    for splits, error, text in cases:
        with pytest.raises(error, match=text):
            write_blender_capture(tmp_path / "c", splits)
    with pytest.raises(RangeError, match="aabb"):
        write_blender_capture(tmp_path / "c", {"train": good}, aabb=BOX[::-1])
    assert not list(tmp_path.iterdir())
