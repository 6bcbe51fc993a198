"""Notebooks of explorations, run as Jupyter runs them: pictures below the cell, edited modules."""

from __future__ import annotations

import base64
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from course.student.explored import NUMBERS, TINY, finished_kit, with_options

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")

THREADS = """\
import threadpoolctl
print("threads", {each["num_threads"] for each in threadpoolctl.threadpool_info()})"""


def notebook(folder: Path, **changed: int) -> Any:
    """The folder's notebook, with other options, as a student types them into the cell."""
    book = nbformat.read(folder / "explore.ipynb", as_version=4)
    for cell in book.cells:
        if cell.cell_type == "code" and "explore.options(" in cell.source:
            cell.source = with_options(cell.source, changed)
    return book


def run(book: Any, folder: Path) -> Any:
    client = nbclient.NotebookClient(
        book, timeout=600, kernel_name="python3", resources={"metadata": {"path": str(folder)}}
    )
    return client.execute()


def pictures(cell: Any) -> list[np.ndarray]:
    """Gray levels of the PNG pictures below a cell."""
    found = [
        each.data["image/png"]
        for each in cell.get("outputs", [])
        if "image/png" in each.get("data", {})
    ]
    opened = [Image.open(BytesIO(base64.b64decode(data))).convert("L") for data in found]
    return [np.asarray(image, dtype=float) for image in opened]


def printed(cell: Any) -> str:
    return "".join(each.text for each in cell.outputs if each.output_type == "stream")


@pytest.mark.parametrize("number", NUMBERS)
def test_pictures_appear_below_the_cell_that_makes_them(number: str, tmp_path: Path) -> None:
    """And linear algebra has one thread, and the files are written as well."""
    folder = finished_kit(number, tmp_path)
    book = notebook(folder, **TINY.get(number, {}))
    book.cells.append(nbformat.v4.new_code_cell(THREADS))
    done = run(book, folder)
    assert printed(done.cells[-1]) == "threads {1}\n"
    for cell in (each for each in done.cells if each.cell_type == "code"):
        made = cell.source.count("explore.keep_picture(figure")
        is_inactive = "if given.capture" in cell.source or "if capture:" in cell.source
        assert len(pictures(cell)) == 0 if is_inactive else len(pictures(cell)) >= min(made, 1)
    shown = [picture for cell in done.cells for picture in pictures(cell)]
    assert shown
    assert all(picture.std() > 5.0 for picture in shown)
    assert len([*folder.rglob("*.png")]) > len([*(folder / "figures").glob("*.png")])


def test_an_edited_module_is_read_again_before_the_next_cell(tmp_path: Path) -> None:
    """With what it takes from another edited file, and with the options that were set in it."""
    (tmp_path / "earlier.py").write_text("def value():\n    return 1\n", encoding="utf-8")
    own = "from earlier import value\nSTEPS = 10\ndef told():\n    return value(), STEPS, 'a'\n"
    (tmp_path / "nerf.py").write_text(own, encoding="utf-8")
    cells = [
        "from photograd_course import explore\ngiven = explore.options(steps=20)",
        "import nerf as mine\nexplore.set_constants(mine, STEPS=given.steps)",
        "from pathlib import Path\n"
        "def edit(name, old, new):\n"
        "    path = Path(name)\n"
        "    path.write_text(path.read_text('utf-8').replace(old, new), encoding='utf-8')\n"
        "print(mine.told())",
        "edit('nerf.py', \"'a'\", \"'b'\")",
        "print(mine.told())",
        "edit('earlier.py', '1', '2')",
        "print(mine.told())",
        "edit('nerf.py', \"'b'\", \"'c\")",  # a sentence that Python cannot read
        "print(mine.told())",
        "edit('nerf.py', \"'c\", \"'d'\")",
        "print(mine.told())",
    ]
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(each) for each in cells])
    done = run(book, tmp_path)
    told = [line for cell in done.cells for line in printed(cell).splitlines() if line[:1] == "("]
    assert told == ["(1, 20, 'a')", "(1, 20, 'b')", "(2, 20, 'b')", "(2, 20, 'b')", "(2, 20, 'd')"]
    assert "nerf.py cannot be read again, the last version runs: Syntax" in printed(done.cells[8])


def test_options_are_the_numbers_of_the_cell(tmp_path: Path) -> None:
    """The command line of a notebook's process is Jupyter's; a wrong number is refused."""
    cells = [
        "from photograd_course import explore\nprint(vars(explore.options(steps=7, tv=0.5)))",
        "try:\n    explore.options(steps=0)\nexcept ValueError as error:\n    print(error)",
        "from pathlib import Path\n"
        "Path('explore.py').write_text('from photograd_course import explore\\n'\n"
        "    'print(explore.options(steps=7).steps)\\n')",
        "%run explore.py --steps 9",
    ]
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(each) for each in cells])
    done = run(book, tmp_path)
    assert printed(done.cells[0]) == "{'steps': 7, 'tv': 0.5}\n"
    assert printed(done.cells[1]) == (
        "explore.py: --steps: expected a whole number of 1 or more, got 0\n"
    )
    assert printed(done.cells[3]) == "9\n"


@pytest.mark.parametrize("number", NUMBERS)
def test_a_notebook_begins_with_what_is_graded_and_how_to_install(
    number: str, tmp_path: Path
) -> None:
    folder = finished_kit(number, tmp_path)
    title, graded, install = notebook(folder).cells[:3]
    assert title.source.startswith("# ")
    assert graded.source.startswith("**Graded is `")
    assert all(name in graded.source for name in (".py`, not this notebook", "Colab", "%cd"))
    assert install.source.startswith("import importlib.util")
    assert "%pip install --quiet photograd_course-*.whl" in install.source
