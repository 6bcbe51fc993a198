"""All samples are wanted; those in empty leaves are not."""

TASKS = ("10.2",)
LOSES = ("10.2.samples", "10.2.faces", "10.2.cost", "10.2.hidden")
REPLACE = [("within & full[:, None]", "within")]
