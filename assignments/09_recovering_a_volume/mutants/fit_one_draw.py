"""All your steps see the same pixels: draw anew in each."""

TASKS = ("09.6",)
LOSES = ("09.6.draws", "09.6.hidden", "09.6.recovers")
REPLACE = [
    (
        ("    adam = Adam()\n    for step"),
        ("    adam, drawn = Adam(), draw(views, rng)\n    for step"),
    ),
    ("ray_batch(views, draw(views, rng))", "ray_batch(views, drawn)"),
]
