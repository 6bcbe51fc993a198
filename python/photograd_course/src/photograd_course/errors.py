"""The typed errors of the whole project, and the one sentence form that all of them use.

Each error is also the Python builtin that people already catch: a wrong shape is a ``ValueError``,
a wrong dtype a ``TypeError``, an unreadable file an ``OSError``.
"""

from __future__ import annotations


class Error(RuntimeError):
    """Base of all errors raised on purpose; constructed with one finished message."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.text = text

    def __str__(self) -> str:
        # Said here because OSError prints its errno fields instead of a lone message in some cases.
        return self.text

    def __reduce__(self) -> tuple[type[Error], tuple[str]]:
        # Errors cross process borders (graders run student code elsewhere): keep them picklable.
        return (type(self), (self.text,))


class ShapeError(Error, ValueError):
    """An array has the wrong rank or the wrong extent along an axis."""


class RangeError(Error, ValueError):
    """A value lies outside its allowed range, or is not finite."""


class DtypeError(Error, TypeError):
    """An array or argument has the wrong type."""


class IoError(Error, OSError):
    """A file is missing, unreadable, or not what it claims to be."""


class SceneError(Error, ValueError):
    """A scene description is inconsistent."""


def message(
    function: str, argument: str, expected: object, got: object, remedy: str | None = None
) -> str:
    """The one form of every error: ``function: argument: expected X, got Y (remedy)``.

    Args:
        function: name of the function that refuses.
        argument: name of the offending argument.
        expected: what would have been accepted, for example ``"shape (R, S) with R = 4096"``.
        got: what came instead.
        remedy: what the reader can do about it; left out with its brackets when None.
    """
    sentence = f"{function}: {argument}: expected {expected}, got {got}"
    return sentence if remedy is None else f"{sentence} ({remedy})"
