"""Where the direction is 0 the origin may be beside the box, unnoticed."""

TASKS = ("05.6",)
LOSES = ("05.6.cost", "05.6.growth")
REPLACE = [("if ((origin < low) | (origin > high))[~moves].any():", "if False:")]
