"""You take differences of the forward function, which costs a call for each parameter."""

TASKS = ("90.2",)
LOSES = ("90.2.cost",)
REPLACE = [
    (
        "    return d_s * falling, -d_s * w * falling\n",
        "    moves = np.eye(len(x)) * 1e-6\n"
        "    rise = [weighted_sum(w, x + m) - weighted_sum(w, x - m) for m in moves]\n"
        "    return d_s * falling, d_s * np.array(rise) / 2e-6\n",
    )
]
