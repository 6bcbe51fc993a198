"""Makes `data/`: a capture of bananas on a carpet, small enough for a kit.

    python reduce_capture.py FOLDER

FOLDER holds the undistorted photographs: `transforms.json` with one pinhole camera, `images/`, and
`sparse/points3D.txt` of COLMAP; the LICENSE stands one folder up. Photographs become 500 pixels
wide. The world is turned, moved and scaled: +Y is the normal of the carpet, the origin is in the
middle of the bananas, the cameras are 3.2 m away on average. The same
input gives the same files.
"""

import json
import shutil
import sys
from pathlib import Path

import numpy as np
from PIL import Image

WIDTH, QUALITY, DISTANCE = 500, 90, 3.2
REACH, EVERY = 2.2, 2  # of the points: meters from the origin; every second one
TARGET = Path(__file__).resolve().parent / "data"


def upright(points, colors, eyes):
    """(scale, rotation, middle): x becomes scale * rotation @ (x - middle)."""
    yellow = (colors[:, 0] > 1.6 * colors[:, 2]) & (colors[:, 1] > 1.3 * colors[:, 2])
    middle = np.median(points[yellow], axis=0)
    carpet = points[~yellow]
    carpet = carpet[np.linalg.norm(carpet - np.median(carpet, axis=0), axis=1) < 2]
    up = np.linalg.svd(carpet - carpet.mean(axis=0), full_matrices=False)[2][2]
    up = up * np.sign(up @ (eyes.mean(axis=0) - middle))
    right = np.cross(up, eyes[0] - middle)
    right /= np.linalg.norm(right)
    rotation = np.stack([right, up, np.cross(right, up)])
    return DISTANCE / np.linalg.norm(eyes - middle, axis=1).mean(), rotation, middle


def main(folder):
    """Write all files."""
    told = json.loads((folder / "transforms.json").read_text(encoding="utf-8"))
    table = np.loadtxt(folder / "sparse" / "points3D.txt", usecols=range(1, 7))
    table = table[np.lexsort(table.T)]
    poses = [np.array(frame["transform_matrix"]) for frame in told["frames"]]
    scale, rotation, middle = upright(
        table[:, :3], table[:, 3:], np.stack([pose[:3, 3] for pose in poses])
    )
    TARGET.mkdir(exist_ok=True)
    height = round(told["h"] * WIDTH / told["w"])
    kept = {"w": WIDTH, "h": height, "fl_x": round(told["fl_x"] * WIDTH / told["w"], 4)}
    frames = []
    for frame, pose in zip(told["frames"], poses, strict=True):
        name = Path(frame["file_path"]).name
        photograph = Image.open(folder / frame["file_path"], formats=("JPEG", "PNG")).convert("RGB")
        photograph = photograph.resize((WIDTH, height), Image.Resampling.LANCZOS)
        photograph.save(TARGET / name, quality=QUALITY, optimize=True)
        moved = np.eye(4)
        moved[:3, :3] = rotation @ pose[:3, :3]
        moved[:3, 3] = scale * rotation @ (pose[:3, 3] - middle)
        frames.append({"file_path": name, "transform_matrix": moved.tolist()})
    text = json.dumps({**kept, "frames": frames}, indent=1) + "\n"
    (TARGET / "transforms.json").write_text(text, encoding="utf-8")
    places = scale * (table[:, :3] - middle) @ rotation.T
    points = np.concatenate([places, table[:, 3:] / 255], axis=1)
    points = points[np.linalg.norm(places, axis=1) < REACH][::EVERY]
    np.save(TARGET / "points.npy", points.astype(np.float32))
    shutil.copyfile(folder.parent / "LICENSE", TARGET / "LICENSE")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python reduce_capture.py FOLDER")
    main(Path(sys.argv[1]))
