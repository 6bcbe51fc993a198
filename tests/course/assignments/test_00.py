"""Assignment 00 owes what every assignment owes, except size: it is there to try out the tools."""

from __future__ import annotations

import re

from course.assignments.support import (
    ASSIGNMENTS,
    AssignmentTests,
    judge,
    load_figures,
    lost,
    names,
    source,
)


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

    def test_a_function_that_is_right_on_its_first_call_only_earns_nothing(self) -> None:
        text = source(self.folder)
        right = "return 2.0 * (picture - photograph) / picture.size"
        assert text.count(right) == 1
        once = "loss.calls = getattr(loss, 'calls', 0) + 1\n    " + right.replace(
            "2.0", "2.0 * (loss.calls == 1)"
        )
        wrong = judge(self.folder, text.replace(right, once), tasks=("00.1",))
        assert lost(wrong) == {"00.1.differences", "00.1.step", "00.1.hidden"}
