"""What kind of image a file is, as its first bytes say; its name is not asked.

Only these kinds are ever opened. Pillow knows many more, and hands some, such as PostScript, to
other programs.
"""

from __future__ import annotations

from pathlib import Path

from photograd_course.input_files import read_file

from photograd.errors import IoError, message

_READ = {
    b"\x89PNG\r\n\x1a\n": "PNG", b"\xff\xd8\xff": "JPEG", b"v/1\x01": "EXR", b"#?": "HDR",
    b"PF": "PFM", b"Pf": "PFM",
}  # fmt: skip
_OTHERS = {
    b"GIF8": "GIF", b"II*\0": "TIFF", b"MM\0*": "TIFF", b"BM": "BMP", b"%!PS": "PostScript",
    b"\xc5\xd0\xd3\xc6": "PostScript", b"%PDF": "PDF", b"RIFF": "WebP",
    b"\0\0\0\x0cjP": "JPEG 2000", b"P5": "PGM", b"P6": "PPM", b"<svg": "SVG", b"8BPS": "Photoshop",
}  # fmt: skip
PILLOW_KINDS = ("PNG", "JPEG")
LINEAR_KINDS = ("EXR", "HDR", "PFM")
LINEAR_SUFFIXES = (".exr", ".hdr", ".pfm")
KINDS = (*PILLOW_KINDS, *LINEAR_KINDS)


def image_kind(function: str, path: Path, kinds: tuple[str, ...] = KINDS) -> str:
    """Which of `kinds` a file is.

    Args:
        function: reader on whose behalf errors speak.
        path: the file.
        kinds: of `KINDS`: "PNG", "JPEG", "EXR", "HDR" (Radiance) or "PFM".

    Raises:
        IoError: no file, or none of these; names what it is instead, if that is known.
    """
    head = read_file(function, path, 16)
    for known, read in ((_READ, True), (_OTHERS, False)):
        for start, kind in known.items():
            if head.startswith(start):
                if read and kind in kinds:
                    return kind
                raise _refusal(function, path, kinds, f"{kind} data")
    if head[4:8] == b"ftyp":
        raise _refusal(function, path, kinds, "HEIC, AVIF or video data")
    raise _refusal(function, path, kinds, f"data that begins with {head[:8]!r}")


def _refusal(function: str, path: Path, kinds: tuple[str, ...], got: str) -> IoError:
    expected = f"a readable image ({', '.join(kinds)})"
    return IoError(message(function, f"{path}", expected, got, "convert it first"))
