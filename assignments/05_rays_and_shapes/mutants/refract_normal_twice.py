"""The part along the surface still holds some of the normal."""

TASKS = ("05.3",)
LOSES = ("05.3.snell", "05.3.back", "05.3.total", "05.3.hidden")
REPLACE = [("along = directions + cosine * normals", "along = directions + 2 * cosine * normals")]
