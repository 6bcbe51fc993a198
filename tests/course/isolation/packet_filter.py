"""What a compiled filter of system calls decides, worked out as the kernel does it."""

from __future__ import annotations

import errno
import struct
from collections.abc import Sequence

LITTLE_ENDIAN = 0x40000000
ALLOW = 0x7FFF0000
ERRORS = {0x00050000 | errno.EPERM: "refused", 0x00050000 | errno.ENOSYS: "unknown"}


def decide(
    program: bytes, arch: int, number: int, args: Sequence[int] = (), *, said: int | None = None
) -> str:
    """Whether a call is "allowed", "refused" (EPERM) or "unknown" (ENOSYS).

    Args:
        program: compiled for `arch`, an AUDIT_ARCH_ constant.
        number, args: of the call.
        said: through which interface the kernel says that it was made; that of `arch` by default.
    """
    order = "<" if arch & LITTLE_ENDIAN else ">"
    code = list(struct.iter_unpack("=HBBI", program))
    words = [argument & (1 << 64) - 1 for argument in (*args, 0, 0, 0, 0, 0, 0)[:6]]
    data = struct.pack(f"{order}IIQ6Q", number, arch if said is None else said, 0, *words)
    at = held = 0
    while True:
        operation, if_true, if_false, constant = code[at]
        at += 1
        if operation == 0x06:
            return "allowed" if constant == ALLOW else ERRORS[constant]
        if operation == 0x20:
            held = struct.unpack_from(f"{order}I", data, constant)[0]
        elif operation == 0x54:
            held &= constant
        elif operation == 0x05:
            at += constant
        else:
            compared = {
                0x15: held == constant,
                0x25: held > constant,
                0x35: held >= constant,
                0x45: bool(held & constant),
            }
            at += if_true if compared[operation] else if_false
