"""Your losses are those after each step: note each before it."""

TASKS = ("11.6",)
LOSES = ("11.6.first", "11.6.hidden")
REPLACE = [
    (
        ("            losses.append(value)\n"),
        ("            losses.append(loss_and_grad(density, coefficients, samples, target)[0])\n"),
    )
]
