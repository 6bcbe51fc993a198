"""Children stand in the order a + 2 b + 4 c; it is 4 a + 2 b + c."""

TASKS = ("10.1",)
LOSES = ("10.1.cells", "10.1.hidden")
REPLACE = [("for up in upper)", "for up in upper[::-1])")]
