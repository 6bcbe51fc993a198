"""What is mirrored goes straight on."""

TASKS = ("05.3",)
LOSES = ("05.3.total", "05.3.hidden")
REPLACE = [("mirrored = along + cosine * normals", "mirrored = along - cosine * normals")]
