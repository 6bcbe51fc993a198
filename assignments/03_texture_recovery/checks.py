"""Checks of assignment 03."""

from __future__ import annotations

import numpy as np
from photograd_course.grading import (
    Array,
    CheckFailed,
    Items,
    Number,
    StudentFailure,
    Subject,
    Tolerance,
    agree,
    check,
)
from photograd_course.grading.adjoint_gate import (
    require_cheap,
    require_gradients,
    require_zero_for_zero,
)

# Evidence: worst of the solution and three alternatives over several seeds, against the nearest of
# 55 named wrong solutions.
EXACT = Tolerance(
    1e-12, "right ones differ by at most 1.3e-15, the nearest wrong one (adjoint_wrap) by 0.024"
)
CHAINED = Tolerance(
    1e-10, "right ones differ by at most 5e-16, the nearest wrong one (steps_shrink) by 0.019"
)
QUADRATIC = Tolerance(
    1e-6, "differences of a quadratic leave 6e-11, the nearest wrong one (grad_missing_two) 0.5"
)
ESTIMATE = Tolerance(
    0.02, "300 rounds leave 2e-15, the nearest wrong one (curvature_missing_two) is off by 0.5"
)
FIRST_STEP = Tolerance(
    1e-3, "40 rounds on gathered samples leave 1e-15, the nearest wrong one (step_whole) 0.053"
)


def centres(shape):
    """Centre of every texel of a texture (H, W), row by row: (H W, 2)."""
    v, u = np.meshgrid(*((np.arange(n) + 0.5) / n for n in shape), indexing="ij")
    return np.stack([u.ravel(), v.ravel()], axis=1)


def sampling_matrix(t, shape, uv):
    """Samples of all textures that hold a single 1, by your own forward function: (N, H W)."""
    texels = int(np.prod(shape))
    unit = np.eye(texels).reshape(*shape, texels)
    return t.call("bilinear_sample", unit, uv, returns=Array((len(uv), texels)))


# 03.1 ---------------------------------------------------------------------------------------------


@check(
    "03.1.centres",
    task="03.1",
    points=2,
    calls=("bilinear_sample",),
    tolerance=EXACT,
    hint="handout, equation (3): which u belongs to column 0?",
    sole="says that the coordinates are right, whatever the weights",
)
def a_centre_gives_its_texel(t):
    """At the centre of a texel, the sample is that texel."""
    T = t.rng.uniform(-1.0, 1.0, (3, 5, 2))
    got = t.call("bilinear_sample", T, centres((3, 5)), returns=Array((15, 2)))
    t.close("samples", got, T.reshape(15, 2), reveal=True)


@check(
    "03.1.ramp",
    task="03.1",
    points=3,
    calls=("bilinear_sample",),
    tolerance=EXACT,
    hint="handout, equation (6): which texel belongs to which weight?",
    sole="says that the weights are right, on a picture one can draw",
)
def a_ramp_stays_a_ramp(t):
    """A texture that rises evenly to the right and downwards is sampled without error."""
    shape = (4, 7)
    across, down = t.rng.uniform(1.0, 2.0, 2) * np.array([1.0, -2.0])
    T = (centres(shape) @ [across, down]).reshape(*shape, 1)
    uv = t.rng.uniform([0.5 / 7, 0.5 / 4], [1 - 0.5 / 7, 1 - 0.5 / 4], (60, 2))
    got = t.call("bilinear_sample", T, uv, returns=Array((60, 1)))
    t.close("samples", got[:, 0], uv @ [across, down], reveal=True)


@check(
    "03.1.product",
    task="03.1",
    points=2,
    calls=("bilinear_sample",),
    tolerance=EXACT,
    hint="handout, equation (6): four products of weights, and the texel of each",
    sole="what separates four weights from three",
)
def a_product_stays_a_product(t):
    """The texture u v is sampled without error: the surface between four texels is twisted."""
    shape = (5, 3)
    T = np.prod(centres(shape), axis=1).reshape(*shape, 1)
    uv = t.rng.uniform([0.5 / 3, 0.5 / 5], [1 - 0.5 / 3, 1 - 0.5 / 5], (60, 2))
    got = t.call("bilinear_sample", T, uv, returns=Array((60, 1)))
    t.close("samples", got[:, 0], np.prod(uv, axis=1), reveal=True)


