"""Your cosine lobe is half as strong as it should be: the integral runs around the circle, 2 pi."""

TASKS = ("11.5",)
LOSES = ("11.5.constant", "11.5.lambert", "11.5.hidden")
REPLACE = [
    (
        ("    lobe = np.pi * np.array([1, 2 / 3, 1 / 4, 0, -1 / 24])\n"),
        ("    lobe = np.pi / 2 * np.array([1, 2 / 3, 1 / 4, 0, -1 / 24])\n"),
    )
]
