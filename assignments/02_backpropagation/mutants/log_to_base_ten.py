"""Your logarithm is the one to base ten; its slope is that of the natural one."""

TASKS = ("02.3", "02.5")
LOSES = ("02.3.log", "02.3.many", "02.5.expressions", "02.5.random")
REPLACE = [("math.log(self.data)", "math.log10(self.data)")]
