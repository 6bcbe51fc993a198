"""Draw the figures of assignments' handouts anew.

Usage: course_figures.py NN...
"""

from __future__ import annotations

import sys

from photograd_course.assignment.bundle import read_folder
from photograd_course.assignment.load import load_figure_script
from photograd_course.build.kits import match_folder, source_folders
from photograd_course.viz.handout import save_figures
from photograd_course.viz.style import HANDOUT_DPI


def main() -> None:
    """Draw what the command line names."""
    folders = source_folders()
    for number in sys.argv[1:]:
        folder = folders[match_folder(number, list(folders))]
        script = load_figure_script(folder)
        dpi = getattr(script, "DPI", HANDOUT_DPI)
        solution = read_folder(folder).reference
        for path in save_figures(script.FIGURES, solution, folder / "figures", dpi):
            print(path)


if __name__ == "__main__":
    main()
