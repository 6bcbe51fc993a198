"""All light is mirrored."""

TASKS = ("05.3",)
LOSES = ("05.3.snell", "05.3.hidden")
REPLACE = [("np.where(through, bent, mirrored)", "mirrored")]
