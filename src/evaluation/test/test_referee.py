import numpy as np
import pytest

from evaluation.consumers.referee import Referee
from evaluation.event_stream import EventStream
from evaluation.events import (
    DELETE,
    SHOW,
    SUCCEEDED,
    BodiesTouched,
    DeliveryProgress,
    GoalEnded,
    LineLogged,
    MarkerUpdated,
    MissionRequested,
    MissionUpdated,
    PlanUpdated,
    StateUpdated,
    TruthUpdated,
)
from evaluation.verdict import ERRAND, OBJECTS
from pick_objects import Delivery, DeliveryStage
from planar import Pose2
from planar.maps.places import NamedPlace

PLACES = {name: NamedPlace(name, Pose2(x, 0.0)) for name, x in (("hall", 2.0), ("door", 5.0))}


class Observed(Referee):
    """A referee with its events, the lines that it logs, and a clock."""

    def __init__(self, **options):
        self.lines, self.wall = [], [100.0]
        super().__init__(PLACES, self.lines.append, clock=lambda: self.wall[0], **options)
        events = EventStream()
        self.attach(events)
        self.publish = events.publish


@pytest.fixture
def referee():
    return Observed()


def truth(stamp, x):
    return TruthUpdated(stamp, Pose2(x))


LETTER = Delivery("post", "letter", "hall", "door")


def arrival(stamp, stage=DeliveryStage.PICKING_UP, state="picking up"):
    return MissionUpdated(stamp, state, (DeliveryProgress(LETTER, stage, 1, ""),))


def test_an_arrival_is_judged_by_the_truth_at_its_stamp_even_if_that_arrives_later(referee):
    referee.publish(truth(1.0, 1.6))
    referee.publish(arrival(2.0))
    assert referee.mission_record.deliveries == []
    referee.publish(truth(2.0, 1.95))
    referee.publish(truth(2.1, 2.4))
    (record,) = referee.mission_record.deliveries
    assert record.pickup_error == pytest.approx(0.05)
    assert referee.mission_record.final_state == "picking up"


def test_an_arrival_is_judged_by_where_the_robot_stood_not_by_where_it_is(referee):
    for stamp, x in ((1.0, 2.01), (2.0, 3.0)):
        referee.publish(truth(stamp, x))
    referee.publish(arrival(1.0))
    assert referee.mission_record.deliveries[0].pickup_error == pytest.approx(0.01)


def test_the_marker_of_an_object_may_be_deleted_and_shown_again(referee):
    referee.publish(arrival(0.0))
    for action, is_locked, x in (
        (SHOW, False, 2.0),
        (SHOW, True, 0.0),
        (DELETE, False, 0.0),
    ):
        referee.publish(MarkerUpdated(1.0, "letter", 0, (x, 0.0, 0.0), action, is_locked))
    assert referee.mission_record.markers == ["letter at hall", "letter carried"]


def test_missing_markers_are_not_waited_for_without_end(referee):
    delivered = arrival(0.0, DeliveryStage.DELIVERED, "delivered")
    referee.publish(truth(1.0, 2.0))
    referee.publish(delivered)
    assert not referee.has_seen({ERRAND, OBJECTS})
    referee.publish(truth(50.0, 2.0))
    assert not referee.has_seen({ERRAND, OBJECTS})  # it may be this process that is late
    referee.wall[0] = 150.0
    assert referee.has_seen({ERRAND, OBJECTS})
    assert referee.verdict({OBJECTS}).reason == "the markers of letter did not go with the objects"


MISSION = """
places: {attic: {x: 7.0, y: 0.0}, cellar: {x: 9.0, y: 0.0}}
objects: {lamp: {}}
deliveries: [{name: post, object: lamp, from: attic, to: cellar}]
"""


def moment(stamp, stage):
    delivery = Delivery("post", "lamp", "attic", "cellar")
    return MissionUpdated(stamp, "on the way", (DeliveryProgress(delivery, stage, 1, ""),))


def marker_of_lamp(x):
    return MarkerUpdated(1.0, "lamp", 0, (x, 0.0, 0.0))


def test_places_defined_by_a_sent_mission_are_used(referee):
    referee.publish(MissionRequested(0.0, MISSION))
    referee.publish(truth(1.0, 6.9))
    referee.publish(moment(1.0, DeliveryStage.PICKING_UP))
    referee.publish(marker_of_lamp(7.1))
    assert referee.mission_record.deliveries[0].pickup_error == pytest.approx(0.1)
    assert referee.mission_record.markers == ["lamp at attic"]


def test_a_marker_far_from_unknown_places_is_assigned_to_the_nearest_known_one(referee):
    referee.publish(truth(1.0, 6.9))
    referee.publish(moment(1.0, DeliveryStage.PICKING_UP))
    referee.publish(marker_of_lamp(4.9))
    assert referee.mission_record.markers == ["lamp at door"]


def test_an_invalid_mission_changes_nothing(referee):
    referee.publish(MissionRequested(0.0, "places: 3"))
    assert referee.mission_record.deliveries == []


