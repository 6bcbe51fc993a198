"""w comes first: you read (x, y, z, w)."""

TASKS = ("15.1",)
LOSES = ("15.1.axes", "15.1.differences", "15.1.hidden")
REPLACE = [("n[:, :1, None]", "n[:, 3:, None]"), ("CROSS, n[:, 1:])", "CROSS, n[:, :3])")]
