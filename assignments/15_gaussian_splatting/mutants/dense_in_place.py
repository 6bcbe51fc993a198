"""The arrays that you were given stay as they are: copy the logits."""

TASKS = ("15.6",)
LOSES = ("15.6.rows",)
REPLACE = [('logits = gaussians["opacity_logits"].copy()', 'logits = gaussians["opacity_logits"]')]
