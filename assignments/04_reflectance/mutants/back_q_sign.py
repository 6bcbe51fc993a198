"""The part of q has the wrong sign: the tails rise with roughness."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.hidden")
REPLACE = [
    (
        "of_D = (4 * flat_h / (alpha**2 * q) - 2) / alpha",
        "of_D = (-4 * flat_h / (alpha**2 * q) - 2) / alpha",
    )
]
