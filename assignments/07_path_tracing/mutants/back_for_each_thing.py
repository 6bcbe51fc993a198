"""All samples are gone through anew for each thing of the scene: far too dear."""

TASKS = ("07.6",)
LOSES = ("07.6.cost",)
REPLACE = [
    (
        'np.add.at(d_roughness, both["thing"], by_rough)',
        "pass",
    ),
]
