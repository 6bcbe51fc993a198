"""JSON read with suspicion: every access checks the type and names the place that is wrong."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from photograd_course.input_files import read_text

from photograd.errors import IoError, RangeError, message
from photograd.types import FloatArray


@dataclass(frozen=True)
class JsonNode:
    """A value of a JSON file together with where it stands.

    Attributes:
        function: the reader on whose behalf errors speak.
        where: file and path inside it, for example ``"transforms.json: frames[3]"``.
        value: what `json` returned.
    """

    function: str
    where: str
    value: object

    def __contains__(self, key: str) -> bool:
        return isinstance(self.value, dict) and self.value.get(key) is not None

    def __getitem__(self, key: str) -> JsonNode:
        """The member `key` of an object.

        Raises:
            IoError: not an object, or without that member (null counts as without).
        """
        if not isinstance(self.value, dict):
            raise self.wrong("an object")
        if self.value.get(key) is None:
            known = ", ".join(sorted(map(str, self.value))[:12]) or "nothing"
            raise IoError(message(self.function, self.where, f"a member '{key}'", f"only {known}"))
        return JsonNode(self.function, f"{self.where}: {key}", self.value[key])

    def members(self) -> Iterator[tuple[str, JsonNode]]:
        """Names and values of an object, in the order of the file.

        Raises:
            IoError: not an object.
        """
        if not isinstance(self.value, dict):
            raise self.wrong("an object")
        for key, value in self.value.items():
            yield key, JsonNode(self.function, f"{self.where}: {key}", value)

    def items(self) -> list[JsonNode]:
        """The elements of an array.

        Raises:
            IoError: not an array.
        """
        if not isinstance(self.value, list):
            raise self.wrong("an array")
        return [
            JsonNode(self.function, f"{self.where}[{index}]", value)
            for index, value in enumerate(self.value)
        ]

    def text(self) -> str:
        """A string.

        Raises:
            IoError: anything else.
        """
        if not isinstance(self.value, str):
            raise self.wrong("a string")
        return self.value

    def number(self) -> float:
        """A finite number.

        Raises:
            IoError: not a number (true and false are none).
            RangeError: NaN, infinite or too large for a double.
        """
        if isinstance(self.value, bool) or not isinstance(self.value, int | float):
            raise self.wrong("a number")
        try:
            number = float(self.value)
        except OverflowError:
            number = math.inf
        if not math.isfinite(number):
            raise RangeError(message(self.function, self.where, "a finite number", number))
        return number

    def count(self) -> int:
        """A whole number of at least 1, such as an image size (1.0 counts as 1).

        Raises:
            IoError, RangeError: anything else.
        """
        number = self.number()
        if number != round(number) or not 1 <= number < 2**31:
            raise RangeError(message(self.function, self.where, "a positive whole number", number))
        return int(number)

    def numbers(self, *shapes: tuple[int, ...]) -> FloatArray:
        """An array of finite numbers, nested as one of `shapes` says.

        Raises:
            IoError: another nesting, or something that is not a number.
            RangeError: a number that is not finite.
        """
        for shape in shapes:
            if _nesting_matches(self.value, shape):
                return np.array([node.number() for node in self._leaves(len(shape))]).reshape(shape)
        raise self.wrong(" or ".join(f"numbers of shape {shape}" for shape in shapes))

    def _leaves(self, depth: int) -> list[JsonNode]:
        return (
            [self] if depth == 0 else [x for item in self.items() for x in item._leaves(depth - 1)]
        )

    def wrong(self, expected: str) -> IoError:
        """The error that says that something else was expected here."""
        text = repr(self.value)
        got = f"{type(self.value).__name__} {text if len(text) < 60 else text[:57] + '...'}"
        return IoError(message(self.function, self.where, expected, got))


def _nesting_matches(value: object, shape: tuple[int, ...]) -> bool:
    if not shape:
        return not isinstance(value, list | dict)
    if not isinstance(value, list) or len(value) != shape[0]:
        return False
    return all(_nesting_matches(item, shape[1:]) for item in value)


def read_json(function: str, path: Path) -> JsonNode:
    """Parse a JSON file.

    Raises:
        IoError: missing, no regular file, not UTF-8, not JSON, or nested too deeply.
    """
    text = read_text(function, path)
    try:
        return JsonNode(function, path.name, json.loads(text))
    except RecursionError as error:
        raise IoError(message(function, str(path), "valid JSON", "too deep nesting")) from error
    except ValueError as error:  # JSONDecodeError, or an integer of thousands of digits
        raise IoError(message(function, str(path), "valid JSON", error)) from error
