import pytest

from evaluation.event_stream import EventStream
from evaluation.events import (
    DELETE,
    DELETE_ALL,
    BodiesTouched,
    ClockAdvanced,
    GoalEnded,
    GoalRequested,
    GoalStatusUpdated,
    MarkerUpdated,
    TruthUpdated,
)
from planar import Pose2
from run_project.judging.log_errors import find_log_errors
from run_project.judging.run_record import ProjectRunRecord
from run_project.judging.verdict import judge
from run_project.stand_ins.nodelet import command_for
from run_project.stand_ins.rviz_topics import displayed_topics

ACTIVE, PREEMPTED, SUCCEEDED, ABORTED = 1, 2, 3, 4
A, B, C = (1.0, 2.0), (3.0, 4.0), (5.0, 6.0)


class Record(ProjectRunRecord):
    """A record with the events that it consumes and the lines that it logs."""

    def __init__(self):
        self.lines = []
        super().__init__(self.lines.append)
        self._events = EventStream()
        self.attach(self._events)

    def at(self, stamp):
        self._events.publish(ClockAdvanced(stamp))
        return self

    def send_goal(self, name, place):
        self._events.publish(GoalRequested(self.simulated_time, name, "map", Pose2(*place)))

    def update_status(self, name, status, text="", kind=GoalStatusUpdated):
        self._events.publish(kind(self.simulated_time, name, status, text))

    def stand_at(self, x, y):
        self._events.publish(TruthUpdated(self.simulated_time, Pose2(x, y)))

    def show(self, marker, place):
        self._events.publish(MarkerUpdated(self.simulated_time, *marker, (*place, 0.0)))

    def hide(self, marker, action=DELETE):
        self._events.publish(MarkerUpdated(self.simulated_time, *marker, (0.0, 0.0, 0.0), action))

    def touch(self, *names):
        self._events.publish(BodiesTouched(self.simulated_time, names))


def record_of(*endings, places=((1.0, 2.0),)):
    record = Record()
    for number, ending in enumerate(endings):
        record.at(float(number)).send_goal(f"goal-{number}", places[number % len(places)])
        record.update_status(f"goal-{number}", ending, "text")
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
    record = Record()
    record.send_goal("goal", (1.0, 2.0))
    record.stand_at(1.0 + metres, 2.0)
    record.update_status("goal", ending)
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


@pytest.mark.parametrize(("aborted", "success"), [(3, True), (30, False)])
def test_a_project_without_an_end_is_judged_by_the_share_of_goals_reached(aborted, success):
    endings = [SUCCEEDED] * 58 + [ABORTED] * aborted + [ACTIVE]
    record = record_of(*endings, places=[(float(x), 0.0) for x in range(len(endings))])
    verdict = judge(record, "not done within 600 s of wall time", time_limit=600.0)
    assert verdict.success is success
    assert verdict.reason == (
        f"still running after 600 s of wall time; 58 of {58 + aborted} goals reached, 0.0 m driven"
    )


def test_a_home_service_mission_has_to_end():
    verdict = judge(record_of(SUCCEEDED, ACTIVE, places=(A, B)), "over", requires_goals=True, time_limit=60.0)
    assert not verdict.success
    assert "1 of 1 goals reached" in verdict.reason and "--timeout" in verdict.reason


@pytest.mark.parametrize(("rest", "success"), [(5.0, True), (40.0, False)])
def test_a_robot_that_wanders_without_goals_succeeds_as_long_as_it_drives(rest, success):
    record = Record()
    for second in range(10):
        record.at(float(second)).stand_at(0.3 * second, 0.0)
    record.at(9.0 + rest)
    verdict = judge(record, "over", time_limit=60.0)
    assert verdict.success is success
    assert "0 of 0 goals reached, 2.7 m driven" in verdict.reason
    assert judge(record).success
    assert not judge(record, requires_goals=True).success


def test_the_object_of_a_home_service_mission_has_to_move():
    record = record_of(SUCCEEDED, SUCCEEDED, places=(A, B))
    record.show(("", 0), A)
    stays = judge(record, requires_goals=True)
    assert not stays.success and "neither hidden at the pick-up nor shown elsewhere" in stays.reason
    assert judge(record).success
    record.show(("", 0), B)
    assert judge(record, requires_goals=True).success


def test_a_run_that_was_cut_short_is_never_as_expected():
    assert not judge(record_of(ABORTED), "interrupted", expected=("aborted",)).success


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
        record.show(("parcel", 0), (float(step), 0.0))
    reason = judge(record).reason
    assert "shown at (3.00, 0.00), ... 12 more ..., shown at (16.00, 0.00)" in reason


