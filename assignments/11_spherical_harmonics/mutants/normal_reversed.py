"""Your irradiance is that of the other side of the surface."""

TASKS = ("11.5",)
LOSES = ("11.5.lambert", "11.5.hidden")
REPLACE = [
    (
        ('    return np.einsum("nk,k,nkc->nc", sh_basis(normals, degree), lobe, blended)\n'),
        ('    return np.einsum("nk,k,nkc->nc", sh_basis(-normals, degree), lobe, blended)\n'),
    )
]
