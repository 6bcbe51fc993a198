"""You compare directions only; a gradient that is twice too large goes unseen."""

TASKS = ("02.6",)
LOSES = ("02.6.rejects", "02.6.scale")
REPLACE = [
    (
        """\
    error = float(np.linalg.norm(gradient - differences))
    scale = max(float(np.linalg.norm(gradient)), float(np.linalg.norm(differences)))
""",
        """\
    scale = float(np.linalg.norm(gradient) * np.linalg.norm(differences))
    error = scale - float(gradient @ differences)
""",
    ),
]
