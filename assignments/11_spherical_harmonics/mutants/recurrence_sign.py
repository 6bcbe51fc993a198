"""The last term of the recurrence (7) is subtracted, not added."""

TASKS = ("11.1", "11.3")
LOSES = ("11.1.addition", "11.1.gram", "11.1.hidden", "11.3.hidden", "11.3.cost")
REPLACE = [(("* Q[ell - 1, m] - (ell + m - 1)"), ("* Q[ell - 1, m] + (ell + m - 1)"))]
