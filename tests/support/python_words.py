"""Identifiers that the Python sources no longer use, by the folders in which they had that meaning.

As in `words.NAMES`, a name is one part of an identifier or several in a row. A name with a capital
letter is a whole identifier: `Recovery` is banned, `RecoveryOptions` is not.
"""

from __future__ import annotations

import io
import re
import tokenize
from collections.abc import Iterator, Mapping
from fnmatch import fnmatch

from support.words import has_word

_COURSE = "photograd_course/src/photograd_course/"
# Path below python/ -> name -> what to say.
NAMES: Mapping[tuple[str, ...], Mapping[str, str]] = {
    ("*",): {
        "Unknown": "Parameter",
        "Recovery": "InverseRendering",
        "Dossier": "AssignmentBuild",
        "dossier": "build",
        "lifeline": "reaper",
        "lifelines": "reapers",
        "ray_slope": "loss_and_grad",
        "view_slope": "loss_and_grad",
        "Slope": "loss_and_grad",
        "contender": "candidate",
        "contest": "comparison",
        "ranking": "quality plot",
        "Words": "GltfMaterial",
        "Draft": "MaterialReader",
        "Painted": "TextureWriter",
        "Brought": "imported meshes",
        "Meeting": "focus point",
    },
    (f"{_COURSE}build/*",): {"Look": "Rule", "look": "check_<rule>"},
    (f"{_COURSE}submissions/*",): {"prints": "fingerprints"},
    ("photograd/*",): {
        "unknowns": "parameters",
        "seen": "visible, footprint, contributions",
        "place": "slot, instance, transform",
        "places": "slots, instances, transforms",
        "lost": "the name of what is lost",
        "wave": "batch",
        "waves": "batches",
        "lamp": "light, emitter",
    },
    ("photograd/transport/*",): {
        "cross_loss": "dual_buffer_loss",
        "halves": "buffers",
        "receiver": "irradiance sensor",
        "listed": "packed",
        "glow": "emission_texture",
    },
    ("photograd/splats/*",): {
        "pressure": "positional gradient statistics (grad2d)",
        "pull": "positional gradient statistics (grad2d)",
        "least": "min",
        "most": "max",
    },
}
# (path below python/, identifier) -> why it may stay.
EXCEPTIONS: Mapping[tuple[str, str], str] = {
    ("photograd/fields/march.py", "place_samples"): "verb: a function of the core",
    ("photograd/capture/sfm/picture.py", "place_axes"): "verb",
    ("photograd/fitting/gradient_drawings.py", "place_axes"): "verb",
    ("photograd/fitting/group_gradients.py", "place_axes"): "verb",
    ("photograd/fitting/network_gradients.py", "place_axes"): "verb",
    ("photograd/fitting/surface_gradients.py", "place_axes"): "verb",
    ("photograd/fitting/quality_plot.py", "place_axes"): "verb",
    ("photograd/transport/inverse/pictures.py", "place_axes"): "verb",
    ("photograd/transport/builtin.py", "GLOW_RADIANCE"): "the sky around the sun",
    ("photograd/transport/builtin.py", "GLOW_SHARPNESS"): "the sky around the sun",
}


def names_of(path: str, text: str) -> Iterator[tuple[int, str]]:
    """Identifiers of the path (line 0) and of the code, each with its line."""
    yield from ((0, name) for name in re.findall(r"\w+", path))
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.NAME:
            yield token.start[0], token.string


def banned(path: str, text: str) -> list[str]:
    """One line for each banned name of a file below python/, where it stands first."""
    bans: dict[str, str] = {}
    for folders, names in NAMES.items():
        if any(fnmatch(path, folder) for folder in folders):
            bans |= names
    first: dict[str, int] = {}
    for line, name in names_of(path, text):
        first.setdefault(name, line)
    return [
        f"python/{path}:{line} {name}: say {say}"
        for name, line in first.items()
        if (path, name) not in EXCEPTIONS
        for word, say in bans.items()
        if (name == word if word[0].isupper() else has_word(name, word))
    ]
