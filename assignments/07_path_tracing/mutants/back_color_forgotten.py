"""The derivative by the base colour is that of one channel for all."""

TASKS = ("07.6",)
LOSES = ()
REPLACE = [
    (
        'np.add.at(d_base_color, both["thing"], by_color)',
        (
            'np.add.at(d_base_color, both["thing"], by_color.mean(axis=1, keepdims=True) + '
            "0 * by_color)"
        ),
    ),
]
