"""You read the pose as camera_from_world: its last column is the camera's place already."""

TASKS = ("09.2",)
LOSES = ("09.2.middle", "09.2.projected", "09.2.hidden")
REPLACE = [
    ("return pose[:, :3, 3],", 'return -np.einsum("rji,rj->ri", pose[:, :3, :3], pose[:, :3, 3]),')
]
