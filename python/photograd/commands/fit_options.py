"""Options of `photograd fit`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, TypeAlias

import typer

from photograd._fit_options import BACKGROUNDS, DECODES, DENSITY_CONTROLS, MAX_DEGREE, FitOptions
from photograd.fields import fittable
from photograd.fitting.options import users_of
from photograd.transport.mesh_files import SUFFIXES as MESH_SUFFIXES


def _defaults(option: str) -> str:
    """The default of an option, and of what has one of its own."""
    others = ", ".join(
        f"{name}: {kind.fit_defaults[option]}"
        for name, kind in fittable().items()
        if option in kind.fit_defaults
    )
    return f"{getattr(FitOptions(), option)}; {others}"


def _users(option: str) -> str:
    return ", ".join(users_of(option))


RepresentationOption: TypeAlias = Annotated[
    str, typer.Option("--representation", help=f"How the scene is stored: {', '.join(fittable())}.")
]
StepsOption: TypeAlias = Annotated[
    int | None,
    typer.Option(
        "--steps", min=1, help="Steps of gradient descent.", show_default=_defaults("steps")
    ),
]
ResolutionOption: TypeAlias = Annotated[
    int | None,
    typer.Option(
        "--resolution",
        min=8,
        help="Voxels along the longest edge, or texels along that of a texture.",
        show_default=_defaults("resolution"),
    ),
]
RaysOption: TypeAlias = Annotated[
    int | None,
    typer.Option(
        "--rays",
        min=1,
        help="Rays a step; Gaussians take whole views.",
        show_default=_defaults("rays"),
    ),
]
LearningRateOption: TypeAlias = Annotated[
    float, typer.Option("--learning-rate", help="Factor on the built-in rates.")
]
TotalVariationOption: TypeAlias = Annotated[
    float,
    typer.Option("--total-variation", min=0.0, help="Weight of the smoothness prior of grids."),
]
DegreeOption: TypeAlias = Annotated[
    int | None,
    typer.Option(
        "--degree",
        min=0,
        max=MAX_DEGREE,
        show_default=_defaults("degree"),
        help=f"Degree of the harmonics of {_users('degree')}.",
    ),
]
PruneOption: TypeAlias = Annotated[
    float | None,
    typer.Option(
        "--prune",
        min=0.0,
        show_default=_defaults("prune"),
        help=f"Drop voxels of {_users('prune')} that weigh less in every pixel; 0: none.",
    ),
]
GaussiansOption: TypeAlias = Annotated[
    int, typer.Option("--gaussians", min=1, help="Most Gaussians that there may be.")
]
DensityControlOption: TypeAlias = Annotated[
    str, typer.Option("--density-control", help=f"Of Gaussians: {', '.join(DENSITY_CONTROLS)}.")
]
DecodeOption: TypeAlias = Annotated[
    str,
    typer.Option(
        "--decode",
        help=f"Of {_users('decode')}: {' or '.join(DECODES)}, where the network is evaluated.",
    ),
]
ImportanceOption: TypeAlias = Annotated[
    int,
    typer.Option(
        "--importance",
        min=0,
        help=f"Samples of a ray of {_users('importance')} by importance; 0: all evenly spaced.",
    ),
]
StartFromOption: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--start-from",
        help="Model on whose surfaces Gaussians begin, from whose voxels an octree is cut, that a "
        "plenoctree tabulates, that leaf_mlps are distilled from, whose voxels leaf_codes take, or "
        "whose Gaussians gaussian_codes take; "
        "or, for a textured_mesh, a textured_surface or a mesh, a mesh "
        "file with texture coordinates: "
        f"{', '.join(MESH_SUFFIXES)}.",
        metavar="MODEL",
    ),
]
FreezeOption: TypeAlias = Annotated[
    bool,
    typer.Option(
        "--freeze",
        help="Hold the structure once it is known, and report PSNR, bytes and the time of a frame "
        "then and at the end.",
    ),
]
BackgroundOption: TypeAlias = Annotated[
    str, typer.Option("--background", help=f"auto, {', '.join(BACKGROUNDS)}.")
]
CheckpointOption: TypeAlias = Annotated[
    float, typer.Option("--checkpoint-seconds", min=0.0, help="Time between checkpoints.")
]
AllowBlindOption: TypeAlias = Annotated[
    bool, typer.Option("--allow-blind", help="Fit even if some cameras do not see the scene.")
]
ViewOption: TypeAlias = Annotated[
    bool,
    typer.Option(
        "--view",
        help="Show the fit in a browser while it runs; needs the extra 'viewer'. It stays the "
        "same fit, to the bit.",
    ),
]
ResumeOption: TypeAlias = Annotated[
    bool, typer.Option("--resume", help="Continue the fit in --out; its options are kept.")
]
