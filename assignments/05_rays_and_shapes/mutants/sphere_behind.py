"""Places behind the origin are returned, with t below 0."""

TASKS = ("05.1",)
LOSES = ("05.1.misses", "05.1.hidden")
REPLACE = [
    (
        "return np.where((rest >= 0) & (t > T_MIN), t, np.inf)",
        "return np.where(rest >= 0, t, np.inf)",
    )
]
