"""The place of a splat pulls at the mean: d_mean2d is lost on the way."""

TASKS = ("15.5",)
LOSES = ("15.5.differences", "15.5.hidden")
REPLACE = [("lens_back(d_mean2d, d_cov2d)", "lens_back(0 * d_mean2d, d_cov2d)")]
