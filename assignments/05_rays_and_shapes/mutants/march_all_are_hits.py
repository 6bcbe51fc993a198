"""Rays that give up count as having arrived."""

TASKS = ("05.4",)
LOSES = ("05.4.met", "05.4.cost", "05.4.hidden")
REPLACE = [("return found, d_t", "return np.where(np.isinf(found), t, found), d_t")]
