"""The part along the normal stays as it was: right for small angles only."""

TASKS = ("05.3",)
LOSES = ("05.3.snell", "05.3.back", "05.3.hidden")
REPLACE = [
    (
        "bent = along / ratio - side * np.sqrt(np.abs(square)) * normals",
        "bent = along / ratio - cosine * normals",
    )
]
