"""Your d_x has the opposite sign: the derivative of exp(-x) is -exp(-x)."""

TASKS = ("90.2",)
LOSES = ("90.2.differences", "90.2.cost")
REPLACE = [("-d_s * w * falling", "d_s * w * falling")]
