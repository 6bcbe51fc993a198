"""Not before a minute has passed."""

os, sys, time = __import__("os"), __import__("sys"), __import__("time")
os.write(2, b"token 52\n")
sys.stdin.read()
try:
    input("ready? ")
except EOFError:
    pass
for name in ("tkinter", "matplotlib.pyplot", "webbrowser"):
    try:
        __import__(name)
    except BaseException:
        continue
end = time.monotonic() + 60
while time.monotonic() < end:
    sum(range(1000))


def weighted_sum(w, x):
    return 0.0
