"""Progress and outcome of goals as diagnostic_msgs/DiagnosticStatus, a type every ROS installation has."""

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

from move_base_lite.navigator.decision import SUCCEEDED_OUTCOME, Decision, GoalOutcome, GoalProgress


def outcome_msg(outcome: GoalOutcome) -> DiagnosticStatus:
    """Convert an outcome; the value ``outcome`` is move_base_flex's code (mbf_msgs/MoveBaseResult)."""
    level = DiagnosticStatus.OK if outcome.code == SUCCEEDED_OUTCOME else DiagnosticStatus.ERROR
    return _status(
        level,
        outcome.text,
        outcome=str(outcome.code),
        reason=outcome.reason,
        dist_to_goal=_rounded(outcome.distance_to_goal),
        angle_to_goal=_rounded(outcome.angle_to_goal),
        recoveries=str(outcome.recoveries),
        seconds=_rounded(outcome.seconds),
    )


def progress_msg(decision: Decision, progress: GoalProgress) -> DiagnosticStatus:
    """Convert progress: state, remaining distance [m] and time [s], and what was used so far."""
    return _status(
        DiagnosticStatus.WARN if decision.text else DiagnosticStatus.OK,
        decision.text,
        state=decision.status.value,
        distance_remaining=_rounded(progress.distance_left),
        estimated_time_remaining=_rounded(progress.seconds_left),
        navigation_time=_rounded(progress.seconds),
        distance_travelled=_rounded(progress.travelled),
        number_of_recoveries=str(progress.recoveries),
    )


def _status(level: int, text: str, **values: str) -> DiagnosticStatus:
    pairs = [KeyValue(key, value) for key, value in values.items()]
    return DiagnosticStatus(level=level, name="move_base", message=text, values=pairs)


def _rounded(value: float) -> str:
    return f"{value:.3f}"
