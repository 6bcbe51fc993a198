"""you ask only that the value does not rise, not for a part of the promised decrease"""

TASKS = ("01.6",)
LOSES = ("01.6.armijo",)
REPLACE = [("start + c * tau * slope", "start")]
