"""You turn directions by the inverse rotation, from the world into the camera."""

TASKS = ("09.2",)
LOSES = ("09.2.middle", "09.2.projected", "09.2.hidden")
REPLACE = [("rij,rj->ri", "rij,ri->rj")]
