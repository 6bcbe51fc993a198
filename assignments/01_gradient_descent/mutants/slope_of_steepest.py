"""you promise minus the squared gradient: for any other d the slope is grad . d"""

TASKS = ("01.6",)
LOSES = ("01.6.armijo",)
REPLACE = [("start + c * tau * slope", "start - c * tau * float(grad(x) @ grad(x))")]