@check(
    "03.1.constant",
    task="03.1",
    points=2,
    calls=("bilinear_sample",),
    tolerance=EXACT,
    hint="the four weights sum to 1 everywhere, at the border too",
    sole="a constant sees nothing but the sum of the weights",
)
def a_constant_stays_constant(t):
    """A constant texture gives its constant everywhere."""
    value = t.rng.uniform(1.0, 2.0, 3)
    uv = t.rng.uniform(0.0, 1.0, (80, 2))
    T = np.tile(value, (2, 6, 1))
    got = t.call("bilinear_sample", T, uv, returns=Array((80, 3)))
    t.close("samples", got, np.tile(value, (80, 1)), reveal=True)


@check(
    "03.1.edge",
    task="03.1",
    points=3,
    calls=("bilinear_sample",),
    tolerance=EXACT,
    hint="handout, equation (4): clamp the coordinate, then split it",
    sole="says that only the border is wrong",
)
def the_border_holds(t):
    """Beyond the outermost centres, and beyond the texture, the value at the border holds."""
    shape = (3, 4)
    T = t.rng.uniform(-1.0, 1.0, (*shape, 2))
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    got = t.call("bilinear_sample", T, corners, returns=Array((4, 2)))
    t.close("corners", got, T[::2, ::3].reshape(4, 2), reveal=True)
    uv = t.rng.uniform(-0.5, 1.5, (80, 2))
    inside = np.clip(uv, [0.5 / 4, 0.5 / 3], [1 - 0.5 / 4, 1 - 0.5 / 3])
    got = t.call("bilinear_sample", T, uv, returns=Array((80, 2)))
    same = t.call("bilinear_sample", T, inside, returns=Array((80, 2)))
    t.close("samples", got, same)


# 03.2 ---------------------------------------------------------------------------------------------


@check(
    "03.2.single",
    task="03.2",
    points=3,
    calls=("bilinear_sample_adjoint",),
    tolerance=EXACT,
    hint="handout, equation (7): g times the weight that the texel had",
    sole="asks about one sample, without the forward function",
)
def one_sample_is_spread_around_its_place(t):
    """What one sample hands out sums to g, and is balanced around the sample's place."""
    shape = (4, 6)
    for _ in range(5):
        uv = t.rng.uniform([0.5 / 6, 0.5 / 4], [1 - 0.5 / 6, 1 - 0.5 / 4], (1, 2))
        g = t.rng.uniform(0.5, 2.0, (1, 1))
        d_T = t.call("bilinear_sample_adjoint", shape, uv, g, returns=Array((4, 6, 1))).ravel()
        t.close("sum over all texels", d_T.sum(), g[0, 0], reveal=True)
        t.close("balance (u, v)", d_T @ centres(shape) / g[0, 0], uv[0], reveal=True)
        t.require(
            bool((d_T >= 0).all()) and np.count_nonzero(d_T) <= 4,
            "a positive g must reach at most four texels, none negatively",
        )


@check(
    "03.2.transpose",
    task="03.2",
    points=5,
    calls=("bilinear_sample_adjoint",),
    needs=("bilinear_sample",),
    tolerance=EXACT,
    hint="handout, section 2: the same weights as forwards, from sample to texel",
    sole="the definition of an adjoint",
)
def is_the_transpose(t):
    """<S x, g> = <x, S* g> for any texture x and any g: on textures that are not square."""
    for shape in ((3, 7), (6, 2), (1, 5)):
        uv = t.rng.uniform(0.0, 1.0, (25, 2))
        x, g = t.rng.uniform(-1.0, 1.0, (*shape, 2)), t.rng.uniform(-1.0, 1.0, (25, 2))
        back = t.call("bilinear_sample_adjoint", shape, uv, g, returns=Array((*shape, 2)))
        forth = t.call("bilinear_sample", x, uv, returns=Array((25, 2)))
        size = float(np.linalg.norm(forth) * np.linalg.norm(g))
        t.close(
            "<x, S* g>",
            np.vdot(x, back),
            np.vdot(forth, g),
            Tolerance(EXACT.relative, EXACT.evidence, floor=size),
        )
        matrix = sampling_matrix(t, shape, uv)
        t.close("S* g", back.reshape(-1, 2), matrix.T @ g)
    nothing = t.call("bilinear_sample_adjoint", shape, uv, 0 * g, returns=Array((*shape, 2)))
    require_zero_for_zero(t, {"T": nothing})


