"""Directions are drawn by the proposal, and divided by the density of the scene."""

TASKS = ("07.3",)
LOSES = ("07.3.hidden", "07.3.proposal")
REPLACE = [("by_surface = brdf_pdf(drawn_by, hit, way)", "by_surface = brdf_pdf(scene, hit, way)")]
