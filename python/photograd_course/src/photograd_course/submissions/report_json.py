"""The record of a grade: canonical JSON, sealed with the course secret, and comparable.

The seal (HMAC-SHA-256) shows that a record was written by a grader that knows the secret, and not
changed since. `verdict` is the hash of what must come out again when the same submission meets the
same bundle: points and verdicts, without durations and wording.
"""

from __future__ import annotations

import hashlib
import hmac
import json
import math
from typing import Any

import numpy as np

from ..errors import SceneError, message
from .report import Report

_PLACE = b"photograd grade record\0"  # keeps this use of the secret apart from seeds


def canonical(value: Any) -> bytes:
    """JSON with sorted keys and without blanks; infinities and NaN as strings."""
    return json.dumps(
        _finite(value), sort_keys=True, separators=(",", ":"), ensure_ascii=True, allow_nan=False
    ).encode()


def verdict_digest(report: Report) -> str:
    """Hash of what a second run must repeat."""
    data = {
        "assignment": report.assignment,
        "bundle": report.bundle,
        "submission": report.submission,
        "student": report.student,
        "checks": [[c.id, c.status.value, c.points, c.max] for c in report.checks],
        "questions": [[q.id, q.status, q.points, q.max] for q in report.questions],
    }
    return hashlib.sha256(canonical(data)).hexdigest()


def write_record(report: Report, secret: bytes) -> bytes:
    """The bytes of a record."""
    body = {"report": _finite(report.to_json()), "verdict": verdict_digest(report)}
    return canonical({**body, "seal": _seal(body, secret)}) + b"\n"


def read_record(data: bytes, secret: bytes) -> Report:
    """The report in a record.

    Raises:
        SceneError: it is damaged, or sealed with another secret.
    """
    try:
        record = json.loads(data)
        body = {"report": record["report"], "verdict": record["verdict"]}
        if not hmac.compare_digest(str(record["seal"]), _seal(body, secret)):
            raise ValueError("the seal does not fit")
        return Report.from_json(record["report"])
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        remedy = "grade that submission again"
        raise SceneError(
            message("read_record", "record", "a sealed record", str(error), remedy)
        ) from error


def _seal(body: Any, secret: bytes) -> str:
    key = hmac.new(secret, _PLACE, hashlib.sha256).digest()
    return hmac.new(key, canonical(body), hashlib.sha256).hexdigest()


def _finite(value: Any) -> Any:
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.tolist()
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if isinstance(value, dict):
        return {str(key): _finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    # A check may put anything into its details; what JSON lacks is kept as text.
    return value if isinstance(value, (str, int, float, type(None))) else repr(value)
