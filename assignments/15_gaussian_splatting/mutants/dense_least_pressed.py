"""Those under the highest pressure go first."""

TASKS = ("15.6",)
LOSES = ("15.6.most", "15.6.hidden")
REPLACE = [("np.argsort(-pressure, kind", "np.argsort(pressure, kind")]
