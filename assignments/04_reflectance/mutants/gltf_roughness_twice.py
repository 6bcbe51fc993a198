"""You square the roughness before `ggx_lobe` does it again."""

TASKS = ("04.5",)
LOSES = ("04.5.straight", "04.5.mirror", "04.5.energy", "04.5.hidden")
REPLACE = [
    (
        "lobe = ggx_lobe(wo, wi, roughness)[:, None]",
        "lobe = ggx_lobe(wo, wi, roughness**2)[:, None]",
    )
]
