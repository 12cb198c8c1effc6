"""In which order deliveries make the shortest way."""

import math
from typing import Dict, List, Sequence, Set, Tuple

MAX_EXACT = 10
"""So many are ordered in the best way; of more, always the nearest is next."""


def shortest_order(
    from_start: Sequence[float], between: Sequence[Sequence[float]], before: Sequence[Set[int]]
) -> List[int]:
    """The order of n deliveries whose ways from each end to the next start are shortest together.

    ``from_start[i]``: metres from the robot to where delivery i begins; ``between[i][j]``: from where i ends
    to where j begins; ``before[i]``: those that must come before i. With up to ten it is the best order
    (Held and Karp, 1962). Of two equal orders, the one nearer to the given one is taken.
    """
    if len(from_start) > MAX_EXACT:
        return _nearest_next(from_start, between, before)
    return _best(from_start, between, before)


def _best(from_start, between, before) -> List[int]:
    count = len(from_start)
    # Best way to have made the set of deliveries (a bit each) with that one as the last: length, order.
    ways: Dict[Tuple[int, int], Tuple[float, List[int]]] = {
        (1 << i, i): (from_start[i], [i]) for i in range(count) if not before[i]
    }
    for _ in range(count - 1):
        longer: Dict[Tuple[int, int], Tuple[float, List[int]]] = {}
        for (made, last), (length, order) in ways.items():
            for i in range(count):
                if made >> i & 1 or not all(made >> earlier & 1 for earlier in before[i]):
                    continue
                way = (length + between[last][i], [*order, i])
                key = (made | 1 << i, i)
                longer[key] = min(longer.get(key, (math.inf, way[1])), way)
        ways = longer
    return min(ways.values())[1]


def _nearest_next(from_start, between, before) -> List[int]:
    order: List[int] = []
    while len(order) < len(from_start):
        ways = between[order[-1]] if order else from_start
        free = (i for i in range(len(from_start)) if i not in order and before[i] <= set(order))
        order.append(min(free, key=lambda i: (ways[i], i)))
    return order
