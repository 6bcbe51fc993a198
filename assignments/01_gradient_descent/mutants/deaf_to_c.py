"""you ask for a ten-thousandth of the promise whatever c says"""

TASKS = ("01.6",)
LOSES = ("01.6.armijo",)
REPLACE = [("c * tau * slope", "1e-4 * tau * slope")]
