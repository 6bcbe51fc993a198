"""The centre is added to the origins; it is to be subtracted."""

TASKS = ("05.1",)
LOSES = ("05.1.outside", "05.1.inside", "05.1.misses", "05.1.hidden")
REPLACE = [("origins - center", "origins + center")]
