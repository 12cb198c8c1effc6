import pytest

from planar.driving import DriveOutcome, DriveResult, GoalReached, GoalRefused


@pytest.mark.parametrize(
    "status, result",
    [
        ("SUCCEEDED", DriveResult.REACHED),
        ("PREEMPTED", DriveResult.REPLACED),
        ("RECALLED", DriveResult.REPLACED),
        ("ABORTED", DriveResult.FAILED),
        ("REJECTED", DriveResult.FAILED),
        ("LOST", DriveResult.FAILED),
    ],
)
def test_the_last_status_of_a_goal_says_how_the_drive_ended(status, result):
    assert DriveOutcome(status, "").result is result


def test_a_drive_that_did_not_arrive_is_refused_for_the_reason_told():
    assert DriveOutcome("SUCCEEDED", "Goal reached.").event == GoalReached()
    assert DriveOutcome("ABORTED", "no way").event == GoalRefused("no way")
    assert DriveOutcome("ABORTED", "").event == GoalRefused("ABORTED")
    assert DriveOutcome("PREEMPTED", "").event == GoalRefused("PREEMPTED", is_taken_over=True)