def test_a_run_that_was_cut_short_is_a_failure():
    assert not judge(record_of(SUCCEEDED), "interrupted").success


def test_a_project_without_goals_and_markers_fails():
    assert not judge(Record()).success


def test_markers_alone_are_sufficient_unless_goals_are_required():
    record = Record()
    record.show(("shapes", 0), (1.0, 2.0))
    assert judge(record).success
    assert judge(record, requires_goals=True).reason == "no goal sent; markers: shown at (1.00, 2.00)"
    assert not judge(record, requires_goals=True).success


def test_a_status_that_comes_before_its_goal_is_reported_with_it():
    """They come on different connections."""
    record = Record()
    record.update_status("a", ACTIVE)
    assert record.lines == []
    record.send_goal("a", (1.0, 2.0))
    record.send_goal("a", (1.0, 2.0))
    assert record.lines == ["goal 1 at (1.00, 2.00) active"]
    record.update_status("b", ACTIVE)
    record.update_status("b", SUCCEEDED)
    record.send_goal("b", (1.0, 2.0))
    assert record.lines[1:] == ["goal 2 succeeded"]


def test_a_status_is_reported_once():
    record = Record()
    record.send_goal("a", (1.0, 2.0))
    record.update_status("a", ACTIVE)
    record.update_status("a", ACTIVE)
    assert record.lines == ["goal 1 at (1.00, 2.00) active"]
    assert not record.all_goals_ended
    record.at(1.4).update_status("a", SUCCEEDED, "Goal reached.", kind=GoalEnded)
    assert record.all_goals_ended
    assert record.lines[1:] == ["goal 1 at (1.00, 2.00) succeeded"]
    assert record.goals["a"].ended == 1.4


def show_and_hide(record, marker, places):
    for place in places:
        if place is None:
            record.hide(marker)
        else:
            record.show(marker, place)
        yield record.is_object_picked_up


def test_positions_and_hiding_of_a_marker_are_recorded():
    record = Record()
    list(show_and_hide(record, ("shapes", 0), ((1.0, 2.0), (1.0, 2.01), None, None, (3.0, 4.0))))
    assert record.markers == ["shown at (1.00, 2.00)", "hidden", "shown at (3.00, 4.00)"]
    record.hide(("", 0), DELETE_ALL)
    assert record.markers[-1] == "hidden"


def blink(record, times):
    """A marker that blinks, and one that is shown with a new id every time."""
    for second in range(times):
        record.at(10.0 + second).show(("blinking", 0), A)
        record.at(10.5 + second).hide(("blinking", 0))
        record.at(10.7 + second).show(("renewed", second), B)


def test_repeated_marker_events_are_not_new():
    record = record_of(SUCCEEDED)
    blink(record, 100)
    assert record.last_event_time < 12.0
    assert record.markers == ["shown at (1.00, 2.00)", "hidden", "shown at (3.00, 4.00)"]


def test_a_repeated_marker_event_is_new_after_another_goal():
    record = record_of(SUCCEEDED)
    blink(record, 2)
    record.at(20.0).send_goal("another", B)
    record.at(21.0).show(("blinking", 0), A)
    assert record.lines[-1] == "marker shown at (1.00, 2.00)"
    assert record.last_event_time == 21.0


def test_an_object_is_picked_up_while_its_marker_is_hidden():
    record = Record()
    assert not record.is_object_picked_up
    assert list(show_and_hide(record, ("", 0), (A, None, B))) == [False, True, False]


def test_teleports_do_not_count_as_driven():
    record = Record()
    for position in ((0.0, 0.0), (0.3, 0.2), (9.0, 9.0), (9.1, 9.0)):
        record.stand_at(*position)
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


def test_the_last_line_of_a_traceback_is_the_error(tmp_path):
    (tmp_path / "world.log").write_text(
        "ready\nTraceback (most recent call last):\n"
        '  File "drive.py", line 3, in <module>\n    drive()\n\x1b[31mValueError: no such place\x1b[0m\nok\n'
    )
    (tmp_path / "marker.log").write_text("[ERROR] [1]: Traceback (most recent call last):\n  File")
    traceback = "Traceback (most recent call last):"
    assert find_log_errors(tmp_path) == [
        f"marker: [ERROR] [1]: {traceback}",
        f"marker: {traceback}",
        "world: ValueError: no such place",
    ]


def test_repeated_collisions_with_a_body_are_counted_but_reported_once():
    record = Record()
    record.touch("sofa::link", "sofa::link")
    record.touch("wall::link", "sofa::link")
    assert record.lines == ["collision with sofa::link", "collision with wall::link"]
    assert len(record.collisions) == 4
