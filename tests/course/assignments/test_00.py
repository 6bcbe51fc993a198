"""Assignment 00 owes what every assignment owes, except size: it is there to try out the tools."""

from __future__ import annotations

import re

from course.assignments.support import ASSIGNMENTS, AssignmentTests, load_figures, names


class TestSetup(AssignmentTests):
    folder = ASSIGNMENTS / "00_setup"

    def test_there_are_enough_mutants_and_alternatives(self) -> None:
        assert len(names(self.folder, "mutants")) >= 5
        assert len(names(self.folder, "alternatives")) >= 3

    def test_the_handout_shows_every_figure_and_numbers_its_equations(self) -> None:
        text = (self.folder / "handout.md").read_text("utf-8")
        shown = set(re.findall(r"\(figures/(\w+)\.png\)", text))
        assert shown == set(load_figures(self.folder).FIGURES)
        assert "`loss_gradient" not in text  # the file says where to write, the handout what
        assert re.search(r"\\tag\{2\}", text)

    def test_papers_are_cited_by_a_key_of_the_bibliography(self) -> None:
        text = (self.folder / "handout.md").read_text("utf-8")
        assert not re.findall(r"\[([A-Z][A-Za-z]*\d{4}[a-z]?)[^\]]*\]", text)  # nothing to cite
