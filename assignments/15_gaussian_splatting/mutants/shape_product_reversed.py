"""Your product is M^T M: it forgets the rotation."""

TASKS = ("15.1",)
LOSES = ("15.1.axes", "15.1.differences", "15.1.hidden")
REPLACE = [("return M @ M.swapaxes(1, 2), back", "return M.swapaxes(1, 2) @ M, back")]
