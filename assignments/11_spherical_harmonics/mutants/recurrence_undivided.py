"""The recurrence (7) is not divided by l - m."""

TASKS = ("11.1", "11.3")
LOSES = ("11.1.addition", "11.1.gram", "11.1.hidden", "11.3.vectors", "11.3.hidden", "11.3.cost")
REPLACE = [(("                ell - m\n            )"), ("                1\n            )"))]
