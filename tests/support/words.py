"""Words that the sources no longer use, and the functions that find them.

The code speaks the language of the field: a reader who knows its papers and renderers must find
what they know by searching for the word they know. `NAMES` lists the names that hid it, by the
folders in which they had that meaning; elsewhere the same words are free (a wave of light, cloth
with hair). A ban without an occurrence stays: it keeps the name out.
"""

from __future__ import annotations

import io
import re
import tokenize
from collections.abc import Iterator, Mapping
from fnmatch import fnmatch
from functools import cache

# Path below cpp/ -> name -> what to say. A name is one part of an identifier or several in a row:
# "hair" is found in hair_width and HairWidth, "light_map" in light_map.h and trace_light_map.
NAMES: Mapping[tuple[str, ...], Mapping[str, str]] = {
    ("photograd/render/*", "photograd/scene/*", "photograd/bsdf/*", "bindings/*"): {
        "veil": "occluder",
        "veils": "occluders",
        "sheer": "has_opacity",
        "coverage": "opacity",
        "look_through": "shadow_transmittance",
        "uncovered": "scattered_radiance",
        "drawn": "eval_material (evaluated), sampled (random)",
    },
    ("photograd/render/*", "photograd/scene/*", "photograd/bsdf/*"): {
        "cover": "sample_opacity",
        "passed": "is_null",
    },
    ("photograd/light/*", "photograd/medium/*", "photograd/sampling/*", "tests/*"): {
        "drawn": "sampled"
    },
    ("photograd/render/*", "photograd/scene/*", "photograd/light/*"): {
        "ask": "sample_direct, sample_emitter",
        "find_light": "sample_emitter",
        "may_ask": "has_direct",
        "met": "hit",
        "piece": "emissive primitive",
        "pieces": "emissive primitives",
        "sent": "Le",
        "carried": "beta",
        "ahead": "Li",
        "leaving": "Lo",
        "go_on": "sample_bsdf",
        "pass_on": "continue_straight",
        "arrive": "make_vertex",
    },
    ("photograd/scene/*", "photograd/light/*", "photograd/render/path/*", "bindings/*"): {
        "listed": "infinite_and_delta"
    },
    ("photograd/render/path/*", "photograd/render/light/*", "photograd/render/reference/*"): {
        "walk": "path tracer, integrator",
        "around": "medium stack",
    },
    (
        "photograd/medium/*",
        "photograd/scene/*",
        "photograd/render/path/*",
        "photograd/render/light/*",
        "photograd/render/reference/*",
        "bindings/media*",
    ): {
        "surroundings": "medium stack",
        "crossing": "medium boundary",
        "crossings": "medium boundaries",
        "fly": "sample_distance",
        "absorb": "transmittance",
        "track": "delta_tracking",
        "chance": "pdf",
        "shares": "spectral_mis",
    },
    ("photograd/render/*", "photograd/scene/*", "bindings/*"): {
        "receiver": "irradiance sensor",
        "gate": "intersect",
        "land": "splat",
        "landing": "splat",
        "hair": "epsilon",
        "light_map": "light tracer",
    },
    ("photograd/render/path/*", "photograd/render/light/*", "photograd/scene/*"): {
        "keeper": "path cache",
        "kept": "cached",
        "pairs": "dual-buffer loss",
        "halves": "dual-buffer loss",
        "cross_loss": "dual-buffer loss",
    },
    ("photograd/sampling/*", "photograd/bsdf/*", "photograd/scene/*", "photograd/render/*"): {
        "even": "Sobol",
        "smooth": "specular",
        "glow": "emission_texture, sample_area_light",
        "ground": "base",
        "varnish": "coating",
    },
    ("*",): {
        "seen": "footprint, visible, lookups",
        "place": "slot, instance, transform",
        "places": "slots, instances, transforms",
        "lost": "the name of what is lost",
        "wave": "batch",
        "waves": "batches",
        "lamp": "light, emitter",
        "centre": "center",
        "colour": "color",
        "metre": "meter",
    },
    ("photograd/splat/*", "photograd/render/splat/*", "kernels/*splat*", "bindings/*splat*"): {
        "pressure": "positional gradient statistics (grad2d)",
        "pull": "positional gradient statistics (grad2d)",
        "least": "min",
        "most": "max",
    },
}
# (path below cpp/, identifier) -> why it may stay.
EXCEPTIONS: Mapping[tuple[str, str], str] = {
    ("photograd/ops/thin_film.h", "Wave"): "a light wave and its phase",
    ("photograd/render/march/march.h", "place"): "verb: puts samples on rays",
    ("photograd/render/march/lattice.h", "place_samples"): "verb",
    ("bindings/bind_march.cpp", "place_samples"): "verb",
    ("bindings/bind_march.cpp", "place_rays"): "verb",
    ("tests/test_lattice.cpp", "place_samples"): "verb",
    ("kernels/march_dense.inl", "place_block"): "verb",
    ("photograd/geometry/reference/sdf.h", "place"): "an operation, beside scale and intersect",
    ("photograd/geometry/reference/sdf.cpp", "place"): "the same operation",
    ("photograd/geometry/sdf_layout.cpp", "place"): "the same operation",
    ("tests/test_sdf_solid.cpp", "place"): "the same operation",
}

