"""Task 12.2, hidden checks."""

from photograd_course.grading import Array, Items, Subject, hidden_check
from photograd_course.grading.adjoint_gate import require_cheap

from ..common import EXACT, activations_spec, layers_of, like
from ..task_2 import derivatives

SIZES = (3, 6, 5, 2)
# One forward pass against the backward pass of 5,000 weights: 2 to 4 with whole arrays, 60 in
# loops over rows, 10,000 for differences.
COST = 400.0


def given(t, n):
    """Arguments of `mlp_backward` for n rows; the layers are the same for all n."""
    layers = [(k + 1.0) * array for k, array in enumerate(layers_of(t.rng, SIZES))]
    activations = t.reference.mlp_forward(layers, t.rng.normal(size=(n, SIZES[0])))
    return layers, activations, t.rng.uniform(-1.0, 1.0, (n, SIZES[-1]))


def returned(n):
    """What `mlp_backward` returns for n rows."""
    layers = [Array(each) for k in range(3) for each in ((SIZES[k], SIZES[k + 1]), (SIZES[k + 1],))]
    return Items(Items(*layers), Array((n, SIZES[0])))


@hidden_check(
    "12.2.hidden",
    points=3,
    calls=("mlp_backward",),
    tolerance=EXACT,
    sole="the same mistakes at unseen networks",
    battery=[Subject("mlp_backward", given, returned)],
)
def derivatives_of_random_networks(t):
    """Derivatives are right for random networks of any depth, and cheap."""
    for sizes in ((4, 3), (1, 5, 1), (3, 4, 4, 4, 2), (2, 300, 2), (120, 3, 90)):
        layers, x = layers_of(t.rng, sizes), t.rng.normal(size=(5, sizes[0]))
        g = t.rng.uniform(-1.0, 1.0, (5, sizes[-1]))
        d_layers, d_x = derivatives(t, layers, x, g)
        activations = t.reference.mlp_forward(layers, x)
        right, right_x = t.reference.mlp_backward(layers, activations, g)
        for k, (mine, theirs) in enumerate(zip(d_layers, right, strict=True)):
            t.close(f"d_{'Wb'[k % 2]}{k // 2}", mine, theirs)
        t.close("d_x", d_x, right_x)
    layers, x = layers_of(t.rng, (20, 60, 60, 4)), t.rng.normal(size=(8, 20))
    activations = t.reference.mlp_forward(layers, x)
    g = t.rng.uniform(-1.0, 1.0, (8, 4))
    require_cheap(
        t,
        ("mlp_forward", (layers, x), activations_spec(8, layers)),
        ("mlp_backward", (layers, activations, g), Items(like(layers), Array(x.shape))),
        COST,
    )
