"""Order of deliveries with the shortest total path."""

import math
from typing import Dict, List, Sequence, Set, Tuple

# Number of deliveries up to which the optimal order is computed.
MAX_EXACT = 10


def shortest_order(
    from_start: Sequence[float], between: Sequence[Sequence[float]], before: Sequence[Set[int]]
) -> List[int]:
    """Find the order of n deliveries that minimizes the length of the empty drives.

    Exact for up to ten deliveries (Held and Karp, 1962); beyond, the nearest delivery is always next. Of
    orders with equal length the one closest to the given order is returned.

    Args:
        from_start: (n,), distance from the robot to the source of each delivery [m].
        between: (n, n), distance from the destination of delivery i to the source of delivery j [m].
        before: For each delivery the indices of those that must be completed before it.

    Returns:
        Indices of the deliveries in order.
    """
    if len(from_start) > MAX_EXACT:
        return _nearest_next(from_start, between, before)
    return _best(from_start, between, before)


def _best(from_start, between, before) -> List[int]:
    count = len(from_start)
    # Shortest order of each set of deliveries (a bit each) that ends with a given one: length, order.
    best: Dict[Tuple[int, int], Tuple[float, List[int]]] = {
        (1 << i, i): (from_start[i], [i]) for i in range(count) if not before[i]
    }
    for _ in range(count - 1):
        longer: Dict[Tuple[int, int], Tuple[float, List[int]]] = {}
        for (made, last), (length, order) in best.items():
            for i in range(count):
                if made >> i & 1 or not all(made >> earlier & 1 for earlier in before[i]):
                    continue
                extended = (length + between[last][i], [*order, i])
                key = (made | 1 << i, i)
                longer[key] = min(longer.get(key, (math.inf, extended[1])), extended)
        best = longer
    return min(best.values())[1]


def _nearest_next(from_start, between, before) -> List[int]:
    order: List[int] = []
    while len(order) < len(from_start):
        distances = between[order[-1]] if order else from_start
        free = (i for i in range(len(from_start)) if i not in order and before[i] <= set(order))
        order.append(min(free, key=lambda i: (distances[i], i)))
    return order
