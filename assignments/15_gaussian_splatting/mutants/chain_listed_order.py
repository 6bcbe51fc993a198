"""You blend in the order of the list: depths sort."""

TASKS = ("15.5",)
LOSES = ("15.5.one", "15.5.hidden")
REPLACE = [
    (
        'composite(alpha, part["colors"], depth, background)',
        'composite(alpha, part["colors"], np.arange(len(depth)) + 0.0, background)',
    )
]
