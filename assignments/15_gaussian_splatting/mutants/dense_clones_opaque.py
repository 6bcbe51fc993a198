"""Two of the old opacity cover more than one: thin them."""

TASKS = ("15.6",)
LOSES = ("15.6.values", "15.6.hidden")
REPLACE = [(("    logits[clone] = np.log(np.sqrt(1 + np.exp(logits[clone])) - 1)\n"), "")]
