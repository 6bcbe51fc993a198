"""docs/scene_file.md: its blocks are one scene, and it names every key and model."""

from __future__ import annotations

import ast
import re
import sys
from pathlib import Path

import numpy as np
import pytest

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
try:
    import scene_file_models
finally:
    sys.path.pop(0)

pytestmark = pytest.mark.usefixtures("core")

READERS = ("scene_file.py", "scene_meshes.py", "scene_tables.py", "sdf_nodes.py", "scene_node.py")
PAGE = scene_file_models.PAGE.read_text(encoding="utf-8")


def test_the_table_of_models_is_that_of_the_script() -> None:
    assert scene_file_models.written(PAGE) == PAGE  # python docs/scene_file_models.py


def test_the_blocks_are_one_scene(tmp_path: Path) -> None:
    from photograd.grids import SparseGrid, write_vdb
    from photograd.images.write import write_exr, write_png
    from photograd.transport import builtin_scene, read_scene
    from photograd.transport.mesh_files.gltf_save import save_gltf

    picture = np.full((4, 8, 3), 0.5, np.float32)
    write_png(tmp_path / "wood.png", picture)
    write_png(tmp_path / "bumps.png", np.broadcast_to(np.float32([0.5, 0.5, 1]), (4, 4, 3)))
    write_exr(tmp_path / "sky.exr", picture)
    np.save(tmp_path / "smoke.npy", np.ones((2, 2, 2), np.float32))
    grid = SparseGrid.from_dense(np.ones((4, 4, 4), np.float32))
    write_vdb(tmp_path / "cloud.vdb", [grid])
    save_gltf(builtin_scene("cornell-box"), tmp_path / "chair.glb")
    text = "\n".join(re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL))
    (tmp_path / "all.toml").write_text(text, encoding="utf-8")
    scene = read_scene(tmp_path / "all.toml")
    assert scene.world == "haze"
    assert len(scene.lights) >= 2
    assert {"haze", "milk", "smoke", "cloud"} <= set(scene.media)


# What the readers ask a table with; the first or second argument is the key.
ASKING = {"has", "value", "table", "tables", "text", "choice", "flag", "number", "numbers", "color"}
ASKING |= {"rows", "texture_use", "_length", "_color"}


def keys_of_readers() -> set[str]:
    """Keys that the readers of scene files ask a table for."""
    found = set()
    for name in READERS:
        tree = ast.parse((ROOT / "python/photograd/transport" / name).read_text(encoding="utf-8"))
        for call in ast.walk(tree):
            if isinstance(call, ast.Call) and ast.unparse(call.func).split(".")[-1] in ASKING:
                found |= {each.value for each in call.args[:2] if isinstance(each, ast.Constant)}
    return {key for key in found if isinstance(key, str)}


def test_every_key_is_on_the_page() -> None:
    keys = keys_of_readers()
    assert len(keys) > 50
    text = re.sub(r"```toml\n|```", "", PAGE)
    named = set(re.findall(r"\w+", " ".join(re.findall(r"`[^`\n]+`", text))))
    written = set(re.findall(r"^\[*(\w+)", text, re.MULTILINE))
    assert keys - named - written == set()
