"""Your cap is the upper half of the ball: it reaches down to z = -v_z."""

TASKS = ("04.4",)
LOSES = ("04.4.chi", "04.4.mean", "04.4.hidden")
REPLACE = [("z = 1 - u2[:, 0] * (1 + viewer[:, 2])", "z = 1 - u2[:, 0]")]
