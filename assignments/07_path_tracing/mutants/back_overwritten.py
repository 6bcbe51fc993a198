"""A thing that is seen in several places gets the derivative of the last one; they add up."""

TASKS = ("07.6",)
LOSES = ()
REPLACE = [
    (
        'np.add.at(d_roughness, both["thing"], by_roughness)',
        'd_roughness[both["thing"]] = by_roughness',
    ),
]
