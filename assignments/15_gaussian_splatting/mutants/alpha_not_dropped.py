"""Below ALPHA_MIN there is nothing: yours goes on."""

TASKS = ("15.3",)
LOSES = ("15.3.cuts", "15.3.hidden")
REPLACE = [("seen = raw >= ALPHA_MIN", "seen = raw >= 0")]
