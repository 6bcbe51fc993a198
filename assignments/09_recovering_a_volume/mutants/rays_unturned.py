"""Your directions are still in the camera's frame: turn them into the world."""

TASKS = ("09.2",)
LOSES = ("09.2.middle", "09.2.projected", "09.2.hidden")
REPLACE = [('np.einsum("rij,rj->ri", pose[:, :3, :3], aim)', "aim")]
