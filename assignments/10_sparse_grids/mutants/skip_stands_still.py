"""A ray stands still: on a face m is 0, see the 1 in equation (8)."""

TASKS = ("10.2",)
LOSES = ("10.2.faces",)
REPLACE = [("for _ in range(count):", "while len(live):"), ("np.maximum(jump, 1)", "jump")]
