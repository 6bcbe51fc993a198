from __future__ import annotations

import ast

import pytest
from photograd_course.build.markers import RegionError
from photograd_course.build.regions import find_regions, solution_parts, strip_solution

MODULE = '''\
"""Doc."""


class Value:
    """A value."""

    def exp(self):
        """Its exponential."""
        # >>> solution 02.3
        return helper(self)
        # <<< solution


# >>> solution 02.3
def helper(value):
    return value


# <<< solution
def plain(x):
    y = x
    # >>> solution 02.1
    return y + 1
    # <<< solution
    # >>> student
    # z = ...  # your line
    # raise NotImplementedError("02.1 plain")
    # <<< student
'''


def test_a_solution_becomes_an_exception_that_names_task_function_and_section() -> None:
    starter = strip_solution(MODULE)
    wanted = 'raise NotImplementedError("02.3 Value.exp: see the handout, section 3")'
    assert f'        """Its exponential."""\n        {wanted}\n' in starter
    compile(starter, "starter", "exec")


def test_a_student_block_stands_in_for_the_solution_above_it() -> None:
    starter = strip_solution(MODULE)
    text = '    y = x\n    z = ...  # your line\n    raise NotImplementedError("02.1 plain")\n'
    assert starter.endswith(text)


def test_a_helper_at_module_level_vanishes() -> None:
    starter = strip_solution(MODULE)
    assert "helper" not in starter
    assert {n.name for n in ast.parse(starter).body if hasattr(n, "name")} == {"Value", "plain"}


def test_parts_of_the_solution() -> None:
    parts = solution_parts(MODULE)
    assert [(part.task, part.function) for part in parts] == [
        ("02.3", "Value.exp"),
        ("02.3", ""),
        ("02.1", "plain"),
    ]
    assert parts[0].text == "        return helper(self)\n"


def test_markers_inside_of_strings_mean_nothing() -> None:
    text = 'a = """\n# >>> solution 01.1\n# <<< nonsense\n"""\nb = "# >>> student"\n'
    assert find_regions(text) == ()
    assert strip_solution(text) == text


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("# >>> solution 01.1\na = 1\n", 1),  # no end
        ("a = 1\n# <<< solution\n", 2),  # no begin
        ("# >>> solution 01.1\n# >>> solution 01.2\n", 2),  # nested
        ("# >>> solution 01.1\na = 1\n# <<< student\n", 3),  # another's end
        ("a = 1\n# >>> solutoin 01.1\n", 2),  # misspelt
        ("# >>> solution\n", 1),  # of which task?
        ("#>>> solution 01.1\n", 1),  # no space
        ("# >>> student 01.1\n", 1),  # no task is meant here
        ("a = 1  # >>> solution 01.1\n", 1),  # not alone on its line
        ("a = 1\n# <<< solution 01.1\n", 2),  # the end names no task
        ("# >>> solution 01.1\n# <<< solution\n", 1),  # nothing in it
        ("a = 1\n# >>> student\n# a = 2\n# <<< student\n", 2),  # below no solution
        ("# >>> solution 01.1\na = 1\n# <<< solution\n# >>> student\nb = 2\n# <<< student\n", 5),
        ("a = = 1\n", 1),  # no Python
    ],
)
def test_a_wrong_marker_is_refused_with_file_and_line(text: str, line: int) -> None:
    with pytest.raises(RegionError, match=rf"descent\.py, line {line}: expected"):
        strip_solution(text, "descent.py")
