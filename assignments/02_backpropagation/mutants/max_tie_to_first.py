"""At a tie your maximum gives the slope to the first input: >= in the place of >."""

TASKS = ("02.2",)
LOSES = ("02.2.tie",)
REPLACE = [("self.data > other.data", "self.data >= other.data")]
