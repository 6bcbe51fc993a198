"""Each error carries one sentence, prints it, and is also the builtin people already catch."""

from __future__ import annotations

import pickle

import pytest
from photograd_course import errors

BUILTINS = {
    errors.Error: RuntimeError,
    errors.ShapeError: ValueError,
    errors.RangeError: ValueError,
    errors.DtypeError: TypeError,
    errors.IoError: OSError,
    errors.SceneError: ValueError,
}


@pytest.mark.parametrize("kind", BUILTINS)
def test_is_error_and_builtin_and_prints_its_sentence(kind: type[errors.Error]) -> None:
    text = errors.message("load", "path", "a .npz file", "'x.txt'", "convert it first")
    assert text == "load: path: expected a .npz file, got 'x.txt' (convert it first)"
    with pytest.raises(BUILTINS[kind]) as caught:
        raise kind(text)
    assert isinstance(caught.value, errors.Error)
    assert str(caught.value) == text
    again = pickle.loads(pickle.dumps(caught.value))
    assert type(again) is kind
    assert str(again) == text


def test_message_without_remedy() -> None:
    assert errors.message("f", "x", "1", "2") == "f: x: expected 1, got 2"
