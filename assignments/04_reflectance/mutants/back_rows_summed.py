"""Your d_roughness is the sum of all rows: each row has its own roughness."""

TASKS = ("04.6",)
LOSES = ("04.6.differences", "04.6.straight", "04.6.hidden")
REPLACE = [
    (
        ("d_f * by_color[:, None], np.sum(d_f * (metal - dielectric), axis=1), d_roughness"),
        (
            "d_f * by_color[:, None], np.sum(d_f * (metal - dielectric), axis=1),"
            " d_roughness * 0 + d_roughness.sum()"
        ),
    )
]
