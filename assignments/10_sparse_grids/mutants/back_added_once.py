"""A row that occurs twice gets only its last contribution: `d[row] += ...` does not add up."""

TASKS = ("10.4",)
LOSES = ("10.4.transpose", "10.4.picture", "10.4.hidden")
REPLACE = [
    ("np.add.at(d_values, row[known], parts[known])", "d_values[row[known]] += parts[known]")
]
