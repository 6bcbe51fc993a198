"""cov = M M^T holds M twice: your d_M has one of the two terms."""

TASKS = ("15.1",)
LOSES = ("15.1.differences", "15.1.hidden")
REPLACE = [("(d_cov + d_cov.swapaxes(1, 2)) @ M", "d_cov @ M")]
