"""The root is left out of the part along the normal: the length is not 1."""

TASKS = ("05.3",)
LOSES = ("05.3.snell", "05.3.back", "05.3.hidden")
REPLACE = [
    (
        "bent = along / ratio - side * np.sqrt(np.abs(square)) * normals",
        "bent = along / ratio - side * square * normals",
    )
]
