"""`d[things] += rows` keeps the last row of each thing alone; all should add up: see np.add.at."""

TASKS = ("07.6",)
LOSES = ("07.6.cost", "07.6.differences", "07.6.hidden", "07.6.mean", "07.6.recover", "07.6.zero")
REPLACE = [
    (
        'np.add.at(d_base_color, both["thing"], by_color)',
        (
            'd_base_color[hit["thing"]] += by_color[:n]\n'
            '    d_base_color[hit["thing"]] += by_color[n:]'
        ),
    ),
    ('np.add.at(d_roughness, both["thing"], by_rough)', 'd_roughness[both["thing"]] += by_rough'),
]
