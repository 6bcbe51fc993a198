"""Your adjoint walks all later steps anew for each step: right, but far too dear."""

TASKS = ("08.2",)
LOSES = ("08.2.cost",)
REPLACE = [
    (
        (
            "        left = left - weight * v\n"
            "        d_sigma[:, k] = dt[:, k] * (after * v - left)\n"
        ),
        (
            "        hides, reach = end * (d_pixel @ background + d_T_end), after\n"
            "        for later in range(k + 1, sigma.shape[1]):\n"
            "            depth = sigma[:, later] * dt[:, later]\n"
            "            hides = hides + reach * -np.expm1(-depth) * np.sum(color[:, "
            "later] * d_pixel, axis=1)\n"
            "            reach = reach * np.exp(-depth)\n"
            "        d_sigma[:, k] = dt[:, k] * (after * v - hides)\n"
        ),
    )
]
