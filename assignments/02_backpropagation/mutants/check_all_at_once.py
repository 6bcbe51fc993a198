"""You move all coordinates at once; each partial derivative moves one."""

TASKS = ("02.6",)
LOSES = ("02.6.accepts", "02.6.large", "02.6.rejects", "02.6.scale")
REPLACE = [("ahead[i] += step", "ahead += step"), ("behind[i] -= step", "behind -= step")]
