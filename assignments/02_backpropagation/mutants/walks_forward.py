"""You walk from the inputs to the root; users have to be visited before their inputs."""

TASKS = ("02.5",)
LOSES = ("02.5.worked", "02.5.adds", "02.5.seed", "02.5.expressions", "02.5.random", "02.5.chain")
REPLACE = [("for node in reversed(order):", "for node in order:")]