@check(
    "03.2.repeated",
    task="03.2",
    points=4,
    calls=("bilinear_sample_adjoint",),
    tolerance=EXACT,
    hint="d_T[rows, columns] += values adds once where an index occurs twice",
    sole="names the mistake of a scatter that forgets",
)
def repeated_places_add_up(t):
    """A place measured ten times hands out the sum of its ten numbers."""
    shape = (5, 3)
    uv = t.rng.uniform(0.0, 1.0, (4, 2))
    g = t.rng.uniform(0.5, 1.5, (40, 2))
    many = t.call(
        "bilinear_sample_adjoint", shape, np.tile(uv, (10, 1)), g, returns=Array((5, 3, 2))
    )
    total = np.zeros((5, 3, 2))
    for k in range(4):
        summed = g[k::4].sum(axis=0)[None]
        total += t.call(
            "bilinear_sample_adjoint", shape, uv[k : k + 1], summed, returns=Array((5, 3, 2))
        )
    t.close("d_T", many, total)


@check(
    "03.2.edge",
    task="03.2",
    points=2,
    calls=("bilinear_sample_adjoint",),
    tolerance=EXACT,
    hint="clamp as forwards (which of u, v with which side?); equal indices add up",
    sole="says that only the border is wrong",
)
def a_corner_gets_it_all(t):
    """A sample in a corner of the texture, or beyond it, belongs to one texel alone."""
    shape, g = (3, 4), t.rng.uniform(0.5, 1.5, (4, 1))
    uv = np.array([[0.01, 0.02], [0.98, -0.2], [-3.0, 0.99], [1.0, 1.0]])
    expected = np.zeros((3, 4, 1))
    expected[::2, ::3] = g.reshape(2, 2, 1)
    d_T = t.call("bilinear_sample_adjoint", shape, uv, g, returns=Array((3, 4, 1)))
    t.close("d_T", d_T, expected, reveal=True)


# 03.3 ---------------------------------------------------------------------------------------------


@check(
    "03.3.value",
    task="03.3",
    points=3,
    calls=("loss_and_grad",),
    needs=("bilinear_sample",),
    tolerance=EXACT,
    hint="handout, equation (9): sum over channels, divide by N",
    sole="asks about the loss alone",
)
def the_loss_of_a_constant(t):
    """Constant texture, constant measurements: the loss is the squared distance of two colours."""
    is_, should = t.rng.uniform(0.0, 1.0, (2, 3))
    uv = t.rng.uniform(0.0, 1.0, (17, 2))
    result = Items(Number(), Array((4, 2, 3)), names=("L", "d_T"))
    T, target = np.tile(is_, (4, 2, 1)), np.tile(should, (17, 1))
    loss, _ = t.call("loss_and_grad", T, uv, target, returns=result)
    t.close("L", loss, np.sum((is_ - should) ** 2), reveal=True)


@check(
    "03.3.differences",
    task="03.3",
    points=5,
    calls=("loss_and_grad",),
    tolerance=QUADRATIC,
    needs=("bilinear_sample", "bilinear_sample_adjoint"),
    hint="handout, equation (10): 2/N times the adjoint of the residuals",
    sole="the gradient itself, without the reference",
)
def the_gradient_agrees_with_differences(t):
    """Raising one texel by a little changes your loss by as much as your gradient says."""
    T = t.rng.uniform(0.0, 1.0, (3, 4, 2))
    uv, target = t.rng.uniform(0.0, 1.0, (30, 2)), t.rng.uniform(0.0, 1.0, (30, 2))
    result = Items(Number(), Array((3, 4, 2)), names=("L", "d_T"))
    _, d_T = t.call("loss_and_grad", T, uv, target, returns=result)

    def forward(point):
        return t.call("loss_and_grad", point["T"], uv, target, returns=result)[0]

    require_gradients(t, {"T": d_T}, forward, {"T": T}, np.ones(()), QUADRATIC)


# 03.4 ---------------------------------------------------------------------------------------------


