import pytest

from pick_objects import (
    Delivery,
    DeliveryStage,
    DriveToPlace,
    Errand,
    ErrandSettings,
    ErrandState,
    FinishTask,
    GoalFailed,
    GoalReached,
    MeasurePathLengths,
    Mission,
    MissionError,
    PathLengthsMeasured,
    RobotDisplaced,
    errand_mission,
)
from planar import Pose2, SettingsError
from planar.maps.places import NamedPlace

PICKUP, DROPOFF = NamedPlace("pickup", Pose2(2.0, 3.0)), NamedPlace("dropoff", Pose2(-2.0, 1.0))


def errand(**settings):
    return Errand(errand_mission(PICKUP, DROPOFF, ErrandSettings(**settings)))


def test_the_robot_is_sent_to_pickup_and_after_five_seconds_there_to_dropoff():
    task = errand()
    assert task.advance(0.0) == DriveToPlace(PICKUP, 1)
    assert task.advance(10.0) is None
    assert task.advance(20.0, GoalReached()) is None
    assert task.state is ErrandState.PICKING_UP
    assert task.advance(24.9) is None
    assert task.advance(25.0) == DriveToPlace(DROPOFF, 1)
    assert task.advance(40.0, GoalReached()) == FinishTask(True, "delivered at place dropoff")
    assert task.state is ErrandState.DELIVERED
    assert task.advance(41.0) is None


def test_a_robot_that_is_displaced_while_it_picks_up_returns():
    task = errand(attempts=2)
    task.advance(0.0)
    task.advance(20.0, GoalReached())
    assert task.advance(24.0, RobotDisplaced()) == DriveToPlace(PICKUP, 1)
    assert task.state is ErrandState.GOING_TO_PICKUP
    assert task.advance(25.0) is None
    assert task.advance(26.0, GoalReached()) is None
    assert task.advance(30.9) is None
    assert task.advance(31.0) == DriveToPlace(DROPOFF, 1)


def test_a_robot_that_is_displaced_repeatedly_gives_up():
    task = errand(attempts=2)
    task.advance(0.0)
    for now in (10.0, 20.0):
        task.advance(now, GoalReached())
        order = task.advance(now + 1.0, RobotDisplaced())
    assert order == FinishTask(
        False, "place pickup: the robot was moved away, or its pose became uncertain, 2 times"
    )


def test_a_refused_goal_is_tried_again_after_a_pause():
    task = errand(attempts=2, retry_seconds=1.0)
    task.advance(0.0)
    assert task.advance(5.0, GoalFailed("blocked")) is None
    assert task.advance(5.9) is None
    assert task.advance(6.0) == DriveToPlace(PICKUP, 2)


def test_the_last_refusal_ends_the_errand_with_place_and_reason():
    task = errand(attempts=1)
    task.advance(0.0)
    order = task.advance(5.0, GoalFailed("Failed to find a valid plan."))
    assert order == FinishTask(
        False, "place pickup not reached after 1 attempt: Failed to find a valid plan."
    )
    assert task.state is ErrandState.FAILED


TAKEN_OVER = GoalFailed("another goal was received", is_preempted=True)


def test_goals_preempted_by_other_clients_are_sent_again_and_are_no_attempts():
    task = errand(attempts=1, retry_seconds=1.0, goal_timeout=30.0)
    task.advance(0.0)
    for now in range(2, 30, 2):
        assert task.advance(now, TAKEN_OVER) is None
        assert task.advance(now + 1.0) == DriveToPlace(PICKUP, 1)
    task.advance(40.0, GoalReached())
    assert task.state is ErrandState.PICKING_UP


def test_an_errand_that_is_always_preempted_gives_up_in_the_end():
    task = errand(attempts=1, retry_seconds=1.0, goal_timeout=30.0)
    task.advance(0.0)
    task.advance(29.0, TAKEN_OVER)
    assert task.advance(30.0) == DriveToPlace(PICKUP, 1)
    assert "after 1 attempt: another goal was received" in task.advance(31.0, TAKEN_OVER).reason


