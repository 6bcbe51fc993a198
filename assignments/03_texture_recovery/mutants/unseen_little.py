"""You call texels unseen that have little weight: only weight zero counts."""

TASKS = ("03.5",)
LOSES = ("03.5.unseen",)
REPLACE = [("weight[:, :, 0] == 0", "weight[:, :, 0] < 0.5")]
