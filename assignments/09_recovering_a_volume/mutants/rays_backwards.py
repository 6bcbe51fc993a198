"""The camera looks along its +z: yours looks along -z."""

TASKS = ("09.2",)
LOSES = ("09.2.middle", "09.2.projected", "09.2.hidden")
REPLACE = [("np.ones(len(chosen))]", "-np.ones(len(chosen))]")]
