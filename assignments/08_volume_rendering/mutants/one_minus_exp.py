"""1 - exp(-x) loses all digits of a tiny x: np.expm1 keeps them."""

TASKS = ("08.1",)
LOSES = ("08.1.extremes",)
REPLACE = [("-np.expm1(-s)", "(1 - np.exp(-s))")]
