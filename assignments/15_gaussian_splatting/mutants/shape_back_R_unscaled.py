"""M = R diag(s): d_R has the factor s."""

TASKS = ("15.1",)
LOSES = ("15.1.differences", "15.1.hidden")
REPLACE = [("d_R = 2 * d_M * s", "d_R = 2 * d_M")]
