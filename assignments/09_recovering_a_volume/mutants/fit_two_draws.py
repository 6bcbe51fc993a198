"""You draw twice in a step."""

TASKS = ("09.6",)
LOSES = ("09.6.draws", "09.6.hidden")
REPLACE = [
    (
        "ray_batch(views, draw(views, rng))",
        "ray_batch(views, draw(views, rng) if draw(views, rng) is not None else None)",
    )
]
