"""The options of `photograd fit`, with their help."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, TypeAlias

import typer

from photograd.fitting.options import (
    BACKGROUNDS,
    DEFAULTS_OF,
    DENSITY_CONTROLS,
    MOST_DEGREE,
    USERS_OF,
    FitOptions,
)
from photograd.fitting.start import FITTED


def _defaults(option: str) -> str:
    """The default of an option, and of what has one of its own."""
    others = ", ".join(
        f"{name}: {given[option]}" for name, given in DEFAULTS_OF.items() if option in given
    )
    return f"{getattr(FitOptions(), option)}; {others}"


def _users(option: str) -> str:
    return ", ".join(USERS_OF[option])


RepresentationOption: TypeAlias = Annotated[
    str, typer.Option("--representation", help=f"How the scene is stored: {', '.join(FITTED)}.")
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
        help="Voxels along the longest edge.",
        show_default=_defaults("resolution"),
    ),
]
RaysOption: TypeAlias = Annotated[
    int, typer.Option("--rays", min=1, help="Rays a step; Gaussians take whole views.")
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
    typer.Option("--degree", min=0, max=MOST_DEGREE, show_default=_defaults("degree"),
                 help=f"Degree of the harmonics of {_users('degree')}."),
]  # fmt: skip
PruneOption: TypeAlias = Annotated[
    float,
    typer.Option("--prune", min=0.0,
                 help=f"Drop voxels of {_users('prune')} that weigh less in every pixel; 0: none."),
]  # fmt: skip
GaussiansOption: TypeAlias = Annotated[
    int, typer.Option("--gaussians", min=1, help="Most Gaussians that there may be.")
]
DensityControlOption: TypeAlias = Annotated[
    str,
    typer.Option("--density-control", help=f"Of Gaussians: {', '.join(DENSITY_CONTROLS)}."),
]
StartFromOption: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        "--start-from",
        help="Model on whose surfaces Gaussians begin, or from whose voxels an octree is cut.",
        metavar="MODEL",
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
ResumeOption: TypeAlias = Annotated[
    bool, typer.Option("--resume", help="Continue the fit in --out; its options are kept.")
]
