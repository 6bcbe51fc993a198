"""You render before black: the background belongs to the views."""

TASKS = ("09.6",)
LOSES = ("09.6.first", "09.6.draws", "09.6.falls", "09.6.hidden", "09.6.recovers")
REPLACE = [
    (
        "        loss, d_pixels = mse_and_cotangent(",
        ("        rays = (*rays[:5], np.zeros(3))\n        loss, d_pixels = mse_and_cotangent("),
    )
]
