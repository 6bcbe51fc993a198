"""d_values[row] += adds once where a row occurs twice: all of them must add up."""

TASKS = ("10.4",)
LOSES = (
    "10.4.transpose",
    "10.4.picture",
    "10.4.hidden",
)
REPLACE = [
    ("np.add.at(d_values, row[known], parts[known])", "d_values[row[known]] += parts[known]"),
]
