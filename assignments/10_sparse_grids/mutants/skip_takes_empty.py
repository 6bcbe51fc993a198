"""Samples in empty leaves are taken, those in full ones skipped."""

TASKS = ("10.2",)
LOSES = ("10.2.samples", "10.2.faces", "10.2.cost", "10.2.hidden")
REPLACE = [("within & full[:, None]", "within & ~full[:, None]")]
