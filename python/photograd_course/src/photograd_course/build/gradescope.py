"""The zip that a Gradescope autograder is configured with.

Everything that grading takes is inside: the course's wheel, the sealed bundle, the secret, and, if
they are given, wheels of what it depends on, so that building the container needs no network. The
container's own user stays root; each submission runs as another one, in isolation mode A, B or C.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import metadata

from .archive import zip_bytes
from .wheel import course_wheel

PINNED = (
    "numpy",
    "matplotlib",
    "pillow",
    "pyyaml",
    "rich",
    "tomlkit",
    "typer",
    "typing-extensions",
)
EXECUTABLE = ("setup.sh", "run_autograder")

SETUP = """#!/usr/bin/env bash
# Runs once, when Gradescope builds the container.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
chmod -R go-rwx .   # bundle and secret are for root alone
if ! python3 -m ensurepip --version >/dev/null 2>&1; then
    apt-get update
    apt-get install -y --no-install-recommends python3 python3-venv
fi
apt-get install -y --no-install-recommends bubblewrap || echo "no bubblewrap: mode B or C"
python3 -m venv /opt/photograd
if ls wheels/numpy-*.whl >/dev/null 2>&1; then
    /opt/photograd/bin/pip install --no-index --find-links wheels photograd-course
else
    /opt/photograd/bin/pip install -c constraints.txt wheels/photograd_course-*.whl
fi
chmod -R go+rX /opt/photograd
/opt/photograd/bin/photograd version
"""

RUN = """#!/usr/bin/env bash
# Runs for each submission. results.json is written after every check.
set -uo pipefail
umask 077
source=/autograder/source
chmod -R go-rwx "$source"
exec /opt/photograd/bin/python -I -m photograd_course.build.gradescope_run NUMBER \\
    --bundle "$source/hidden.zip" --secret-file "$source/secret.txt" \\
    --submission /autograder/submission --metadata /autograder/submission_metadata.json \\
    --results /autograder/results/results.json
"""


def gradescope_zip(
    number: str, bundle: bytes, secret: bytes, wheels: Mapping[str, bytes] | None = None
) -> bytes:
    """The zip.

    Args:
        number: of the assignment, such as "01".
        bundle: its sealed bundle.
        secret: of the course.
        wheels: of the dependencies, by file name; without them the container's build fetches the
            pinned versions.
    """
    name, wheel = course_wheel()
    files = {
        "setup.sh": SETUP.encode(),
        "run_autograder": RUN.replace("NUMBER", number).encode(),
        "hidden.zip": bundle,
        "secret.txt": secret + b"\n",
        "constraints.txt": constraints().encode(),
        f"wheels/{name}": wheel,
        **{f"wheels/{file}": data for file, data in (wheels or {}).items()},
    }
    return zip_bytes(files, EXECUTABLE)


def constraints() -> str:
    """The versions that the bundle was built with, and its tolerances measured."""
    return "".join(f"{name}=={metadata.version(name)}\n" for name in PINNED)
