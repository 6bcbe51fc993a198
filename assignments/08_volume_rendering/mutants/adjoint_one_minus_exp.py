"""1 - exp(-x) loses all digits of a tiny x: np.expm1 keeps them."""

TASKS = ("08.2",)
LOSES = ("08.2.walls",)
REPLACE = [("weight, after = T * -np.expm1(-tau),", "weight, after = T * (1 - np.exp(-tau)),")]
