"""Which views are held out when a capture does not say."""

from __future__ import annotations

from collections.abc import Sequence

from photograd.capture.view import View

HOLD_OUT_EVERY = 8
"""Every eighth photograph, starting with the first: the custom since [Mildenhall2019]."""


def hold_out(views: Sequence[View]) -> tuple[tuple[View, ...], tuple[View, ...], str]:
    """Split views into training and test by their rank in the order of names.

    Returns:
        Training views, test views, and a sentence for the log. A single view is not held out.
    """
    ordered = sorted(views, key=lambda view: view.name)
    if len(ordered) < 2:
        return tuple(ordered), (), "no view held out: there is only one"
    test = tuple(ordered[::HOLD_OUT_EVERY])
    train = tuple(view for index, view in enumerate(ordered) if index % HOLD_OUT_EVERY)
    line = (
        f"no split in the file: every {HOLD_OUT_EVERY}th view by name is held out, "
        f"starting with the first ({len(train)} train, {len(test)} test)"
    )
    return train, test, line
