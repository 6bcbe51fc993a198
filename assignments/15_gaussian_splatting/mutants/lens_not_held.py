"""Outside of the limits the slopes are those of the limit: you hold nothing."""

TASKS = ("15.2",)
LOSES = ("15.2.limits", "15.2.hidden")
REPLACE = [("h = np.clip(u, *limits(camera))", "h = u")]