def test_a_goal_that_takes_too_long_counts_as_refused():
    task = errand(attempts=1, goal_timeout=30.0)
    task.advance(0.0)
    assert task.advance(30.0) is None
    assert "not reached within 30 s" in task.advance(30.1).reason


def test_attempts_are_counted_separately_for_each_place():
    task = errand(attempts=2, retry_seconds=0.0, pickup_seconds=0.0)
    task.advance(0.0)
    task.advance(1.0, GoalFailed("x"))
    assert task.advance(1.0) == DriveToPlace(PICKUP, 2)
    task.advance(2.0, GoalReached())
    assert task.advance(2.0) == DriveToPlace(DROPOFF, 1)


def test_invalid_settings_are_refused():
    with pytest.raises(SettingsError, match="attempts must be at least 1"):
        errand(attempts=0)


KITCHEN = NamedPlace("kitchen", Pose2(0.0, 0.0), approaches=(Pose2(0.0, 1.0), Pose2(1.0, 0.0)))
PLACES = {place.name: place for place in (KITCHEN, PICKUP, DROPOFF)}
TEA = Delivery("tea", "cup", "kitchen", "pickup")
POST = Delivery("post", "letter", "dropoff", "kitchen")
BACK = Delivery("back", "cup", "pickup", "dropoff")


def mission(*deliveries, **settings):
    quick = {"pickup_seconds": 0.0, "retry_seconds": 0.0, "attempts": 1, **settings}
    return Errand(Mission("test", PLACES, deliveries, settings=ErrandSettings(**quick)))


def play(task, blocked=(), event=None, limit=100):
    """Advances second by second; goals at ``blocked`` poses are refused."""
    orders = []
    for now in range(limit):
        order = task.advance(float(now), event)
        event = None
        if order is not None:
            orders.append(order)
        if isinstance(order, FinishTask):
            return orders
        if isinstance(order, DriveToPlace):
            event = GoalFailed("blocked") if order.pose in blocked else GoalReached()
    raise AssertionError(f"not finished: {orders}")


def stages(task):
    return {job.delivery.name: job.stage for job in task.jobs}


def test_deliveries_are_made_one_after_the_other():
    task = mission(TEA, POST)
    orders = play(task)
    assert [order.place.name for order in orders[:-1]] == ["kitchen", "pickup", "dropoff", "kitchen"]
    assert orders[-1] == FinishTask(True, "2 of 2 delivered")
    assert task.object_locations["cup"].place == "pickup"
    assert task.progress == 1.0


def test_each_attempt_goes_to_the_next_pose_of_the_place():
    task = mission(TEA, attempts=4)
    orders = play(task, blocked=[KITCHEN.pose, KITCHEN.approaches[0]])
    assert [order.pose for order in orders[:3]] == list(KITCHEN.poses)
    assert orders[-1].success
    assert task.jobs[0].attempts == 4


def test_a_failure_stops_the_mission_or_does_not():
    blocked = [PICKUP.pose]
    stopping, going_on = mission(TEA, POST), mission(TEA, POST, on_failure="continue")
    assert play(stopping, blocked)[-1].reason.startswith("0 of 2 delivered, 1 failed; tea: place pickup not")
    assert stages(stopping) == {"tea": DeliveryStage.FAILED, "post": DeliveryStage.WAITING}
    assert play(going_on, blocked)[-1].reason.startswith("1 of 2 delivered, 1 failed; tea: place pickup not")
    assert stages(going_on) == {"tea": DeliveryStage.FAILED, "post": DeliveryStage.DELIVERED}
    assert going_on.state is ErrandState.FAILED


def test_an_object_that_could_not_be_delivered_is_left_and_not_fetched_where_it_is_not():
    task = mission(TEA, BACK, on_failure="continue")
    play(task, [PICKUP.pose])
    where = task.object_locations["cup"]
    assert where.place is None
    assert not where.is_carried
    assert task.jobs[1].reason == "cup is not at pickup"


def test_a_delivery_that_depends_on_a_failed_one_fails_too():
    late = Delivery("late", "letter", "dropoff", "kitchen", after=("tea",))
    task = mission(late, TEA, on_failure="continue")
    play(task, [PICKUP.pose])
    assert [job.reason for job in task.jobs if job.delivery is late] == ["tea was not delivered"]


