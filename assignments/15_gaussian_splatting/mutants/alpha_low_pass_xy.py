"""LOW_PASS belongs to xx and yy alone: it is a round blur."""

TASKS = ("15.3",)
LOSES = ("15.3.round", "15.3.ellipse", "15.3.cuts", "15.3.hidden")
REPLACE = [("[LOW_PASS, 0, LOW_PASS]", "[LOW_PASS, LOW_PASS, LOW_PASS]")]
