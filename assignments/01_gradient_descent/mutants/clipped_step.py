"""your steps are never longer than 1.5: Eq. (5) sets no such limit"""

TASKS = ("01.2",)
LOSES = ("01.2.basins",)
REPLACE = [("tau * df(float(x[k]))", "np.clip(tau * df(float(x[k])), -1.5, 1.5)")]
