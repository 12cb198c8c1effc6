import pytest

from run_project.judging.log_errors import find_log_errors
from run_project.judging.run_record import ProjectRunRecord
from run_project.judging.verdict import judge
from run_project.stand_ins.nodelet import command_for
from run_project.stand_ins.rviz_topics import displayed_topics

ACTIVE, PREEMPTED, SUCCEEDED, ABORTED = 1, 2, 3, 4


def record_of(*endings, places=((1.0, 2.0),)):
    record = ProjectRunRecord()
    for number, ending in enumerate(endings):
        record.add_goal(float(number), f"goal-{number}", places[number % len(places)])
        record.update_status(float(number), f"goal-{number}", ending, "text")
    return record


def test_all_goals_reached_is_success():
    verdict = judge(record_of(SUCCEEDED, SUCCEEDED))
    assert verdict.success
    assert verdict.reason.startswith("2 of 2 goals reached")


@pytest.mark.parametrize("ending", [PREEMPTED, ABORTED, ACTIVE])
def test_a_goal_that_ended_otherwise_is_a_failure_with_the_reason(ending):
    verdict = judge(record_of(SUCCEEDED, ending))
    assert not verdict.success
    assert "1 of 2 goals reached; goal 2 at (1.00, 2.00)" in verdict.reason


def test_a_goal_that_was_sent_again_until_it_was_reached_is_no_failure():
    verdict = judge(record_of(ABORTED, SUCCEEDED))
    assert verdict.success
    assert verdict.reason.startswith("1 of 2 goals reached")


@pytest.mark.parametrize(
    ("metres", "ending", "success"), [(0.3, PREEMPTED, True), (0.7, PREEMPTED, False), (0.3, ABORTED, False)]
)
def test_a_goal_cancelled_near_the_robot_is_reached(metres, ending, success):
    record = ProjectRunRecord()
    record.add_goal(0.0, "goal", (1.0, 2.0))
    record.update_position((1.0 + metres, 2.0))
    record.update_status(1.0, "goal", ending, "")
    assert record.goals["goal"].distance == metres
    assert judge(record).success is success


@pytest.mark.parametrize(
    ("expected", "success"),
    [(("aborted", "succeeded"), True), (("succeeded", "succeeded"), False), ((), False)],
)
def test_the_final_status_of_goals_can_be_declared(expected, success):
    verdict = judge(record_of(ABORTED, SUCCEEDED, places=(A, B)), expected=expected)
    assert verdict.success is success
    assert verdict.reason.startswith("1 of 2 goals reached; aborted, succeeded, ")


def test_a_run_that_was_cut_short_is_never_as_expected():
    assert not judge(record_of(ABORTED), "interrupted", expected=("aborted",)).success


A, B, C = (1.0, 2.0), (3.0, 4.0), (5.0, 6.0)


@pytest.mark.parametrize(
    ("places", "goals"),
    [
        ((A, B, A, B), 4),
        ((A, B, A, B, A), 4),
        ((A, B, C) * 2, 6),
        ((A, B, C, A, C), 0),
        ((A, A, A, A), 0),
        ((C, A, B, A, B), 5),
        ((C, A, A, B, A, A, A, B, B), 8),
    ],
)
def test_an_endless_round_of_goals_is_recognized_after_two_rounds(places, goals):
    assert record_of(*[SUCCEEDED] * len(places), places=places).goals_of_two_rounds == goals
    assert record_of(ABORTED, *[SUCCEEDED] * (len(places) - 1), places=places).goals_of_two_rounds == 0


def test_the_goal_of_a_third_round_does_not_count():
    verdict = judge(record_of(*[SUCCEEDED] * 4, ACTIVE, places=(A, B)))
    assert verdict.success
    assert verdict.reason.startswith("4 of 4 goals reached")


def test_the_events_of_a_moving_marker_are_shortened():
    record = record_of(SUCCEEDED)
    for step in range(20):
        record.update_marker(float(step), ("parcel", 0), (float(step), 0.0))
    reason = judge(record).reason
    assert "shown at (3.00, 0.00), ... 12 more ..., shown at (16.00, 0.00)" in reason


def test_a_run_that_was_cut_short_is_a_failure():
    assert not judge(record_of(SUCCEEDED), "interrupted").success


def test_a_project_without_goals_and_markers_fails():
    assert not judge(ProjectRunRecord()).success


def test_markers_alone_are_sufficient_unless_goals_are_required():
    record = ProjectRunRecord()
    record.update_marker(0.0, ("shapes", 0), (1.0, 2.0))
    assert judge(record).success
    assert judge(record, requires_goals=True).reason == "no goal sent; markers: shown at (1.00, 2.00)"
    assert not judge(record, requires_goals=True).success


