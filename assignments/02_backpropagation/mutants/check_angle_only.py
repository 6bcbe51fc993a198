"""You compare directions only; a gradient that is twice too large goes unseen."""

TASKS = ("02.6",)
LOSES = ("02.6.rejects", "02.6.scale")
REPLACE = [
    (
        """\
    error = float(np.linalg.norm(gradient - quotients))
    scale = max(float(np.linalg.norm(gradient)), float(np.linalg.norm(quotients)))
""",
        """\
    scale = float(np.linalg.norm(gradient) * np.linalg.norm(quotients))
    error = scale - float(gradient @ quotients)
""",
    )
]
