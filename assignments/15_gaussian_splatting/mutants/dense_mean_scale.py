"""The longest scale says whether a Gaussian is small: you ask the mean of the three."""

TASKS = ("15.6",)
LOSES = ("15.6.rows", "15.6.values", "15.6.most", "15.6.hidden")
REPLACE = [(".max(axis=1) <= SMALL", ".mean(axis=1) <= SMALL")]