@check(
    "03.4.rounds",
    task="03.4",
    points=4,
    calls=("largest_curvature",),
    tolerance=EXACT,
    needs=("bilinear_sample", "bilinear_sample_adjoint", "loss_and_grad"),
    hint="handout, equations (11) to (13): what stands after 0 rounds, after 1?",
    sole="says which round or factor is wrong; the estimate alone would not",
)
def rounds_are_as_counted(t):
    """Samples at texel centres only: the estimate after n rounds is known in closed form."""
    shape = (3, 4)
    often = t.rng.integers(1, 6, 12)
    uv = np.repeat(centres(shape), often, axis=0)
    for n in (0, 1, 2, 6):
        got = t.call("largest_curvature", shape, uv, n, returns=Number())
        mean = np.sum(often ** (2.0 * n + 1)) / np.sum(often ** (2.0 * n))
        t.close(f"estimate after {n} rounds", got, 2 * mean / len(uv), reveal=True)


@check(
    "03.4.bound",
    task="03.4",
    points=3,
    calls=("largest_curvature",),
    tolerance=ESTIMATE,
    needs=("bilinear_sample", "bilinear_sample_adjoint", "loss_and_grad"),
    hint="keep x at length 1: 300 rounds make anything else 0 or infinite",
    sole="asks what the function is for, after many rounds",
)
def many_rounds_find_the_largest_eigenvalue(t):
    """After 300 rounds the estimate is the Hessian's largest eigenvalue within 2 %."""
    shape = (8, 7)
    uv = t.rng.uniform(0.0, 1.0, (150, 2)) ** 2
    got = t.call("largest_curvature", shape, uv, 300, returns=Number())
    matrix = sampling_matrix(t, shape, uv)
    t.close("largest eigenvalue", got, np.linalg.norm(matrix, 2) ** 2 * 2 / len(uv))


# 03.5 ---------------------------------------------------------------------------------------------


def recovered(shape, n):
    """What `recover_texture` returns."""
    parts = (Array(tuple(shape)), Array((n + 1,)), Array(tuple(shape[:2]), "bool"))
    return Items(*parts, names=("T", "losses", "unseen"))


def recover(t, T0, uv, target, n):
    """`recover_texture`; what comes back in another form is told about the form."""
    try:
        return t.call("recover_texture", T0, uv, target, n, returns=recovered(T0.shape, n))
    except CheckFailed as failure:
        advice = "three values: T, losses (of T0, of T after each step: n + 1), unseen (bool)"
        failure.details.setdefault("advice", advice)
        raise


EARLIER = ("bilinear_sample", "bilinear_sample_adjoint", "loss_and_grad", "largest_curvature")


@check(
    "03.5.step",
    task="03.5",
    points=3,
    calls=("recover_texture",),
    needs=EARLIER,
    tolerance=FIRST_STEP,
    hint="handout, equations (14) and (15)",
    sole="asks about the first step alone",
)
def the_first_step(t):
    """One step goes against the gradient, by 0.95 of the largest stable step."""
    shape = (5, 4, 2)
    uv, T0 = t.rng.uniform(0.0, 1.0, (150, 2)) ** 2, t.rng.uniform(0.0, 1.0, shape)
    target = t.rng.uniform(0.0, 1.0, (150, 2))
    T, losses, _ = recover(t, T0, uv, target, 1)
    result = Items(Number(), Array(shape), names=("L", "d_T"))
    before, d_T = t.call("loss_and_grad", T0, uv, target, returns=result)
    after, _ = t.call("loss_and_grad", T, uv, target, returns=result)
    curvature = np.linalg.norm(sampling_matrix(t, shape[:2], uv), 2) ** 2 * 2 / 150
    t.close("step times gradient", T0 - T, 0.95 * 2 / curvature * d_T)
    t.close("losses", losses, [before, after], CHAINED)


@check(
    "03.5.chain",
    task="03.5",
    points=2,
    calls=("recover_texture",),
    needs=EARLIER,
    tolerance=CHAINED,
    hint="the same step from first to last; losses of T0 to T",
    sole="counts steps and losses, whatever the step's length",
)
def steps_can_be_chained(t):
    """Seven steps are three steps and then four more, and their losses fall."""
    shape = (3, 5, 1)
    uv, T0 = t.rng.uniform(0.0, 1.0, (90, 2)), t.rng.uniform(0.0, 1.0, shape)
    target = t.rng.uniform(0.0, 1.0, (90, 1))
    seven = recover(t, T0, uv, target, 7)
    three = recover(t, T0, uv, target, 3)
    four = recover(t, three[0], uv, target, 4)
    none = recover(t, T0, uv, target, 0)
    t.close("T after 0 steps", none[0], T0)
    t.close("T after 3 + 4 steps", four[0], seven[0])
    t.close("losses", np.concatenate([three[1][:3], four[1]]), seven[1])
    t.require(bool((np.diff(seven[1]) < 0).all()), "the loss must fall with each step")


