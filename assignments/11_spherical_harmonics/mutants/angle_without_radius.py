"""Your waves are cos m phi and sin m phi, without the factor sin^m theta."""

TASKS = ("11.1",)
LOSES = ("11.1.first", "11.1.addition", "11.1.gram", "11.1.hidden")
REPLACE = [
    (
        ("    even, odd, Q = _pieces(directions, degree)\n"),
        (
            "    even, odd, Q = _pieces(directions, degree)\n"
            "    radius = np.hypot(*directions[:, :2].T) + 1e-300\n"
            "    even = [wave / radius**m for m, wave in enumerate(even)]\n"
            "    odd = [wave / radius**m for m, wave in enumerate(odd)]\n"
        ),
    )
]
