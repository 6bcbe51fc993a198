"""What lies behind the origin is met as if it lay ahead."""

TASKS = ("05.1",)
LOSES = ("05.1.misses", "05.1.hidden")
REPLACE = [
    (
        "return np.where((rest >= 0) & (t > T_MIN), t, np.inf)",
        "return np.where(rest >= 0, np.abs(t), np.inf)",
    )
]
