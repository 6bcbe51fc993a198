"""What things emit straight to the viewer is missing."""

TASKS = ("07.5",)
LOSES = ("07.5.emitted", "07.5.furnace", "07.5.hidden", "07.5.integral")
REPLACE = [("radiance = emitted(scene, hit)\n", "radiance = 0 * emitted(scene, hit)\n")]