@check(
    "03.5.start",
    task="03.5",
    points=1,
    calls=("recover_texture",),
    needs=EARLIER,
    hint="T0 itself has changed: copy it first",
    sole="what students can run; hidden checks find its mistakes as well",
)
def the_start_is_left_alone(t):
    """A second descent from the same array T0 finds what the first one found."""
    shape = (4, 3, 2)
    uv, T0 = t.rng.uniform(0.0, 1.0, (60, 2)), t.rng.uniform(0.0, 1.0, shape)
    target = t.rng.uniform(0.0, 1.0, (60, 2))
    once = recover(t, T0, uv, target, 2)
    again = t.call("adapters.recover_again", T0, uv, target, 2, returns=recovered(shape, 2))
    t.require(agree(again, once), "recover_texture has written into its argument T0")


@check(
    "03.5.unseen",
    task="03.5",
    points=2,
    calls=("recover_texture",),
    needs=EARLIER,
    hint="which texels does any sample give weight? that does not depend on values",
    sole="asks about what no measurement reaches",
)
def unseen_texels_stay(t):
    """Texels without any sample keep their value to the last bit, and are reported."""
    shape = (6, 5, 2)
    uv, T0 = t.rng.uniform(0.0, 0.55, (40, 2)), t.rng.uniform(0.0, 1.0, shape)
    fits = t.call("bilinear_sample", T0, uv, returns=Array((40, 2)))
    nowhere = ~sampling_matrix(t, shape[:2], uv).any(axis=0).reshape(shape[:2])
    for target in (t.rng.uniform(0.0, 1.0, (40, 2)), fits):
        T, _, unseen = recover(t, T0, uv, target, 3)
        t.require(bool((T[nowhere] == T0[nowhere]).all()), "a texel without samples has changed")
        t.require(
            bool((unseen == nowhere).all()),
            f"unseen: {int(unseen.sum())} texels marked, {int(nowhere.sum())} expected, "
            f"{int((unseen != nowhere).sum())} differ",
        )


# 03.6 ---------------------------------------------------------------------------------------------


