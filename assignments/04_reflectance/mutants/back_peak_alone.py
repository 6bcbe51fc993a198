"""Your derivative of D forgets that q depends on alpha: the tails must rise."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.hidden")
REPLACE = [("of_D = (4 * flat_h / (alpha**2 * q) - 2) / alpha", "of_D = -2 / alpha + 0 * q")]
