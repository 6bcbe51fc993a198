"""Your heights are not even: on a ball equal heights have equal areas, equal angles have not."""

TASKS = ("04.4",)
LOSES = ("04.4.chi", "04.4.mean", "04.4.hidden")
REPLACE = [
    ("z = 1 - u2[:, 0] * (1 + viewer[:, 2])", "z = np.cos(u2[:, 0] * np.arccos(-viewer[:, 2]))")
]
