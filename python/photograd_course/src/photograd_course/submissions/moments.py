"""Dates and times as people write them, brought into an order."""

from __future__ import annotations

import datetime as dt
import re

_MONTHS = ("jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec")
_CLOCK = r"[ ,T]+(?:at )?(?P<hour>\d{1,2})[:.]?(?P<minute>\d{2})(?:[:.]?(?P<second>\d{2}))?"
_HALF = r"\s*(?:(?P<half>[AaPp])\.?[Mm]\.?)?"
_DATES = tuple(
    re.compile(date + _CLOCK + _HALF)
    for date in (
        r"(?P<month>[A-Za-z]{3,})\.? (?P<day>\d{1,2}),? (?P<year>\d{4})",
        r"(?P<day>\d{1,2})\.? (?P<month>[A-Za-z]{3,})[.,]* (?P<year>\d{4})",
        r"(?P<year>\d{4})-(?P<month>\d{1,2})-(?P<day>\d{1,2})",
    )
)


def looks_like_a_date(text: str) -> bool:
    """Whether a text has a year and at least two more numbers."""
    return bool(re.search(r"\b(?:19|20)\d\d\b", text)) and len(re.findall(r"\d+", text)) >= 3


def moment_of(text: str) -> str:
    """The date and time such that the order of texts is theirs; "" where they cannot be read.

    Args:
        text: such as "Mar 29, 2018 1205 PM".
    """
    plain = re.sub(r"^[A-Za-z]+day, ", "", text)
    found = next((match for each in _DATES if (match := each.fullmatch(plain))), None)
    if found is None:
        return ""
    month = found["month"].lower()[:3]
    known = int(month) if month.isdigit() else _MONTHS.index(month) + 1 if month in _MONTHS else 0
    hour, half = int(found["hour"]), (found["half"] or "").lower()
    if half:
        hour = hour % 12 + (12 if half == "p" else 0)
    date = (int(found["year"]), known, int(found["day"]))
    try:
        moment = dt.datetime(*date, hour, int(found["minute"]), int(found["second"] or 0))
    except ValueError:
        return ""
    return moment.isoformat()
