"""2 G M holds for symmetric d_cov only: each of the nine numbers counts by itself."""

TASKS = ("15.1",)
LOSES = ("15.1.differences", "15.1.hidden")
REPLACE = [("(d_cov + d_cov.swapaxes(1, 2)) @ M", "2 * d_cov @ M")]
