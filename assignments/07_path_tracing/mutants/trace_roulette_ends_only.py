"""Paths end by roulette, and the others get nothing for it."""

TASKS = ("07.5",)
LOSES = ("07.5.furnace",)
REPLACE = [
    (
        "beta, _ = roulette(beta, rng.random(len(live)))",
        "beta = beta * roulette(beta, rng.random(len(live)))[1][:, None]",
    )
]
