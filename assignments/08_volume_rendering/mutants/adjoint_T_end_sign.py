"""More extinction makes T_end smaller: its part of d_sigma has the wrong sign."""

TASKS = ("08.2",)
LOSES = ("08.2.differences", "08.2.background", "08.2.walls", "08.2.hidden", "08.2.cost")
REPLACE = [("+ end * d_T_end", "- end * d_T_end")]
