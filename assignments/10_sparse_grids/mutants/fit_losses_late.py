"""Losses are those of the points that steps end at, not start from."""

TASKS = ("10.6",)
LOSES = ("10.6.first", "10.6.hidden")
REPLACE = [("losses.append(value)", "losses.append(loss_and_grad(values, samples, target)[0])")]
