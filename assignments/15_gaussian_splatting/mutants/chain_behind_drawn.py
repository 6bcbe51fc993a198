"""What lies behind the camera must be left out."""

TASKS = ("15.5",)
LOSES = ("15.5.behind", "15.5.hidden")
REPLACE = [
    (
        'drawn = depths(gaussians["means"], camera) > NEAR',
        'drawn = np.ones(len(gaussians["means"]), bool)',
    )
]
