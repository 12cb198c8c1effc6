import pytest

from planar.driving import DriveOutcome, DriveResult, GoalFailed, GoalReached


@pytest.mark.parametrize(
    "status, result",
    [
        ("SUCCEEDED", DriveResult.REACHED),
        ("PREEMPTED", DriveResult.PREEMPTED),
        ("RECALLED", DriveResult.PREEMPTED),
        ("ABORTED", DriveResult.FAILED),
        ("REJECTED", DriveResult.FAILED),
        ("LOST", DriveResult.FAILED),
    ],
)
def test_the_last_status_of_a_goal_determines_the_result(status, result):
    assert DriveOutcome(status, "").result is result


def test_a_failed_drive_has_the_reason_of_its_status():
    assert DriveOutcome("SUCCEEDED", "Goal reached.").event == GoalReached()
    assert DriveOutcome("ABORTED", "no way").event == GoalFailed("no way")
    assert DriveOutcome("ABORTED", "").event == GoalFailed("ABORTED")
    assert DriveOutcome("PREEMPTED", "").event == GoalFailed("PREEMPTED", is_preempted=True)