def test_a_status_is_reported_once():
    record = ProjectRunRecord()
    assert record.update_status(1.0, "a", ACTIVE, "") == "goal 1 active"
    assert record.update_status(1.2, "a", ACTIVE, "") is None
    assert not record.all_goals_ended
    record.update_status(1.4, "a", SUCCEEDED, "Goal reached.")
    assert record.all_goals_ended


def test_positions_and_hiding_of_a_marker_are_recorded():
    record = ProjectRunRecord()
    for place in ((1.0, 2.0), (1.0, 2.01), None, None, (3.0, 4.0)):
        record.update_marker(0.0, ("shapes", 0), place)
    assert record.markers == ["shown at (1.00, 2.00)", "hidden", "shown at (3.00, 4.00)"]
    record.delete_all_markers(1.0)
    assert record.markers[-1] == "hidden"


def blink(record, times):
    """A marker that blinks, and one that is shown with a new id every time."""
    for second in range(times):
        record.update_marker(10.0 + second, ("blinking", 0), A)
        record.update_marker(10.5 + second, ("blinking", 0), None)
        record.update_marker(10.7 + second, ("renewed", second), B)


def test_repeated_marker_events_are_not_new():
    record = record_of(SUCCEEDED)
    blink(record, 100)
    assert record.last_event_time < 12.0
    assert record.markers == ["shown at (1.00, 2.00)", "hidden", "shown at (3.00, 4.00)"]


def test_a_repeated_marker_event_is_new_after_another_goal():
    record = record_of(SUCCEEDED)
    blink(record, 2)
    record.add_goal(20.0, "another", B)
    assert record.update_marker(21.0, ("blinking", 0), A) == "marker shown at (1.00, 2.00)"


def test_an_object_is_picked_up_while_its_marker_is_hidden():
    record = ProjectRunRecord()
    picked_up = [record.is_object_picked_up]
    for place in (A, None, B):
        record.update_marker(0.0, ("", 0), place)
        picked_up.append(record.is_object_picked_up)
    assert picked_up == [False, False, True, False]


def test_teleports_do_not_count_as_driven():
    record = ProjectRunRecord()
    for position in ((0.0, 0.0), (0.3, 0.2), (9.0, 9.0), (9.1, 9.0)):
        record.update_position(position)
    assert record.distance_driven == pytest.approx(0.1 + 0.13**0.5)


def test_rviz_displays_what_its_configuration_enables():
    config = """
Visualization Manager:
  Displays:
    - {Class: rviz/Marker, Enabled: true, Marker Topic: visualization_marker_2}
    - Class: rviz/Group
      Enabled: true
      Displays:
        - {Class: rviz/Path, Enabled: true, Topic: /move_base/NavfnROS/plan}
        - {Class: rviz/Map, Enabled: false, Topic: /hidden}
    - {Class: rviz/Image, Enabled: true, Image Topic: /camera/rgb/image_raw}
    - {Class: rviz/PointCloud2, Enabled: true, Topic: /camera/depth/points}
"""
    assert displayed_topics(config) == {"/move_base/NavfnROS/plan"}


MERGED_OFTEN = "k0: &k0 {a: 1}\n" + "".join(
    f"k{i}: &k{i} {{<<: [*k{i - 1}, *k{i - 1}]}}\n" for i in range(1, 40)
)


@pytest.mark.parametrize("config", ["", "a: [", "- 1", "Visualization Manager: 3", MERGED_OFTEN])
def test_an_invalid_rviz_configuration_displays_nothing(config):
    assert displayed_topics(config) == set()


def test_the_velocity_smoother_is_replaced_by_a_relay():
    arguments = "load yocs_velocity_smoother/VelocitySmootherNodelet manager __name:=smoother".split()
    arguments.append("smoother/smooth_cmd_vel:=mux/input/navi")
    assert command_for(arguments)[3:5] == ["smoother/raw_cmd_vel", "mux/input/navi"]
    assert command_for(["manager"])[0] == "sleep"


def test_log_errors_are_listed_once_with_the_name_of_the_window(tmp_path):
    (tmp_path / "rosrun-pick.log").write_text("fine\n\x1b[31m[ERROR] [1]: lost\n[ERROR] [1]: lost\n")
    assert find_log_errors(tmp_path) == ["rosrun-pick: [ERROR] [1]: lost"]


def test_repeated_collisions_with_a_body_are_counted_but_reported_once():
    record = ProjectRunRecord()
    events = [record.add_collision(name) for name in ("sofa::link", "sofa::link", "wall::link", "sofa::link")]
    assert events == ["collision with sofa::link", None, "collision with wall::link", None]
    assert len(record.collisions) == 4
