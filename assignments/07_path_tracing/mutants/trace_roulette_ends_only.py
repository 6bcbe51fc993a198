"""Paths end by roulette, and the others get nothing for it."""

TASKS = ("07.5",)
LOSES = ("07.5.furnace",)
REPLACE = [
    (
        "beta, goes_on = roulette(beta, rng.random(len(live)))",
        "goes_on = roulette(beta, rng.random(len(live)))[1]",
    ),
]
