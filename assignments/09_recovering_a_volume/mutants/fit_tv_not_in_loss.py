"""The losses that you note down lack total variation."""

TASKS = ("09.6",)
LOSES = ("09.6.first", "09.6.draws", "09.6.hidden")
REPLACE = [("losses[step] = loss + TV * roughness", "losses[step] = loss")]
