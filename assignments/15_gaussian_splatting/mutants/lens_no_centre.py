"""The camera's centre is missing in mean2d."""

TASKS = ("15.2",)
LOSES = ("15.2.means", "15.2.limits", "15.2.hidden")
REPLACE = [('return f * u + camera["centre"], S', "return f * u, S")]
