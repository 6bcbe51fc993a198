"""Outside of the limits only h is held: mean2d still moves."""

TASKS = ("15.2",)
LOSES = ("15.2.held", "15.2.hidden")
REPLACE = [
    ("f * d_mean2d + np.where(h == u, d_h, 0.0)", "np.where(h == u, f * d_mean2d + d_h, 0.0)")
]
