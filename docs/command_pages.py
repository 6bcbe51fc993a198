"""Pages of the command line, one for each command, from the objects that parse the arguments.

    python docs/command_pages.py     # write docs/commands/ anew

tests/house/test_command_pages.py compares what stands there with what this script would write.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, get_args, get_type_hints

import typer
from photograd_course.cli.entry import build_app
from photograd_course.cli.plugins import find_plugins
from typer.models import ArgumentInfo, OptionInfo

FOLDER = Path(__file__).resolve().parent / "commands"
WRITER = "<!-- Written by docs/command_pages.py from the command line itself. -->"
TYPES = {int: "integer", float: "number", str: "text", Path: "path"}


@dataclass(frozen=True)
class Parameter:
    """An argument or an option of a command, as a page shows it."""

    name: str
    value: str
    default: str
    meaning: str
    panel: str | None


@dataclass(frozen=True)
class Command:
    """A command: its words, paragraphs of help, examples and parameters."""

    words: str
    paragraphs: list[str]
    examples: list[str]
    arguments: list[Parameter]
    options: list[Parameter]

    @property
    def stem(self) -> str:
        """Name of its page without suffix."""
        return self.words.removeprefix("photograd ").replace(" ", "_").replace("-", "_")


@cache
def commands() -> list[Command]:
    """All commands of this installation, in the order of the help page."""
    app, problems = build_app(find_plugins())
    if problems:
        raise RuntimeError(problems[0].reason())
    return list(_commands(app, "photograd"))


def _commands(app: typer.Typer, words: str) -> Iterator[Command]:
    for info in app.registered_commands:
        assert info.callback is not None
        name = info.name or info.callback.__name__.replace("_", "-")
        text = [*str(info.help).split("\n\n"), *(info.epilog or "").split("\n\n")]
        parts = [" ".join(part.split()) for part in text if part]
        arguments, options = _parameters(info.callback)
        yield Command(
            f"{words} {name}",
            [part for part in parts if not part.startswith("Example: ")],
            [part.removeprefix("Example: ") for part in parts if part.startswith("Example: ")],
            arguments,
            options,
        )
    for group in app.registered_groups:
        inner = group.typer_instance
        assert inner is not None
        yield from _commands(inner, f"{words} {group.name or inner.info.name}")


def _parameters(callback: Callable[..., Any]) -> tuple[list[Parameter], list[Parameter]]:
    """Arguments and options of the function behind a command."""
    hints = get_type_hints(callback, include_extras=True)
    arguments, options = [], []
    for name, parameter in inspect.signature(callback).parameters.items():
        kind, *extras = get_args(hints[name]) or [hints[name]]
        for info in extras:
            if isinstance(info, ArgumentInfo):
                arguments.append(_parameter(info.metavar or name.upper(), kind, info, parameter))
            elif isinstance(info, OptionInfo):
                # The first word of typer.Option(...) in an annotation is kept as its default.
                declared = [info.default, *(info.param_decls or [])]
                words = [word for word in declared if isinstance(word, str)]
                shown = ", ".join(words) or f"--{name.replace('_', '-')}"
                if parameter.default is True and not words:
                    shown += f", --no-{name.replace('_', '-')}"
                options.append(_parameter(shown, kind, info, parameter))
    return arguments, options


def _parameter(
    name: str, kind: Any, info: ArgumentInfo | OptionInfo, parameter: inspect.Parameter
) -> Parameter:
    default = parameter.default
    if default is inspect.Parameter.empty:
        shown = "required"
    elif isinstance(info.show_default, str):
        shown = info.show_default
    elif default in (None, "", ()) or isinstance(default, bool):
        shown = ""
    else:
        shown = f"{default}"
    if default is True:
        shown = name.partition(",")[0]
    return Parameter(name, _value(kind, info), shown, info.help or "", info.rich_help_panel)


def _value(kind: Any, info: ArgumentInfo | OptionInfo) -> str:
    """What may follow the name: "" for a flag."""
    inner = [each for each in get_args(kind) or [kind] if each is not type(None)]
    if inner == [bool]:
        return ""
    shown = " ".join(TYPES.get(each, "text") for each in inner if each is not Ellipsis)
    if info.metavar and isinstance(info, OptionInfo):
        shown = info.metavar
    many = getattr(kind, "__origin__", None) in (list, set)
    low, high = info.min, info.max
    if low is not None and high is not None:
        shown += f", {low} to {high}"
    elif low is not None:
        shown += f", at least {low}"
    elif high is not None:
        shown += f", at most {high}"
    repeated = many and "repeated" not in (info.help or "")
    return f"{shown}; may be repeated" if repeated else shown


def page_of(command: Command) -> str:
    """The page of a command, in Markdown."""
    summary, *more = command.paragraphs
    parts = [WRITER, f"# {command.words}", _plain(summary)]
    if command.examples:
        parts.append("\n".join(["```sh", *command.examples, "```"]))
    parts += map(_plain, more)
    if command.arguments:
        parts += ["## Arguments", _table("argument", command.arguments)]
    own = [option for option in command.options if option.panel is None]
    if own:
        parts += ["## Options", _table("option", own)]
    common = [option for option in command.options if option.panel is not None]
    if common:
        parts += ["## Common options", _table("option", common)]
    return "\n\n".join(parts) + "\n"


def _table(what: str, parameters: list[Parameter]) -> str:
    rows = [f"| {what} | value | default | meaning |", "| --- | --- | --- | --- |"]
    for each in parameters:
        default = f"`{each.default}`" if each.default not in ("", "required") else each.default
        rows.append(f"| `{each.name}` | {each.value} | {default} | {_plain(each.meaning)} |")
    return "\n".join(rows)


def _plain(text: str) -> str:
    """Text in which Markdown finds no markup."""
    for mark in "\\*<>|[]":
        text = text.replace(mark, f"\\{mark}")
    return text


def index() -> str:
    """The first page: each command in one line."""
    rows = ["| command | what it does |", "| --- | --- |"]
    rows += [
        f"| [{command.words}]({command.stem}.md) | {_plain(command.paragraphs[0])} |"
        for command in commands()
    ]
    names = "\n".join(command.stem for command in commands())
    return "\n\n".join(
        [
            WRITER,
            "# Command line",
            "`photograd COMMAND --help`, or `-h`, says the same in a terminal. "
            "`photograd --install-completion` makes the shell complete commands and options.",
            "\n".join(rows),
            f"```{{toctree}}\n:hidden:\n{names}\n```\n",
        ]
    )


def pages() -> dict[str, str]:
    """Text of each page by the name of its file."""
    found = {f"{command.stem}.md": page_of(command) for command in commands()}
    return {"index.md": index(), **found}


def main() -> None:
    """Write the folder anew."""
    FOLDER.mkdir(exist_ok=True)
    texts = pages()
    for old in FOLDER.glob("*.md"):
        if old.name not in texts:
            old.unlink()
    for name, text in texts.items():
        (FOLDER / name).write_text(text, encoding="utf-8")
    sys.stderr.write(f"written: {len(texts)} pages in {FOLDER}\n")


if __name__ == "__main__":
    main()
