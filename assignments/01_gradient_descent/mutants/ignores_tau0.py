"""you begin at 1 whatever tau0 says"""

TASKS = ("01.6",)
LOSES = ("01.6.descends",)
REPLACE = [("tau, start = tau0, f(x)", "tau, start = 1.0, f(x)")]
