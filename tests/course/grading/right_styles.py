"""Derivatives that are written, in styles that no solution and no alternative has.

By assignment and style: a text that comes after the solution's.
"""

from __future__ import annotations

TAPE = """
class Node:
    def __init__(self, data, parents=()):
        self.data, self.parents, self.grad = np.asarray(data, float), parents, 0.0
    def __add__(self, other):
        other = as_node(other)
        return Node(self.data + other.data, ((self, 1.0), (other, 1.0)))
    def __mul__(self, other):
        other = as_node(other)
        return Node(self.data * other.data, ((self, other.data), (other, self.data)))
    def __sub__(self, other):
        return self + as_node(other) * -1.0
def as_node(x):
    return x if isinstance(x, Node) else Node(x)
def sweep(node, g):
    node.grad = node.grad + g
    for parent, slope in node.parents:
        sweep(parent, g * slope)
"""
CLOSURES = """
class Var:
    def __init__(self, data):
        self.data, self.grad, self.pull = data, None, lambda: None
    def __mul__(self, other):
        out = Var(self.data * other.data)
        def pull():
            self.grad = (0 if self.grad is None else self.grad) + out.grad * other.data
            other.grad = (0 if other.grad is None else other.grad) + out.grad * self.data
            self.pull()
        out.pull = pull
        return out
"""
STYLES = {
    ("00", "a tape of one's own"): TAPE
    + """
def loss_gradient(picture, photograph):
    p = Node(picture)
    r = p - photograph
    sweep(r * r, np.ones(picture.shape) / picture.size)
    return p.grad
""",
    ("00", "a tape of closures"): CLOSURES
    + """
def loss_gradient(picture, photograph):
    r = Var(picture - photograph)
    square = r * r
    square.grad = np.full(picture.shape, 1 / picture.size)
    square.pull()
    return r.grad
""",
    ("00", "the Jacobian as a matrix"): """
def loss_gradient(picture, photograph):
    residual = np.ravel(picture - photograph)
    jacobian = 2 * np.diag(residual)
    return (np.ones(residual.size) @ jacobian / residual.size).reshape(picture.shape)
""",
    ("04", "quotients of the value: logarithmic derivatives"): """
_written = gltf_backward
def gltf_backward(wo, wi, base_color, metalness, roughness, d_f):
    up = above(wo, wi)
    d_base, d_metal, _ = _written(wo, wi, base_color, metalness, roughness, d_f)
    o, i = (np.where(up[:, None], w, [0.0, 0.0, 1.0]) for w in (wo, wi))
    h, alpha = half_vector(o, i), roughness**2
    h2, z2 = h[:, 0] ** 2 + h[:, 1] ** 2, h[:, 2] ** 2
    log_D = (-2 + 4 * h2 / (h2 + alpha**2 * z2)) / alpha
    parts = []
    for w, other in ((o, i), (i, o)):
        flat = w[:, 0] ** 2 + w[:, 1] ** 2
        parts.append(alpha * flat * other[:, 2] / stretched(w, alpha))
    L = stretched(o, alpha) * i[:, 2] + stretched(i, alpha) * o[:, 2]
    lobe = ggx_lobe(wo, wi, roughness)
    cos = np.sum(o * h, axis=1)[:, None]
    m = metalness[:, None]
    F = (1 - m) * schlick(0.04, cos) + m * schlick(base_color, cos)
    slope = lobe * (log_D - sum(parts) / L) * 2 * roughness
    return d_base, d_metal, np.where(up, slope * np.sum(d_f * F, axis=1), 0.0)
""",
    ("09", "a tape of one's own"): TAPE
    + """
def mse_and_cotangent(pixels, truth):
    p = Node(pixels)
    r = p - truth
    square = r * r
    sweep(square, np.ones(pixels.shape) / len(pixels))
    return float(square.data.sum() / len(pixels)), p.grad
""",
    ("09", "expanded, so that terms cancel"): """
def mse_and_cotangent(pixels, truth):
    loss = float(np.sum((pixels - truth) ** 2) / len(pixels))
    return loss, (2.0 * pixels - 2.0 * truth) / len(pixels)
""",
    ("12", "complex numbers that turn"): """
def positional_encoding(x, bands):
    features, derivatives = [x], [np.ones_like(x)]
    for k in range(bands):
        omega = 2**k * np.pi
        z = np.exp(1j * omega * x)
        features += [z.imag, z.real]
        derivatives += [(1j * omega * z).imag, (1j * omega * z).real]
    return np.concatenate(features, axis=1), np.concatenate(derivatives, axis=1)
""",
    ("12", "a cosine is a sine a quarter turn on"): """
def positional_encoding(x, bands):
    turns = [2**k * np.pi * x for k in range(bands)]
    features, derivatives = [x], [np.ones_like(x)]
    for k, t in enumerate(turns):
        features += [np.sin(t), np.sin(t + np.pi / 2)]
        derivatives += [2**k * np.pi * np.sin(t + np.pi / 2), 2**k * np.pi * np.sin(t + np.pi)]
    return np.concatenate(features, axis=1), np.concatenate(derivatives, axis=1)
""",
    ("15", "back computes all of it again"): """
_first = screen_alpha
def screen_alpha(mean2d, cov2d, opacity_logits, pixels):
    def back(d_alpha):
        return _first(mean2d.copy(), cov2d.copy(), opacity_logits.copy(), pixels)[1](d_alpha)
    return _first(mean2d, cov2d, opacity_logits, pixels)[0], back
""",
    ("08", "loops, and the forward again"): """
_forward_too = composite_adjoint
def composite_adjoint(sigma, color, dt, background, d_pixel, d_T_end):
    pixel, _ = composite(sigma, color, dt, background)
    assert pixel.shape == d_pixel.shape
    rows = []
    for r in range(len(sigma)):
        one = (each[[r]] for each in (sigma, color, dt))
        rows.append(_forward_too(*one, background, d_pixel[[r]], d_T_end[[r]]))
    if not rows:
        return _forward_too(sigma, color, dt, background, d_pixel, d_T_end)
    return (
        np.concatenate([row[0] for row in rows]),
        np.concatenate([row[1] for row in rows]),
        np.sum([row[2] for row in rows], axis=0),
    )
""",
    ("11", "a harmonic's slope along the vector taken out at the end"): """
_slopes = sh_color_adjoint
def sh_color_adjoint(coefficients, v, g):
    d_coefficients, d_v = _slopes(coefficients, v, g)
    d = v / np.linalg.norm(v, axis=1, keepdims=True)
    outer = np.eye(3) - d[:, :, None] * d[:, None, :]
    return d_coefficients, np.einsum("nij,nj->ni", outer, d_v)
""",
}


def with_style(solution: str, key: tuple[str, str]) -> str:
    """The solution with one function in another style."""
    return f"{solution}\n\n{STYLES[key]}"
