"""The thing in the middle of each cut is in neither half."""

TASKS = ("05.5",)
LOSES = ("05.5.boxes", "05.5.halves", "05.5.axis", "05.5.hidden")
REPLACE = [("(half, stop)]", "(half + 1, stop)]")]
