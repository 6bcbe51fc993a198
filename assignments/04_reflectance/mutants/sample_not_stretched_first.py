"""You do not stretch the viewer's direction before you draw."""

TASKS = ("04.4",)
LOSES = ("04.4.chi", "04.4.mean", "04.4.hidden")
REPLACE = [("    viewer = wo * stretch\n", "    viewer = wo * 1.0\n")]
