"""Write what a wheel carries of others, with their licenses, into the wheel.

Usage: notices.py WHEEL

    *.dist-info/licenses/THIRD_PARTY_NOTICES.txt   a line for each shared library in the wheel and
        each library that is compiled into the core, then the texts

Texts are the copyright files of the Debian packages that the libraries come from, or the licenses
of conda's packages where $CONDA_PREFIX is set. A library without one is an error.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import zipfile
from collections.abc import Iterable
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

LIBRARY = re.compile(r"(?:^|/)[^/]+\.(?:so(?:\.[\d.]+)?|dylib|dll)$")
BUNDLES = re.compile(r"^photograd\.libs/|^photograd/\.dylibs/")
TAG = re.compile(r"-[0-9a-f]{8,32}(?=\.)")  # that auditwheel and delvewheel add to a name
FOLDERS = ("/usr/lib/x86_64-linux-gnu", "/usr/lib/aarch64-linux-gnu", "/usr/lib")
COMMON = re.compile(r"/usr/share/common-licenses/([\w.-]*[\w-])")
HEADERS = {"GLM": "libglm-dev", "Boost": "libboost1.74-dev"}
"""Libraries of headers, and the Debian packages they come from."""
NAME = "THIRD_PARTY_NOTICES.txt"
HEAD = """Software of others in this wheel

photograd itself is under the Apache License 2.0 (LICENSE). A line names each shared library that
lies in the wheel beside the core, or that is compiled into it: its package and version, and where
its sources are. Below are the licenses, as those packages state them; such a statement may speak
of parts of its sources that are not in the library.

"""


@dataclass(frozen=True)
class Package:
    """Where a library comes from."""

    name: str
    version: str
    sources: str
    text: str


def bundled(names: Iterable[str]) -> list[str]:
    """The shared libraries among the names of a wheel's files, without the core itself."""
    return sorted(
        name.rpartition("/")[2] for name in names if BUNDLES.match(name) and LIBRARY.search(name)
    )


def original(name: str) -> str:
    """The name that a library had before it was packed."""
    return TAG.sub("", name, count=1)


def asked(*command: str) -> str:
    """Output of a command, or nothing where it fails."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else ""


def debian_package(name: str) -> Package | None:
    """A package of Debian by name, with its copyright file and the common licenses it refers to."""
    form = "${Package}\t${Version}\t${source:Package}\t${source:Version}\n"
    found = asked("dpkg-query", "-W", "-f", form, name).splitlines()
    file = Path("/usr/share/doc") / name / "copyright"
    if not found or not file.is_file():
        return None
    package, version, source, source_version = found[0].split("\t")
    text = file.read_text(encoding="utf-8", errors="replace")
    for common in sorted(set(COMMON.findall(text))):
        path = Path("/usr/share/common-licenses") / common
        if path.is_file():
            text += f"\n\n{path}:\n\n{path.read_text(encoding='utf-8')}"
    sources = f"source package {source} {source_version} of Debian"
    return Package(package, version, sources, text)


def debian_owner(library: str) -> Package | None:
    """The package of Debian that a shared library belongs to."""
    for folder in FOLDERS:
        path = (Path(folder) / library).resolve()
        for place in (str(path), str(path).removeprefix("/usr")):
            owner = asked("dpkg-query", "-S", place).partition(":")[0]
            if path.is_file() and owner:
                return debian_package(owner)
    return None


def conda_owner(library: str, prefix: Path) -> Package | None:
    """The package of a conda environment that a shared library belongs to."""
    for record in sorted((prefix / "conda-meta").glob("*.json")):
        about = json.loads(record.read_text(encoding="utf-8"))
        if any(Path(file).name == library for file in about.get("files", [])):
            texts = Path(about["extracted_package_dir"], "info", "licenses").rglob("*")
            text = "\n\n".join(path.read_text("utf-8") for path in sorted(texts) if path.is_file())
            return Package(about["name"], about["version"], about.get("url", ""), text)
    return None


def python_package(name: str) -> Package:
    """A package of this environment, with its license."""
    found = metadata.distribution(name)
    (path,) = [p for p in found.files or [] if p.name == "LICENSE" and ".dist-info" in str(p)]
    text = Path(str(found.locate_file(path))).read_text(encoding="utf-8")
    return Package(name, found.version, str(found.metadata["Home-page"] or ""), text)


def owner(library: str) -> Package | None:
    """The package that a shared library belongs to, of conda's environment or of the system."""
    prefix = os.environ.get("CONDA_PREFIX")
    return conda_owner(library, Path(prefix)) if prefix else debian_owner(library)


def notices(libraries: Iterable[str]) -> str:
    """The text for the named libraries of a wheel, and for what is compiled in.

    Raises:
        ValueError: nobody says under which license one of them is.
    """
    rows = [(name, owner(original(name))) for name in libraries]
    if not os.environ.get("CONDA_PREFIX"):
        rows += [(f"{name} (headers)", debian_package(of)) for name, of in HEADERS.items()]
    rows.append(("pybind11 (headers)", python_package("pybind11")))
    unknown = [name for name, package in rows if package is None or not package.text.strip()]
    if unknown:
        raise ValueError(f"notices: libraries: expected a license for each, got none of {unknown}")
    known = [(name, package) for name, package in rows if package is not None]
    lines = [f"- {name}: {p.name} {p.version}, {p.sources}" for name, p in known]
    texts = {
        p.name: f"\n\n{'=' * 78}\n{p.name} {p.version}\n{'=' * 78}\n\n{p.text}" for _, p in known
    }
    return HEAD + "\n".join(lines) + "\n" + "".join(texts[name] for name in sorted(texts))


def listed(text: str) -> list[str]:
    """The shared libraries that notices name, without what is compiled in."""
    head = text.partition("\n\n\n")[0]
    return sorted(re.findall(r"^- (\S+): ", head, re.MULTILINE))


def write(wheel: Path) -> str:
    """Put the notices into a wheel, in place; the text."""
    from auditwheel.wheeltools import InWheelCtx

    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
    text = notices(bundled(names))
    (metadata_file,) = [name for name in names if re.fullmatch(r"[^/]+\.dist-info/METADATA", name)]
    with InWheelCtx(wheel, wheel) as inside:  # renews RECORD
        target = Path(inside.path, metadata_file).parent / "licenses" / NAME
        target.parent.mkdir(exist_ok=True)
        target.write_text(text, encoding="utf-8")
    return text


if __name__ == "__main__":
    print(f"{NAME}: {len(listed(write(Path(sys.argv[1]))))} libraries")
