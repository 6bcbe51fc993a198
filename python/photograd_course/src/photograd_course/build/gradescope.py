"""The zip that a Gradescope autograder is configured with.

Everything that grading takes is inside: the course's wheel, the sealed bundle, the secret, and, if
they are given, wheels of what it depends on, so that building the container needs no network. The
container's own user stays root; each submission runs as another one, in isolation mode A, B or C.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from importlib import metadata

from .archive import zip_bytes
from .wheel import course_wheel

PINNED = (
    "numpy",
    "matplotlib",
    "pillow",
    "pyseccomp",
    "pyyaml",
    "rich",
    "tomlkit",
    "typer",
    "typing-extensions",
)
EXECUTABLE = ("setup.sh", "run_autograder")

# Python's own venv, and what each isolation mode needs: bubblewrap for A, libseccomp2 for B and C.
SETUP = """#!/usr/bin/env bash
# Runs once, when Gradescope builds the container (Python 3.10 or newer).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
chmod -R go-rwx .   # bundle and secret are for root alone
apt-get update
apt-get install -y --no-install-recommends libseccomp2 python3 python3-venv
apt-get install -y --no-install-recommends bubblewrap || echo "no bubblewrap: mode B or C"
home=${PHOTOGRAD_HOME:-/opt/photograd}
python3 -m venv "$home"
if ls wheels/numpy-*.whl >/dev/null 2>&1; then
    "$home/bin/pip" install --no-index --find-links wheels 'photograd-course[grader]'
else
    wheel=$(echo "$PWD"/wheels/photograd_course-*.whl)
    "$home/bin/pip" install -c constraints.txt "photograd-course[grader] @ file://$wheel"
fi
chmod -R go+rX "$home"
"$home/bin/photograd" version
"$home/bin/python" -I -m photograd_course.build.gradescope_run NUMBER --modes
"""

RUN = """#!/usr/bin/env bash
# Runs for each submission. results.json is written after every check.
set -uo pipefail
umask 077
top=${AUTOGRADER:-/autograder}
chmod -R go-rwx "$top/source"
exec "${PHOTOGRAD_HOME:-/opt/photograd}/bin/python" -I -m photograd_course.build.gradescope_run \\
    NUMBER --bundle "$top/source/hidden.zip" --secret-file "$top/source/secret.txt" \\
    --submission "$top/submission" --metadata "$top/submission_metadata.json" \\
    --results "$top/results/results.json"
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
        "setup.sh": SETUP.replace("NUMBER", number).encode(),
        "run_autograder": RUN.replace("NUMBER", number).encode(),
        "hidden.zip": bundle,
        "secret.txt": secret + b"\n",
        "constraints.txt": constraints().encode(),
        f"wheels/{name}": wheel,
        **{f"wheels/{file}": data for file, data in (wheels or {}).items()},
    }
    return zip_bytes(files, EXECUTABLE)


def constraints() -> str:
    """The versions that the bundle was built with, and its tolerances measured.

    Each is asked for where it runs: an older Python in the container takes the newest that it can.
    """
    return "".join(f"{name}=={metadata.version(name)}{_marker(name)}\n" for name in PINNED)


def _marker(name: str) -> str:
    oldest = re.search(r">=\s*(\d+\.\d+)", metadata.metadata(name)["Requires-Python"] or "")
    return f'; python_version >= "{oldest[1]}"' if oldest else ""
