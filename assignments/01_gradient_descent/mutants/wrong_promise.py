"""the bound rises with tau: the slope along d is negative, and is added"""

TASKS = ("01.6",)
LOSES = ("01.6.armijo",)
REPLACE = [("start + c * tau * slope", "start - c * tau * slope")]
