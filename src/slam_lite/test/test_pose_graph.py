import math

import numpy as np
import pytest

from planar import Pose2
from slam_lite.graph.pose_graph import Edge, EdgeList, chi_squares, deflate, edges_of, inflate, optimize

PRECISE = np.diag([1e4, 1e4, 1e5])
VAGUE = np.diag([1e3, 1e3, 1e3])


def ring(count=40, radius=5.0):
    """True poses round a circle."""
    angles = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    return [Pose2(radius * math.sin(a), radius * (1.0 - math.cos(a)), a) for a in angles]


def edge(poses, first, second, information=PRECISE, **kwargs):
    return Edge(first, second, poses[first].inverse() @ poses[second], information, **kwargs)


def drifting(poses):
    """Poses by odometry that turns 3 % too much."""
    guessed = [poses[0]]
    for one, other in zip(poses, poses[1:]):
        step = one.inverse() @ other
        guessed.append(guessed[-1] @ Pose2(step.x, step.y, 1.03 * step.yaw))
    return np.array([pose.as_array() for pose in guessed])


def farthest(poses, optimized):
    return max(math.hypot(p.x - x, p.y - y) for p, (x, y, _) in zip(poses, optimized))


@pytest.fixture
def poses():
    return ring()


@pytest.fixture
def steps(poses):
    return [edge(poses, i, i + 1) for i in range(len(poses) - 1)]


def test_poses_that_agree_with_all_edges_are_found(poses, steps):
    start = drifting(poses)
    assert farthest(poses, start) > 0.3
    optimized = optimize(start, edges_of(*steps, edge(poses, len(poses) - 1, 0)), 1e-6)
    assert farthest(poses, optimized) < 1e-4


def test_a_loop_closure_corrects_drift(poses):
    start = drifting(poses)
    guesses = [Pose2.from_array(row) for row in start]
    steps = [edge(guesses, i, i + 1, VAGUE) for i in range(len(poses) - 1)]
    optimized = optimize(
        start, edges_of(*steps, edge(poses, len(poses) - 1, 0, is_loop=True)), 1e-6, new_count=1
    )
    assert farthest(poses, optimized) < 0.3 * farthest(poses, start)


def test_a_false_closure_hardly_bends_the_map(poses, steps):
    false = Edge(0, 20, Pose2(0.5, 0.0, 0.0), PRECISE, is_loop=True)
    truth = np.array([pose.as_array() for pose in poses])
    optimized = optimize(truth, edges_of(*steps, edge(poses, len(poses) - 1, 0, is_loop=True), false), 1e-6)
    assert farthest(poses, optimized) < 0.05


def test_false_closures_that_agree_do_not_undo_right_ones(poses, steps):
    steps[10] = edge(poses, 10, 11, np.diag([1e3, 1e3, 10.0]))  # as of a wheel slip
    steps[30] = edge(poses, 30, 31, np.diag([1e3, 1e3, 10.0]))
    right = [edge(poses, last, last - 38, is_loop=True) for last in (38, 39)]
    true = np.array([pose.as_array() for pose in poses])
    moved = [Pose2(0.0, 25.0, 0.0) @ pose for pose in poses]
    false = [
        Edge(20 + i, i, poses[20 + i].inverse() @ moved[i], 0.1 * PRECISE, is_loop=True) for i in range(4)
    ]
    optimized = optimize(true, edges_of(*steps, *right, *false), 1e-6, new_count=len(false))
    assert farthest(poses, optimized) < 0.1


def test_an_error_that_is_added_to_an_edge_can_be_removed(poses):
    degenerate = np.diag([0.0, 2e4, 3e5])
    edges = edges_of(edge(poses, 3, 9), edge(poses, 0, 1, degenerate, is_loop=True))
    inflated = edges_of(*(inflate(edges[number], 0.03, 0.005) for number in range(2)))
    assert inflated.information[0, 0, 0] < 0.2 * edges.information[0, 0, 0]
    variances = np.square([[0.03, 0.03, 0.005]] * 2)
    np.testing.assert_allclose(deflate(inflated, variances).information, edges.information, rtol=1e-6)


def test_the_first_node_stays_fixed(poses, steps):
    optimized = optimize(drifting(poses), edges_of(*steps), 1e-6)
    assert tuple(optimized[0]) == tuple(poses[0].as_array())


def test_chi_square_is_the_weighted_squared_error():
    table = edges_of(Edge(0, 1, Pose2(1.0, 0.0, 0.0), np.diag([4.0, 1.0, 1.0])))
    chi = chi_squares(np.array([[0.0, 0.0, 0.0], [1.5, 0.0, 0.0]]), table)
    assert chi == pytest.approx([4.0 * 0.5**2])


def test_a_view_of_an_edge_list_does_not_change_when_it_grows(poses, steps):
    edges = EdgeList()
    edges.append(steps[0])
    view = edges.view()
    for step in steps[1:] * 5:
        edges.append(step)
    assert len(view) == 1 and len(edges) == 1 + 5 * (len(steps) - 1)
    assert view.nodes.tolist() == [[0, 1]]
