"""You add the camera's place to the direction: (6) for a direction has no o."""

TASKS = ("09.2",)
LOSES = ("09.2.middle", "09.2.projected", "09.2.hidden")
REPLACE = [("pose[:, :3, :3], aim), pictures", "pose[:, :3, :3], aim) + pose[:, :3, 3], pictures")]
