"""You read camera_from_world as its inverse: t = W p + b."""

TASKS = ("15.2",)
LOSES = (
    "15.2.means",
    "15.2.sampled",
    "15.2.limits",
    "15.2.differences",
    "15.2.held",
    "15.2.hidden",
)
REPLACE = [
    (
        't = means @ W.T + camera["camera_from_world"][:, 3]',
        't = (means - camera["camera_from_world"][:, 3]) @ W',
    )
]
