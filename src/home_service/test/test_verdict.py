import pytest

from home_service.verdict import DEMO, ERRAND, MARKERS, Ledger, judge

STORY = ["shown at pickup", "hidden", "shown at dropoff"]


def good_ledger():
    return Ledger({"pickup": 0.1, "dropoff": 0.2}, [], list(STORY), "delivered")


def test_a_proven_delivery_is_a_success():
    verdict = judge(good_ledger(), {ERRAND, MARKERS})
    assert verdict.success
    assert "0.20 m" in verdict.reason


@pytest.mark.parametrize(
    "change, reason",
    [
        ({"final_state": "going to dropoff"}, "state 'going to dropoff'"),
        ({"errors": {"pickup": 0.1}}, "never said that it arrived at dropoff"),
        ({"errors": {"pickup": 0.3, "dropoff": 0.1}}, "at pickup the robot truly stood 0.30 m off"),
        ({"collisions": ["sofa", "sofa"]}, "collided with sofa"),
        ({"markers": STORY[:1]}, "the marker was shown at pickup, not"),
        ({"failure": "roslaunch ended"}, "roslaunch ended"),
    ],
)
def test_whatever_is_missing_is_a_failure_that_says_what(change, reason):
    ledger = good_ledger()
    for name, value in change.items():
        setattr(ledger, name, value)
    verdict = judge(ledger, {ERRAND, MARKERS})
    assert not verdict.success
    assert reason in verdict.reason


def test_a_demonstration_needs_only_the_marker():
    assert judge(Ledger(markers=list(STORY)), {DEMO}).success


def test_a_run_is_complete_when_all_that_is_expected_was_seen():
    assert good_ledger().is_complete({ERRAND, MARKERS})
    assert not Ledger(final_state="delivered", markers=STORY[:2]).is_complete({ERRAND, MARKERS})
    assert Ledger(final_state="failed").is_complete({ERRAND, MARKERS})
    assert not Ledger().is_complete({ERRAND})
