"""You compare the lengths of the two gradients; a wrong direction goes unseen."""

TASKS = ("02.6",)
LOSES = ("02.6.rejects",)
REPLACE = [
    (
        "np.linalg.norm(gradient - quotients))",
        "abs(np.linalg.norm(gradient) - np.linalg.norm(quotients)))",
    )
]
