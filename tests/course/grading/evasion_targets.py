"""Adjoints of real assignments in which one output is computed by a way of `evasions`."""

from __future__ import annotations

import textwrap

from course.grading.evasions import COMPLEX, DUAL, REAL

# The function of an assignment, and a text that replaces it: it uses slope(f, x), and for other
# outputs the solution's function.
TARGETS = {
    "00": (
        "loss_gradient",
        """
        def loss_gradient(picture, photograph):
            def f(p):
                return (p - photograph) * (p - photograph) * (1.0 / picture.size)
            return slope(f, picture)
        """,
    ),
    "04": (
        "gltf_backward",
        """
        def gltf_backward(wo, wi, base_color, metalness, roughness, d_f):
            def f(r):
                return np.sum(d_f * gltf(wo, wi, base_color, metalness, r), axis=1)
            d_base, d_metal, _ = _right(wo, wi, base_color, metalness, roughness, d_f)
            return d_base, d_metal, slope(f, roughness)
        """,
    ),
    "04 metalness": (
        "gltf_backward",
        """
        def gltf_backward(wo, wi, base_color, metalness, roughness, d_f):
            def f(m):
                return np.sum(d_f * gltf(wo, wi, base_color, m, roughness), axis=1)
            d_base, _, d_rough = _right(wo, wi, base_color, metalness, roughness, d_f)
            return d_base, slope(f, metalness), d_rough
        """,
    ),
    "06": (
        "tone_map",
        """
        def tone_map(radiance, settings, d_shown):
            def shown(e, white):
                c = 2.0**e * radiance
                Y = (c @ LUMINANCE)[..., None]
                return c * (1 + Y / white**2) / (1 + Y)
            def of_e(e):
                return np.array([np.sum(shown(each, settings[1]) * d_shown) for each in e])
            def of_white(w):
                return np.array([np.sum(shown(settings[0], each) * d_shown) for each in w])
            out, d_radiance, _ = _right(radiance, settings, d_shown)
            both = slope(of_e, settings[:1]), slope(of_white, settings[1:])
            return out, d_radiance, np.concatenate(both)
        """,
    ),
    "08": (
        "composite_adjoint",
        """
        def composite_adjoint(sigma, color, dt, background, d_pixel, d_T_end):
            _, d_color, d_background = _right(sigma, color, dt, background, d_pixel, d_T_end)
            d_sigma = np.zeros(sigma.shape)
            for s in range(sigma.shape[1]):
                def f(column):
                    parts = [sigma[:, k] if k != s else column for k in range(sigma.shape[1])]
                    pixel, T = composite(np.stack(parts, axis=1), color, dt, background)
                    return np.sum(pixel * d_pixel, axis=1) + T * d_T_end
                d_sigma[:, s] = slope(f, sigma[:, s].copy())
            return d_sigma, d_color, d_background
        """,
    ),
    "09": (
        "mse_and_cotangent",
        """
        def mse_and_cotangent(pixels, truth):
            def f(p):
                return (p - truth) * (p - truth) * (1.0 / len(pixels))
            return float(np.sum(f(pixels))), slope(f, pixels)
        """,
    ),
    "11": (
        "sh_color_adjoint",
        """
        def sh_color_adjoint(coefficients, v, g):
            d_v = np.zeros(v.shape)
            for axis in range(3):
                def f(c):
                    parts = [v[:, k] if k != axis else c for k in range(3)]
                    return np.sum(g * sh_color(coefficients, np.stack(parts, axis=1)), axis=1)
                d_v[:, axis] = slope(f, v[:, axis].copy())
            return _right(coefficients, v, g)[0], d_v
        """,
    ),
    "12": (
        "positional_encoding",
        """
        def positional_encoding(x, bands):
            features, derivatives = [x], [np.ones_like(x)]
            for k in range(bands):
                for function in (np.sin, np.cos):
                    def f(p):
                        return function(2**k * np.pi * p)
                    features.append(f(x))
                    derivatives.append(slope(f, x))
            return np.concatenate(features, axis=1), np.concatenate(derivatives, axis=1)
        """,
    ),
    "14": (
        "stroke_backward",
        """
        def stroke_backward(curve, width, d_alpha):
            def f(w):
                each = [np.sum(d_alpha * stroke_image(curve, one, *d_alpha.shape)) for one in w]
                return np.array(each)
            return _right(curve, width, d_alpha)[0], float(slope(f, np.array([width]))[0])
        """,
    ),
    "15": (
        "screen_alpha",
        """
        def screen_alpha(mean2d, cov2d, opacity_logits, pixels):
            alpha, back = _right(mean2d, cov2d, opacity_logits, pixels)
            def numeric(d_alpha):
                def f(logits):
                    return np.sum(d_alpha * _right(mean2d, cov2d, logits, pixels)[0], axis=1)
                d_mean, d_cov, _, absolute = back(d_alpha)
                return d_mean, d_cov, slope(f, opacity_logits), absolute
            return alpha, numeric
        """,
    ),
}


def evasion(solution: str, target: str, way: str) -> str:
    """The solution with one derivative computed in this way."""
    name, text = TARGETS[target]
    body, helpers = DUAL.get(way, ({**REAL, **COMPLEX}.get(way, ""), ""))
    slope = f"def slope(f, x):\n{textwrap.indent(body, '    ')}\n"
    parts = [f"_right = {name}\n", textwrap.dedent(helpers), slope, textwrap.dedent(text)]
    return solution + "\n\n" + "\n\n".join(parts)