_DERIVATIVE = r"(?:derivative|gradient|slope|tangent|adjoint|jacobian)s?"
# Phrases of prose, as patterns -> what to say. They are looked for across the ends of lines.
PHRASES: Mapping[str, str] = {
    rf"{_DERIVATIVE} by(?! \[|(?: \w+)? (?:finite )?differenc| hand|-)": "with respect to",
    r"the way (?:back|there)": "backward pass, forward pass",
    r"bod(?:y|ies) of signed distances?": "signed distance field (SDF)",
    r"lights? (?:asked|met)": "light sampling, BSDF sampling",
    r"(?:point |sun)?lamps?": "light, emitter",
    r"calmer": "lower variance",
    r"whoever": "name the subject",
    r"those who": "name the subject",
    r"hand-?ins?": "submission",
    r"veils?": "occluder",
    r"sheer": "has opacity",
    r"varnish": "coating",
    r"photographs without cameras": "images with unknown camera poses",
    r"gains? light": "is not energy-conserving",
    r"cent(?:re|red|res)": "American spelling: center",
    r"\w*colou(?:r|rs|red|ring)": "American spelling: color",
    r"(?:kilo|centi|milli)?metres?": "American spelling: meter",
    r"neighbour\w*": "American spelling: neighbor",
    r"behaviour": "American spelling: behavior",
    r"fibres?": "American spelling: fiber",
    r"grey": "American spelling: gray",
    r"\w*(?:normal|vector|initial|optim|raster|general|recogn)is(?:e[ds]?|ing|ation)": "-ize",
}

# In the order in which they may hold each other: raw strings, comments, strings, characters.
_TOKENS = re.compile(
    r'(?P<literal>R"(?P<mark>\w*)\((?:.|\n)*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"'
    r"|(?<![0-9A-Fa-f])'(?:\\.|[^'\\\n])+')"
    r"|(?P<comment>//[^\n]*|/\*(?:.|\n)*?\*/)"
    r"|(?P<name>[A-Za-z_]\w*)"
)
_PARTS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")


@cache
def parts(identifier: str) -> tuple[str, ...]:
    """Words of an identifier: "d_LightMap2" gives ("d", "light", "map", "2")."""
    return tuple(part.lower() for part in _PARTS.findall(identifier))


def has_word(identifier: str, word: str) -> bool:
    """Whether the parts of `word` stand in a row in the identifier."""
    found, goal = parts(identifier), tuple(word.split("_"))
    return any(found[i : i + len(goal)] == goal for i in range(len(found) - len(goal) + 1))


def bans_of(path: str) -> dict[str, str]:
    """Banned names of a file below cpp/, each with what to say."""
    found: dict[str, str] = {}
    for folders, names in NAMES.items():
        if any(fnmatch(path, folder) for folder in folders):
            found |= names
    return found


def cpp_names(path: str, text: str) -> Iterator[tuple[int, str]]:
    """Identifiers of the file's name (offset -1) and of the code, each with its offset.

    In bindings also the names for Python: literals that are one identifier.
    """
    yield from ((-1, name) for name in re.findall(r"\w+", path.rpartition("/")[2]))
    bindings = path.startswith("bindings/")
    for token in _TOKENS.finditer(text):
        name = token["name"] or (bindings and (token["literal"] or "").strip('"'))
        if name and name.isidentifier():
            yield token.start(), name


def banned_names(texts: Mapping[str, str]) -> list[str]:
    """One line for each banned name in C++ sources by path below cpp/, where it stands first."""
    found = []
    for path, text in texts.items():
        bans = bans_of(path)
        first: dict[str, int] = {}
        for offset, name in cpp_names(path, text):
            first.setdefault(name, offset)
        for name, offset in first.items():
            if (path, name) not in EXCEPTIONS:
                line = text.count("\n", 0, max(offset, 0)) + 1
                here = f"cpp/{path}:{line} {name}"
                found += [
                    f"{here}: say {say}" for word, say in bans.items() if has_word(name, word)
                ]
    return found


def cpp_prose(text: str) -> str:
    """Comments and string literals of a C++ source; everything else is blank."""
    prose, end = [], 0
    for token in _TOKENS.finditer(text):
        if token["name"] is None:
            prose.append(re.sub(r"[^\n]", " ", text[end : token.start()]))
            prose.append(re.sub(r"[/\"]", " ", token[0]))
            end = token.end()
    return "".join(prose)


# Names of scenes and shapes that stand in tables of results.
TABLE_ROW = re.compile(r"^\|.*$", re.MULTILINE)


def python_prose(text: str) -> str:
    """Comments and docstrings of a Python source; everything else is blank."""
    lines = [""] * (text.count("\n") + 2)
    expression_starts = True  # a string at the start of a statement documents something
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        is_prose = token.type == tokenize.COMMENT or (
            token.type == tokenize.STRING and expression_starts
        )
        if is_prose:
            for number, line in enumerate(token.string.split("\n"), token.start[0] - 1):
                lines[number] += " " + line.lstrip(" #")
        if token.type not in (tokenize.COMMENT, tokenize.NL):
            expression_starts = token.type in STATEMENT_STARTS
    return "\n".join(lines)


STATEMENT_STARTS = {tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENCODING}


_PHRASES = re.compile(
    "|".join(rf"\b(?:{pattern})(?!\w)".replace(" ", r"\s+") for pattern in PHRASES), re.IGNORECASE
)


def banned_phrases(path: str, prose: str) -> list[str]:
    """One line for each phrase of `PHRASES` in a text whose lines are those of the file."""
    found = []
    for match in _PHRASES.finditer(prose):
        phrase = " ".join(match[0].split())
        say = next(say for pattern, say in PHRASES.items() if re.match(rf"(?i:{pattern})", phrase))
        line = prose.count("\n", 0, match.start()) + 1
        found.append(f"{path}:{line} {phrase}: say {say}")
    return found
