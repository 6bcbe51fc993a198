"""You mark the texels that were seen."""

TASKS = ("03.5",)
LOSES = ("03.5.unseen", "03.5.recovers")
REPLACE = [("weight[:, :, 0] == 0", "weight[:, :, 0] != 0")]
