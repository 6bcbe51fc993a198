"""The table of reflectance models in docs/scene_file.md, from the registry.

    python docs/scene_file_models.py     # write it anew

tests/house/test_scene_file_page.py compares.
"""

from __future__ import annotations

from pathlib import Path

from photograd.bsdf import ModelParameter
from photograd.transport.material import MODELS

PAGE = Path(__file__).resolve().parent / "scene_file.md"
BEGIN = "<!-- models: written by docs/scene_file_models.py -->\n"
END = "<!-- models end -->\n"


def table() -> str:
    """Models with their parameters and the ranges of these, in Markdown."""
    rows = ["| model | parameters |", "| --- | --- |"]
    alike: dict[str, list[str]] = {}
    for name, model in MODELS.items():
        alike.setdefault(", ".join(map(_described, model.parameters)), []).append(f"`{name}`")
    rows += [f"| {', '.join(names)} | {parameters} |" for parameters, names in alike.items()]
    return "\n".join(rows) + "\n"


def _described(parameter: ModelParameter) -> str:
    color = ", color" if parameter.size == 3 else ""
    unit = "" if parameter.unit in ("", "1") else f" {parameter.unit}"
    return f"`{parameter.name}` ({parameter.lo:g} to {parameter.hi:g}{unit}{color})"


def written(text: str) -> str:
    """The page with the table between its two marks."""
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    return f"{before}{BEGIN}{table()}{END}{after}"


if __name__ == "__main__":
    PAGE.write_text(written(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
