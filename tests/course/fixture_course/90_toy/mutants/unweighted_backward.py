"""Your d_x equals the one without the weights."""

TASKS = ("90.2",)
LOSES = ("90.2.differences", "90.2.cost")
REPLACE = [("-d_s * w * falling", "-d_s * falling")]