def test_the_shortest_order_uses_measured_paths_and_respects_dependencies():
    task = mission(TEA, POST, BACK, order="shortest")
    order = task.advance(0.0)
    assert isinstance(order, MeasurePathLengths)
    assert order.legs[:3] == ((None, KITCHEN.pose), (None, DROPOFF.pose), (None, PICKUP.pose))
    far_tea = [9.0, 1.0, 1.0, *[5.0] * 9]
    first = task.advance(1.0, PathLengthsMeasured(tuple(far_tea)))
    assert first == DriveToPlace(DROPOFF, 1)
    assert [job.delivery.name for job in task.jobs] == ["post", "tea", "back"]


def test_a_cancelled_delivery_is_skipped_the_others_are_made_and_the_mission_is_no_success():
    task = mission(TEA, POST)
    task.advance(0.0)
    task.advance(1.0, GoalReached())
    task.advance(2.0)
    assert task.object_locations["cup"].is_carried
    task.cancel("tea")
    assert task.advance(3.0) == DriveToPlace(DROPOFF, 1)
    assert not task.object_locations["cup"].is_carried
    assert play(task, event=GoalReached())[-1] == FinishTask(False, "1 of 2 delivered, 1 cancelled")
    assert task.state is ErrandState.CANCELLED


def test_an_added_delivery_may_be_cancelled_without_failing_the_mission():
    task = mission(TEA)
    task.advance(0.0)
    task.add(POST)
    task.cancel("post")
    assert play(task, event=GoalReached())[-1] == FinishTask(True, "1 of 2 delivered, 1 cancelled")
    assert task.state is ErrandState.DELIVERED


@pytest.mark.parametrize("steps", range(8))
def test_a_mission_can_be_cancelled_in_every_state(steps):
    task = mission(TEA, POST, order="shortest", pickup_seconds=1.0, dropoff_seconds=1.0)
    events = [
        None,
        PathLengthsMeasured((1.0,) * 6),
        GoalReached(),
        None,
        GoalReached(),
        None,
        GoalReached(),
        None,
    ]
    for now, event in enumerate(events[:steps]):
        task.advance(float(now), event)
    task.cancel()
    order = task.advance(float(steps))
    assert isinstance(order, FinishTask)
    assert not order.success
    assert task.state is ErrandState.CANCELLED
    assert not any(where.is_carried for where in task.object_locations.values())
    with pytest.raises(MissionError, match="the mission is over"):
        task.cancel()


def test_a_delivery_can_be_added_and_invalid_ones_are_refused():
    task = mission(TEA)
    task.advance(0.0)
    assert task.add(Delivery("", "letter", "dropoff", "kitchen")).name == "delivery 2"
    for wrong, complaint in (
        (TEA, "there is a delivery tea already"),
        (Delivery("x", "cup", "kitchen", "moon"), "there is no place 'moon'"),
        (Delivery("x", "cup", "kitchen", "kitchen"), "cup is at kitchen already"),
        (Delivery("x", "", "kitchen", "pickup"), "no object is named"),
    ):
        with pytest.raises(MissionError, match=complaint):
            task.add(wrong)
    with pytest.raises(MissionError, match="there is no delivery milk"):
        task.cancel("milk")
    assert play(task, event=GoalReached())[-1] == FinishTask(True, "2 of 2 delivered")


def test_a_delivery_has_its_own_time_out():
    hasty = Delivery("tea", "cup", "kitchen", "pickup", goal_timeout=5.0)
    task = mission(hasty)
    task.advance(0.0)
    assert task.advance(5.0) is None
    assert "not reached within 5 s" in task.advance(5.1).reason


def test_the_time_left_shrinks_to_nothing():
    task = mission(TEA, POST)
    left = [task.time_left(0.0)]
    task.advance(0.0)
    for now in (1.0, 2.0, 3.0, 4.0):
        task.advance(now, GoalReached())
        task.advance(now)
        left.append(task.time_left(now))
    assert left == sorted(left, reverse=True)
    assert left[0] > 10.0
    assert left[-1] == 0.0
