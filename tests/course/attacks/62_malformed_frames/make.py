"""Writes bytes of its own to every pipe; the header differs from variant to variant."""

PAYLOAD = '''"""Speaks nonsense."""

struct = __import__("struct")
os, stat = __import__("os"), __import__("stat")
os.write(2, b"token 62\\n")


def frame(head, body=b""):
    return struct.pack(">4sIQ", b"PGF1", len(head), len(body)) + head + body


def weighted_sum(w, x):
    data = {data}
    for descriptor in range(3, 64):
        try:
            if stat.S_ISFIFO(os.fstat(descriptor).st_mode) or descriptor == 3:
                for _ in range({repeats}):
                    view = memoryview(data)
                    while view:
                        view = view[os.write(descriptor, view):]
        except OSError:
            continue
    return 0.0
'''
HEAD = '{"kind": "result", "number": NUMBER, "value": VALUE, "arrays": ARRAYS}'


def head(number: str = "3", value: str = "1.0", arrays: str = "[]") -> str:
    text = HEAD.replace("NUMBER", number).replace("VALUE", value).replace("ARRAYS", arrays)
    return f"frame({text.encode()!r})"


def shaped(shape: str, body: str = "b''") -> str:
    entry = '[{"dtype": "f8", "shape": ' + shape + "}]"
    return head(value='{"array": 0}', arrays=entry)[:-1] + f", {body})"


def variants() -> dict[str, bytes]:
    kinds = {
        "nan": head(value="NaN"),
        "infinity": head(value="1e999"),
        "nan_number": head(number="NaN"),
        "true_number": head(number="true"),
        "negative": shaped("[-1, -1]", "b'x' * 8"),
        "enormous": shaped("[1099511627775, 1099511627775]"),
        "zero_times_enormous": shaped("[0, 1099511627775, 1099511627775, 1099511627775]"),
        "announced": "struct.pack('>4sIQ', b'PGF1', 20, 1 << 62) + b' ' * 20",
        "magic": "b'HTTP/1.1 200 OK' * 4",
        "not_text": "frame(b'\\xff' * 40)",
        "surrogate": head(value='"\\ud800\\udfff\\u0000"'),
        "brackets": "frame(b'[' * 1_000_000)",
        "huge": head(value="9" * 400),
        "digits": "frame(b'{\"number\": ' + b'9' * 3_000_000 + b'}')",
        "amplified": 'frame(b\'{"kind": "result", "number": 3, "arrays": [], "value": [\''
        " + b'[],' * 2_700_000 + b'[]]}')",
    }
    made = {name: PAYLOAD.format(data=data, repeats=1).encode() for name, data in kinds.items()}
    made["torrent"] = PAYLOAD.format(data="frame(b' ' * 1_000_000)", repeats=400).encode()
    return made
