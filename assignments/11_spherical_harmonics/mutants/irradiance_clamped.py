"""You cut irradiance off at zero: it is linear in the coefficients."""

TASKS = ("11.5",)
LOSES = ("11.5.lambert", "11.5.hidden")
REPLACE = [
    (
        ('    return np.einsum("nk,k,nkc->nc", sh_basis(normals, degree), lobe, blended)\n'),
        (
            '    return np.maximum(0, np.einsum("nk,k,nkc->nc", sh_basis(normals, degree), '
            "lobe, blended))\n"
        ),
    )
]
