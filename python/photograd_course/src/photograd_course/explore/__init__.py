"""What the scripts and notebooks that students play with share.

An exploration imports this package first: NumPy then starts with one thread for linear algebra, as
in `photograd course check` and in the grader, however the exploration is started. In a notebook
pictures appear below the cell, and an edited file of the student is read again before each cell.
"""

from __future__ import annotations

from . import one_thread

one_thread.use_one_thread()  # before anything below loads NumPy

from .options import Option, at_least, between, existing, introduction, options, same_as  # noqa: E402
from .other_code import by_the_core, set_constants  # noqa: E402
from .pictures import figure_1, keep_picture, show_file  # noqa: E402
from .progress import Progress, count_calls  # noqa: E402
from .reloading import watch_own_modules  # noqa: E402
from .stopwatch import Stopwatch  # noqa: E402

__all__ = [
    "Option",
    "Progress",
    "Stopwatch",
    "at_least",
    "between",
    "by_the_core",
    "count_calls",
    "existing",
    "figure_1",
    "introduction",
    "keep_picture",
    "options",
    "same_as",
    "set_constants",
    "show_file",
]

watch_own_modules()