def test_a_delivery_that_is_sent_again_by_the_same_name_is_judged_again(referee):
    referee.publish(MissionRequested(0.0, MISSION))
    stages = (
        DeliveryStage.PICKING_UP,
        DeliveryStage.DELIVERED,
        DeliveryStage.FETCHING,
        DeliveryStage.PICKING_UP,
    )
    for stamp, stage in enumerate(stages, 1):
        referee.publish(truth(float(stamp), 7.0 + stamp / 100))
        referee.publish(moment(float(stamp), stage))
    first, second = referee.mission_record.deliveries
    assert first.state == "delivered"
    assert second.pickup_error == pytest.approx(0.04)


def test_a_marker_that_arrives_before_its_mission_is_assigned_when_the_mission_is_known(referee):
    referee.publish(marker_of_lamp(4.9))
    referee.publish(MissionRequested(0.0, MISSION))
    referee.publish(moment(1.0, DeliveryStage.FETCHING))
    assert referee.mission_record.markers == []
    referee.publish(truth(1.0, 6.9))
    assert referee.mission_record.markers == ["lamp at attic"]


def test_a_pickup_is_judged_by_the_truth_at_its_moment(referee):
    """A robot that is driven away while it picks up, and reports that it has picked up."""
    for stamp, x in ((1.0, 2.01), (2.0, 2.9), (3.0, 4.0)):
        referee.publish(truth(stamp, x))
    referee.publish(arrival(1.0))
    referee.publish(arrival(2.0, DeliveryStage.CARRYING))
    assert referee.mission_record.deliveries[0].pickup_error == pytest.approx(0.9)


def test_after_a_reset_of_time_the_truth_of_the_time_before_does_not_count(referee):
    for stamp in range(1, 10):
        referee.publish(truth(float(stamp), 2.0))
    referee.publish(truth(0.1, 0.0))
    referee.publish(truth(2.9, 0.0))
    referee.publish(arrival(2.0, DeliveryStage.CARRYING))
    assert referee.mission_record.deliveries[0].pickup_error == pytest.approx(2.0)


def test_states_published_before_a_reset_of_time_do_not_wait_for_that_time_again(referee):
    referee.publish(truth(9.0, 2.1))
    referee.publish(arrival(9.1))
    referee.publish(truth(0.1, 0.0))
    assert referee.mission_record.deliveries[0].pickup_error == pytest.approx(0.1)


@pytest.mark.parametrize("state", ["", "delivered", "failed", "cancelled"])
def test_a_robot_without_a_mission_waits_for_one(state):
    serving = Observed(idle_text="waiting for a mission")
    serving.publish(StateUpdated(1.0, state))
    assert serving.status().startswith("waiting for a mission: ")
    serving.publish(StateUpdated(1.0, "picking up"))
    assert serving.status().startswith("picking up: ")


def plan(*points_x):
    return PlanUpdated(1.0, np.array([(x, 0.0) for x in points_x]))


def test_the_distance_to_go_counts_down_along_the_plan(referee):
    referee.publish(truth(1.0, 0.0))
    assert "to go" not in referee.status()
    referee.publish(plan(0.0, 2.0, 5.0))
    for stamp, x, to_go in ((2.0, 1.0, "4.0"), (3.0, 4.5, "0.5"), (4.0, 5.2, "0.0")):
        referee.publish(truth(stamp, x))
        assert f"running: {to_go} m to go, " in referee.status()
    referee.publish(plan(5.2, 2.2))
    assert "3.0 m to go, " in referee.status()
    referee.publish(GoalEnded(9.0, "a", SUCCEEDED, ""))
    assert "to go" not in referee.status()


def test_contacts_are_logged_and_count(referee):
    referee.publish(BodiesTouched(1.0, ("sofa", "wall")))
    referee.publish(BodiesTouched(2.0, ("sofa",)))
    assert referee.lines == ["collision with sofa", "collision with wall", "collision with sofa"]
    assert referee.collision == "collided with sofa, wall"
    assert not referee.verdict(set()).success


def test_a_warning_is_printed_once_whatever_its_numbers_and_information_of_the_mission_only(referee):
    for node, text, is_warning in (
        ("amcl", "lost for 1.5 s", True),
        ("amcl", "lost for 2.5 s", True),
        ("amcl", "found", False),
        ("pick_objects", "going to hall", False),
    ):
        referee.publish(LineLogged(1.0, node, text, is_warning))
    assert referee.lines == ["amcl: warning: lost for 1.5 s", "pick_objects: going to hall"]


def test_distance_time_and_speed_are_figures_of_the_result(referee):
    referee.publish(truth(5.0, 0.0))
    assert referee.result_fields()["first_motion_wall_seconds"] is None
    referee.publish(truth(7.0, 3.0))
    referee.wall[0] = 101.0
    fields = referee.result_fields()
    assert fields["first_motion_wall_seconds"] > 0.0
    assert (fields["simulated_seconds"], fields["distance_driven"], fields["real_time_factor"]) == (
        2.0,
        3.0,
        2.0,
    )
    assert fields["collisions"] == [] and "goals" not in fields


def test_a_referee_that_was_never_attached_has_no_result():
    assert Referee(PLACES, print).result_fields() == {}


def test_a_marker_out_of_range_is_ignored(referee):
    referee.publish(arrival(0.0))
    referee.publish(MarkerUpdated(1.0, "letter", 0, (float("nan"), 0.0, 0.0)))
    assert referee.mission_record.markers == []
