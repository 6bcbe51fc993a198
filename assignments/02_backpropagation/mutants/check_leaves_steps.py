"""You do not put a coordinate back before moving the next one."""

TASKS = ("02.6",)
LOSES = ("02.6.accepts", "02.6.large", "02.6.rejects", "02.6.scale")
REPLACE = [("ahead, behind = x.copy(), x.copy()", "ahead, behind = x, x.copy()")]
