"""How many messages the publishers of signals keep for readers that are late."""

from pierburg_ros.parameter import Parameter as Declaration

KEPT_MESSAGES = 10_000
"""Messages that are kept where a recording must not lack any: 20 s at 500 Hz, twice the time for which any one process
may be without a processor. The room is taken when it is needed; 5000 waiting on each of four topics took 24 MB."""

DEPTH = Declaration(
    "depth",
    5,
    "messages that publishers of signals keep for late readers, as for any sensor; in simulated time always"
    f" {KEPT_MESSAGES}",
    minimum=1,
    maximum=100_000,
    fixed=True,
)