def pyramid(shape):
    """The shapes of all levels below (H, W, C), and what they must be."""
    shapes = [tuple(shape)]
    while max(shapes[-1][:2]) > 1:
        shapes.append((*(max(n // 2, 1) for n in shapes[-1][:2]), shape[2]))
    return shapes, Items(*map(Array, shapes), names=tuple(f"level {k}" for k in range(len(shapes))))


def mips(t, T):
    """`build_mips`; says what is special where one side gets down to a single texel first."""
    square = T.shape[0] == T.shape[1]
    single = "where one side is a single texel already, average the two along the other"
    try:
        return t.call("build_mips", T, returns=pyramid(T.shape)[1])
    except CheckFailed as failure:
        ends = "level 0 is T itself, the last level a single texel"
        failure.details.setdefault("advice", ends if square else single)
        raise
    except StudentFailure as failure:
        if square or failure.reason not in {"raised", "timeout"}:
            raise
        rows, columns = T.shape[:2]
        said = f"{failure.text} for a texture of {rows} x {columns}: {single}"
        raise StudentFailure(failure.reason, said, failure.private, failure.line) from failure


@check(
    "03.6.mean",
    task="03.6",
    points=3,
    calls=("build_mips",),
    tolerance=EXACT,
    hint="handout, equation (16): each texel is the mean of those it replaces",
    sole="what a pyramid is for: the same light at each size",
)
def each_level_has_the_same_mean(t):
    """Levels shrink by halves down to one texel, and all have the same mean."""
    for shape in ((8, 8, 3), (2, 16, 1), (4, 1, 2)):
        T = t.rng.uniform(0.5, 1.5, shape)
        got = mips(t, T)
        t.close("level 0", got[0], T)
        for k, level in enumerate(got):
            bright = level.mean() / T.mean()
            said = (
                f"level {k} of a texture of {shape[0]} x {shape[1]} is {bright:.3g} times as "
                "bright as that texture: a mean divides by how many texels it adds"
            )
            t.close(f"mean of level {k}", level.mean(axis=(0, 1)), T.mean(axis=(0, 1)), hint=said)


@check(
    "03.6.spot",
    task="03.6",
    points=2,
    calls=("build_mips",),
    tolerance=EXACT,
    hint="rows 2 i and 2 i + 1 become row i",
    sole="where a texel goes; a mean does not see that",
)
def a_spot_keeps_its_place(t):
    """A single bright texel grows fainter from level to level, and stays where it was."""
    for _ in range(3):
        row, column = (int(k) for k in t.rng.integers(0, [8, 4]))
        T = np.zeros((8, 4, 1))
        T[row, column] = 1.0
        got = mips(t, T)
        for k, shape in enumerate(pyramid(T.shape)[0]):
            expected = np.zeros(shape)
            share = shape[0] * shape[1] / 32
            expected[row * shape[0] // 8, column * shape[1] // 4] = share
            t.close(f"level {k}", got[k], expected, reveal=True)


# >>> hidden
def sampled(t, n):
    """A texture and n places."""
    return t.rng.uniform(-1.0, 1.0, (3, 5, 2)), t.rng.uniform(-0.1, 1.1, (n, 2))


def measured(t, n):
    """A texture, n places and what was measured there."""
    return *sampled(t, n), t.rng.uniform(0.0, 1.0, (n, 2))


def tile(n):
    """Rows and columns of a texture, powers of two, and two channels."""
    return 1 << n // 2, 1 << (n + 1) // 2, 2


def tiled(t, n):
    """What `build_mips` takes."""
    return (t.rng.uniform(-1.0, 1.0, tile(n)),)


@check(
    "03.1.hidden",
    task="03.1",
    points=3,
    calls=("bilinear_sample",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at places that are not known beforehand",
    battery=[Subject("bilinear_sample", sampled, lambda n: Array((n, 2)), rows=(1,))],
)
def samples_at_random_places(t):
    """Samples are right at random places of random textures, one texel wide ones included."""
    for shape in ((6, 3, 2), (1, 9, 1), (7, 1, 3), (1, 1, 2), (16, 11, 3)):
        T, uv = t.rng.uniform(-1.0, 1.0, shape), t.rng.uniform(-0.1, 1.1, (150, 2))
        got = t.call("bilinear_sample", T, uv, returns=Array((150, shape[2])))
        t.close("samples", got, t.reference.bilinear_sample(T, uv))


@check(
    "03.2.hidden",
    task="03.2",
    points=4,
    calls=("bilinear_sample_adjoint",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at places that are not known beforehand",
    battery=[
        Subject(
            "bilinear_sample_adjoint",
            lambda t, n: ((3, 5), *measured(t, n)[1:]),
            lambda _: Array((3, 5, 2)),
        )
    ],
)
def the_adjoint_at_random_places(t):
    """The adjoint is right at random places, one texel wide textures included."""
    for shape in ((6, 3), (1, 9), (7, 1), (1, 1), (16, 11)):
        uv, g = t.rng.uniform(-0.1, 1.1, (150, 2)), t.rng.uniform(-1.0, 1.0, (150, 2))
        got = t.call("bilinear_sample_adjoint", shape, uv, g, returns=Array((*shape, 2)))
        t.close("d_T", got, t.reference.bilinear_sample_adjoint(shape, uv, g))


@check(
    "03.2.cost",
    task="03.2",
    points=2,
    calls=("bilinear_sample_adjoint",),
    needs=("bilinear_sample",),
    visibility="hidden",
    tolerance=EXACT,
)
def the_adjoint_is_cheap(t):
    """With 2,208 texels the adjoint is right, and costs a few forward calls."""
    uv, g = t.rng.uniform(0.0, 1.0, (3000, 2)), t.rng.uniform(-1.0, 1.0, (3000, 1))
    T, shape = t.rng.uniform(0.0, 1.0, (46, 48, 1)), (46, 48)
    got = t.call("bilinear_sample_adjoint", shape, uv, g, returns=Array((46, 48, 1)))
    t.close("d_T", got, t.reference.bilinear_sample_adjoint(shape, uv, g))
    require_cheap(
        t,
        ("bilinear_sample", (T, uv), Array((3000, 1))),
        ("bilinear_sample_adjoint", (shape, uv, g), Array((46, 48, 1))),
    )


@check(
    "03.3.hidden",
    task="03.3",
    points=4,
    calls=("loss_and_grad",),
    visibility="hidden",
    needs=("bilinear_sample", "bilinear_sample_adjoint"),
    tolerance=EXACT,
    sole="the same mistakes at values that are not known beforehand",
    battery=[Subject("loss_and_grad", measured, lambda _: Items(Number(), Array((3, 5, 2))))],
)
def loss_and_gradient_of_random_textures(t):
    """Loss and gradient are right, cheap or not, on random textures and measurements."""
    for shape, n in (((4, 6, 3), 50), ((5, 2, 1), 7)):
        T, uv = t.rng.uniform(0.0, 1.0, shape), t.rng.uniform(0.0, 1.0, (n, 2))
        target = t.rng.uniform(0.0, 1.0, (n, shape[2]))
        result = Items(Number(), Array(shape), names=("L", "d_T"))
        loss, d_T = t.call("loss_and_grad", T, uv, target, returns=result)
        right = t.reference.loss_and_grad(T, uv, target)
        t.close("L", loss, right[0])
        t.close("d_T", d_T, right[1])


@check(
    "03.4.hidden",
    task="03.4",
    points=3,
    calls=("largest_curvature",),
    visibility="hidden",
    needs=("bilinear_sample", "bilinear_sample_adjoint", "loss_and_grad"),
    tolerance=CHAINED,
    sole="the same mistakes at places that are not known beforehand",
    battery=[
        Subject(
            "largest_curvature",
            lambda t, n: ((3, 5), sampled(t, 40)[1], n),
            lambda _: Number(),
            sizes=(0, 1, 60),
        )
    ],
)
def the_estimate_at_random_places(t):
    """The estimate is right after any number of rounds."""
    for shape, n in (((4, 6), 0), ((5, 2), 1), ((3, 9), 7)):
        uv = t.rng.uniform(0.0, 1.0, (80, 2))
        got = t.call("largest_curvature", shape, uv, n, returns=Number())
        t.close(f"after {n} rounds", got, t.reference.largest_curvature(shape, uv, n))


@check(
    "03.5.recovers",
    task="03.5",
    points=4,
    calls=("recover_texture",),
    needs=EARLIER,
    visibility="hidden",
    seconds=20.0,
    sole="the whole: a texture that nobody has seen, recovered from samples",
    battery=[
        Subject(
            "recover_texture",
            lambda t, n: (*measured(t, 40), n),
            lambda n: Items(Array((3, 5, 2)), Array((n + 1,)), Array((3, 5), "bool")),
            sizes=(0, 1, 60),
            tolerance=CHAINED,
        )
    ],
)
def a_texture_is_recovered(t):
    """Fifty steps recover an unknown texture from 1,500 samples to 55 dB or better."""
    shape = (7, 6, 1)
    unknown, uv = t.rng.uniform(0.0, 1.0, shape), t.rng.uniform(0.0, 1.0, (1500, 2))
    target, T0 = t.reference.bilinear_sample(unknown, uv), np.full(shape, 0.5)
    T, _, unseen = recover(t, T0, uv, target, 50)
    # Over 300 seeds the solution reaches 62.4 dB at worst, 66 dB at the 5th percentile.
    error = float(np.mean((T - unknown) ** 2))
    t.require(error <= 10**-5.5, f"PSNR {-10 * np.log10(max(error, 1e-30)):.1f} dB, asked 55 dB")
    t.require(not unseen.any(), "texels are called unseen although each has samples")


@check(
    "03.6.hidden",
    task="03.6",
    points=1,
    calls=("build_mips",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes on textures not known",
    battery=[Subject("build_mips", tiled, lambda n: pyramid(tile(n))[1], sizes=(0, 1, 2, 7))],
)
def pyramids_of_random_textures(t):
    """All levels are right for random textures."""
    for shape in ((4, 32, 2), (8, 2, 1), (1, 1, 3)):
        T = t.rng.uniform(-1.0, 1.0, shape)
        got = mips(t, T)
        for k, level in enumerate(t.reference.build_mips(T)):
            t.close(f"level {k}", got[k], level)


# <<< hidden
