"""From the handout alone: its steps and equations, one after another."""

import math

import numpy as np
from engine import as_value


class Value:
    def __add__(self, other):
        other = as_value(other)
        # Moving either one by h moves the sum by h.
        return Value(self.data + other.data, [(self, 1), (other, 1)])

    def __mul__(self, other):
        other = as_value(other)
        x, y = self.data, other.data
        # (x + h) y - x y = h y, so what is left over is the other one.
        return Value(x * y, [(self, y), (other, x)])

    def maximum(self, other):
        other = as_value(other)
        if self.data > other.data:
            return Value(self.data, [(self, 1.0), (other, 0.0)])
        return Value(other.data, [(self, 0.0), (other, 1.0)])

    def exp(self):
        u = math.exp(self.data)
        return Value(u, [(self, u)])

    def log(self):
        u = math.log(self.data)
        # x = e^u, so 1 = e^u du/dx.
        return Value(u, [(self, 1 / math.exp(u))])

    def __pow__(self, n):
        x = self.data
        return Value(x**n, [(self, n * x ** (n - 1))])


def topo_order(root):
    # A stack of values; the state says whether the inputs have been put on the stack.
    done = []
    state = {}
    stack = [root]
    while len(stack) > 0:
        u = stack[-1]
        if u not in state:
            state[u] = "waiting for inputs"
            for v, _ in u.inputs:
                if v not in state:
                    stack.append(v)
            continue
        stack.pop()
        if state[u] == "waiting for inputs":
            state[u] = "done"
            done.append(u)
    return done


def backward(root, seed=1.0):
    order = topo_order(root)
    for v in order:
        v.grad = 0.0
    root.grad = 1.0 * seed
    for k in range(len(order)):
        u = order[len(order) - 1 - k]
        for v, slope in u.inputs:
            v.grad += u.grad * slope


def grad_check(f, x, eps=1e-5):
    n = len(x)
    g = f(np.copy(x))[1]
    d = np.zeros(n)
    for i in range(n):
        h = eps * max(1, abs(x[i]))
        e = np.zeros(n)
        e[i] = 1
        d[i] = (f(x + h * e)[0] - f(x - h * e)[0]) / (2 * h)
    if not (np.all(np.isfinite(g)) and np.all(np.isfinite(d))):
        return float("inf")
    longest = max(np.linalg.norm(g), np.linalg.norm(d))
    if longest == 0:
        return 0.0
    return np.linalg.norm(g - d) / longest
