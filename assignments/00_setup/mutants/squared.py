"""Your result still holds the square itself."""

TASKS = ("00.1",)
LOSES = ("00.1.differences", "00.1.step")
REPLACE = [
    (
        "2.0 * (picture - photograph) / picture.size",
        "2.0 * (picture - photograph) ** 2 / picture.size",
    )
]
