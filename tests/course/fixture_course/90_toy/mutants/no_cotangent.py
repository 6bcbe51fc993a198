"""Your derivatives lack the incoming derivative d_s."""

TASKS = ("90.2",)
LOSES = ("90.2.differences", "90.2.cost")
REPLACE = [("return d_s * falling, -d_s * w * falling", "return falling, -w * falling")]
