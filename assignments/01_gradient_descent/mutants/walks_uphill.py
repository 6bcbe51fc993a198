"""you accept a direction that does not lead downhill: raise ValueError"""

TASKS = ("01.6",)
LOSES = ("01.6.refuses",)
REPLACE = [("if not slope < 0.0:", "if slope > 1e300:")]
