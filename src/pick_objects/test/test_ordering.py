import itertools

import numpy as np
import pytest

from pick_objects.ordering import shortest_order


def length(order, from_start, between):
    return from_start[order[0]] + sum(between[a][b] for a, b in zip(order, order[1:]))


@pytest.mark.parametrize("seed", range(5))
def test_no_order_is_shorter_than_the_one_found(seed):
    rng = np.random.default_rng(seed)
    from_start, between = rng.uniform(0, 10, 5), rng.uniform(0, 10, (5, 5))
    before = [set(), {0}, set(), {1}, set()]
    found = shortest_order(from_start, between, before)
    allowed = [
        order
        for order in itertools.permutations(range(5))
        if order.index(0) < order.index(1) < order.index(3)
    ]
    assert tuple(found) in allowed
    shortest = min(length(order, from_start, between) for order in allowed)
    assert length(found, from_start, between) == pytest.approx(shortest)


def test_equal_orders_stay_as_they_were_given():
    assert shortest_order([1.0] * 4, [[1.0] * 4] * 4, [set()] * 4) == [0, 1, 2, 3]


def test_of_many_deliveries_the_nearest_is_next():
    count = 30
    between = np.abs(np.subtract.outer(np.arange(count), np.arange(count))).astype(float)
    before = [set() for _ in range(count)]
    before[3] = {7}
    order = shortest_order(np.arange(count, dtype=float), between, before)
    assert sorted(order) == list(range(count))
    assert order[:3] == [0, 1, 2]
    assert order.index(7) < order.index(3)
