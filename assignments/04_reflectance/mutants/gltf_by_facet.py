"""The angle of your Fresnel factor is that between normal and half vector: it is the viewer's to the half vector."""

TASKS = ("04.5",)
LOSES = ("04.5.mirror", "04.5.energy", "04.5.hidden",)
REPLACE = [
    ('cos = np.sum(wo * half_vector(wo, wi), axis=1)[:, None]\n    F = schlick(0.04, cos)\n    ground', 'cos = half_vector(wo, wi)[:, 2:]\n    F = schlick(0.04, cos)\n    ground'),
]
