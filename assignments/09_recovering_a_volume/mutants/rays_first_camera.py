"""All your rays come from the first camera: each photograph has its own."""

TASKS = ("09.2",)
LOSES = ("09.2.middle", "09.2.projected", "09.2.hidden")
REPLACE = [('views["world_from_camera"][view]', 'views["world_from_camera"][0 * view]')]
