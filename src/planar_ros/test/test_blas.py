import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from planar_ros.bags.offline_replay import ReplayOptions, run_replay
from planar_ros.node.entry import use_one_blas_thread


def threads():
    return {pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"}


@pytest.fixture(autouse=True)
def two_threads():
    threadpool_limits(2, user_api="blas")
    assert threads() == {2}


def test_blas_is_limited_to_one_thread():
    use_one_blas_thread()
    assert threads() == {1}


def test_a_replay_uses_one_blas_thread():
    counts = []
    assert run_replay(ReplayOptions, "replay", lambda options: counts.append(threads()) or 0, ["bag"]) == 0
    assert counts == [{1}]
