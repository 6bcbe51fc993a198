"""A box behind the origin is missed: compare t_far with the t_near that starts at 0."""

TASKS = ("08.3",)
LOSES = ("08.3.inside", "08.3.hidden")
REPLACE = [("hit = t_near < t_far", "hit = enter.max(axis=1) < t_far")]
