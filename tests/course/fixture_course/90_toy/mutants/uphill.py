"""You walk uphill: the step is taken away from x, not added."""

TASKS = ("90.3",)
LOSES = ("90.3.services",)
REPLACE = [("- tau * gradient", "+ tau * gradient")]
