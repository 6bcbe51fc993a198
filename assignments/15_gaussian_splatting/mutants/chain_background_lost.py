"""The background has a derivative, too."""

TASKS = ("15.5",)
LOSES = ("15.5.differences", "15.5.hidden")
REPLACE = [('"background": d_background}', '"background": 0 * d_background}')]
