"""You divide by the length of the differences alone, not by the longer of both."""

TASKS = ("02.6",)
LOSES = ("02.6.rejects",)
REPLACE = [
    (
        "scale = max(float(np.linalg.norm(gradient)), float(np.linalg.norm(quotients)))",
        "scale = float(np.linalg.norm(quotients))",
    )
]
