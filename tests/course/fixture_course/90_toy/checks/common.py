"""What the checks of several tasks share."""

from photograd_course.grading import Tolerance

ROUNDING = Tolerance(1e-12, "two orders of summation differ by 2e-16")
