"""The service with a robot without physics."""

from dataclasses import replace
from datetime import timezone

import pytest
from service_bench import NOW, PLACES, Bench, ideal_robot, site

from evaluation.options import ROOT
from pick_objects import DriveToPlace, load_mission
from planar import Pose2
from planar.driving import GoalFailed, RobotDisplaced
from service.config import EnergySettings, ServiceSettings
from service.errors import JournalError, QueueFullError, RequestError, TaskEndedError, UnknownTaskError
from service.execution.robot import DockRobot, UndockRobot
from service.requests.mission_requests import documents_of
from service.task import TaskStatus
from service.task_book import Snapshot


def goals(bench):
    return [order.place.name for order in bench.orders if isinstance(order, DriveToPlace)]


def snapshot_of(bench):
    """What a journal would hold."""
    book = bench.service.book
    return Snapshot(
        tuple(book.tasks.values()), dict(book.objects), tuple(book.series.values()), None, book.next_number
    )


def test_a_delivery_picks_up_and_sets_down():
    bench = Bench()
    (task,) = bench.finish(bench.send("deliver cup from kitchen to desk"))
    assert task.status is TaskStatus.COMPLETED
    assert goals(bench) == ["kitchen", "desk"]
    assert isinstance(bench.orders[0], UndockRobot)
    assert bench.service.book.objects["cup"].place == "desk"


def test_every_kind_of_request_is_carried_out():
    bench = Bench()
    texts = (
        "deliver cup from kitchen to desk",
        "fetch cup to hall",
        "go kitchen",
        "patrol hall desk 2 times",
    )
    tasks = [bench.send(text) for text in (*texts, "wait 10 at hall", "wait 1", "dock")]
    assert {task.status for task in bench.finish(*tasks)} == {TaskStatus.COMPLETED}
    assert bench.service.book.objects["cup"].place == "hall"


def test_a_deadline_that_cannot_be_kept_is_stated_at_once():
    bench = Bench()
    late, kept = bench.send("go desk", by="+10s"), bench.send("go hall", by="+10min")
    bench.service.plan(bench.now)
    assert bench.service.find(late.id).is_late
    assert not bench.service.find(kept.id).is_late
    bench.keep()
    assert [(entry.kind, entry.task) for entry in bench.log if entry.kind == "late"] == [("late", late.id)]


def test_deadlines_decide_on_the_order():
    bench = Bench(robot=ideal_robot(pose=PLACES["kitchen"].pose))
    relaxed, urgent = bench.send("go desk"), bench.send("go hall", by="+25s")
    bench.finish(relaxed, urgent)
    assert goals(bench) == ["hall", "desk"]
    assert not bench.ended[urgent.id].is_late


def test_a_more_urgent_request_interrupts_and_the_other_is_resumed():
    bench = Bench()
    patrol = bench.send("patrol desk hall kitchen")
    bench.run_until(lambda: bench.service.find(patrol.id).step == 1)
    bench.run(5.0)
    urgent = bench.send("go kitchen", priority=5)
    bench.finish(urgent)
    assert bench.service.find(patrol.id).is_open
    (ended,) = bench.finish(patrol)
    assert ended.interruptions == 1
    assert goals(bench) == ["desk", "hall", "kitchen", "hall", "kitchen"], "desk is not driven to again"


def test_a_carried_object_stays_on_board_during_an_interruption():
    bench = Bench()
    cup = bench.send("deliver cup from kitchen to desk")
    bench.run_until(lambda: bench.service.find(cup.id).is_carrying)
    other, visit = bench.send("deliver box from hall to kitchen"), bench.send("go hall", priority=9)
    bench.finish(visit)
    assert bench.service.find(cup.id).is_carrying
    ended = bench.finish(cup, other)
    assert [task.status for task in ended] == [TaskStatus.COMPLETED] * 2
    assert ended[0].finished_at <= ended[1].started_at, "one object at a time"


def test_requests_start_no_earlier_than_asked_for():
    bench = Bench()
    task = bench.send("go desk", not_before="+10min")
    (ended,) = bench.finish(task)
    assert 600.0 <= ended.started_at - NOW < 605.0


def test_requests_for_an_object_are_carried_out_in_their_order():
    bench = Bench()
    first = bench.send("deliver cup from kitchen to desk")
    with pytest.raises(RequestError, match="takes cup to desk; expected from desk"):
        bench.send("deliver cup from kitchen to hall")
    second = bench.send("deliver cup from desk to hall", priority=9)
    assert [task.status for task in bench.finish(first, second)] == [TaskStatus.COMPLETED] * 2
    assert bench.service.book.objects["cup"].place == "hall"


def test_an_object_that_did_not_arrive_is_not_picked_up_elsewhere():
    bench = Bench()
    first = bench.send("deliver cup from kitchen to desk")
    second = bench.send("deliver cup from desk to hall")
    bench.run_until(lambda: bench.service.find(first.id).is_carrying)
    bench.run(2.0)
    bench.service.cancel(first.id, bench.now)
    bench.finish(first, second)
    assert bench.ended[second.id].status is TaskStatus.FAILED
    assert bench.ended[second.id].reason == "cup is not at desk"
    left = bench.service.book.objects["cup"]
    assert left.place is None and left.carried_by == ""
    (fetched,) = bench.finish(bench.send("fetch cup to hall"))
    assert fetched.status is TaskStatus.COMPLETED, "from where it was left"


def test_fetching_needs_an_object_whose_place_is_known():
    with pytest.raises(RequestError, match="not known where cup is"):
        Bench().send("fetch cup to desk")


def test_a_place_that_is_not_reached_fails_its_task_only():
    bench = Bench()
    bench.robot.event = lambda now, event=bench.robot.event: (
        GoalFailed("no plan") if event(now) and bench.robot._goal == PLACES["desk"].pose else None
    )
    bench.robot.is_docked = False
    (ended,) = bench.finish(bench.send("go desk"))
    assert ended.reason == "place desk not reached after 3 attempts: no plan"
    assert ended.attempts == 3


def test_a_displaced_robot_returns_before_it_picks_up():
    bench = Bench()
    task = bench.send("deliver cup from kitchen to desk")
    bench.run_until(lambda: bench.service.state(bench.now)["activity"] == "picking up cup")
    order = bench.service.advance(bench.now, bench.robot.inputs(bench.now), RobotDisplaced())
    assert isinstance(order, DriveToPlace) and order.place.name == "kitchen"
    bench.robot.carry_out(order, bench.now)
    assert bench.finish(task)[0].status is TaskStatus.COMPLETED


@pytest.mark.parametrize("ticks", range(5, 160, 11))
def test_a_service_that_is_killed_goes_on(ticks):
    bench = Bench()
    task = bench.send("deliver cup from kitchen to desk")
    for _ in range(ticks):
        bench.tick()
    if task.id in bench.ended:
        return
    again = Bench(snapshot_of(bench), robot=bench.robot)
    again.now = bench.now + 100.0
    again.robot._event, again.robot._due = None, float("inf")  # its goal died with the service
    (ended,) = again.finish(task)
    assert ended.status is TaskStatus.COMPLETED
    picked = [entry.text for entry in (*bench.log, *again.log) if entry.kind == "step"]
    assert picked.count("cup picked up") == picked.count("cup set down at desk") == 1


def test_a_pause_goes_on_after_a_restart():
    bench = Bench()
    task = bench.send("wait 5min at desk")
    bench.run_until(lambda: bench.service.find(task.id).step == 1)
    bench.run(100.0)
    again = Bench(snapshot_of(bench), robot=bench.robot)
    again.now = bench.now + 50.0
    (ended,) = again.finish(task)
    assert 300.0 <= ended.finished_at - ended.started_at - 22.0 < 330.0


@pytest.mark.parametrize("options", [{}, {"repeat": "0 9 * * *"}])
def test_a_service_does_not_go_on_where_places_of_its_requests_are_missing(options):
    bench = Bench(where=site(timezone.utc))
    bench.send("deliver cup from kitchen to desk", **options)
    bench.keep()
    there = site(timezone.utc)
    without = {name: place for name, place in there.places.items() if name != "desk"}
    with pytest.raises(JournalError, match=r'open requests are for "desk".*known: kitchen, hall.*--mission'):
        Bench(snapshot_of(bench), where=replace(there, places=without))


def test_the_same_id_is_accepted_once():
    bench = Bench()
    first = bench.send("go desk", id="anna-1")
    assert bench.send("go desk", id="anna-1") == first
    assert len(bench.service.book.tasks) == 1
    with pytest.raises(RequestError, match="id: expected"):
        bench.send("go desk", id="1")


def test_a_full_queue_refuses_requests():
    bench = Bench(settings=ServiceSettings(max_open=2))
    bench.send("go desk"), bench.send("go hall")
    with pytest.raises(QueueFullError, match="2 requests are open already"):
        bench.send("go kitchen")


def test_cancelled_tasks_end_at_once():
    bench = Bench()
    running, waiting = bench.send("go desk"), bench.send("go hall", not_before="+1h")
    bench.run(3.0)
    for task in (running, waiting):
        bench.service.cancel(task.id, bench.now)
    bench.run(1.0)
    assert [bench.ended[task.id].status for task in (running, waiting)] == [TaskStatus.CANCELED] * 2
    with pytest.raises(UnknownTaskError):
        bench.service.cancel("77", bench.now)
    again = Bench(find_ended=lambda task_id: bench.ended[task_id])
    with pytest.raises(TaskEndedError, match="is canceled already"):
        again.service.cancel(running.id, bench.now)


def test_a_series_is_repeated_and_its_next_time_is_in_the_queue():
    bench = Bench(where=site(timezone.utc))
    series = bench.send("deliver cup from kitchen to desk", repeat="*/10 * * * *", by="+15min")
    names = [f"{series.id}@20261130T08{minute}" for minute in ("00", "10", "20")]
    assert list(bench.service.book.tasks) == names[:2]
    bench.run(25 * 60.0)
    assert list(bench.ended) == names
    assert {task.status for task in bench.ended.values()} == {TaskStatus.COMPLETED}
    assert [task.request.deadline - task.request.release for task in bench.ended.values()] == [900.0] * 3
    bench.service.cancel(series.id, bench.now)
    assert not bench.service.book.tasks and not bench.service.book.series


def test_repetitions_that_were_due_while_the_robot_was_off_are_done_once():
    bench = Bench(where=site(timezone.utc))
    bench.send("go desk", repeat="0 * * * *")
    again = Bench(snapshot_of(bench), where=site(timezone.utc))
    again.now = NOW + 5.5 * 3600.0
    again.run(600.0)
    statuses = [task.status for task in again.ended.values()]
    assert statuses.count(TaskStatus.COMPLETED) == 1
    assert statuses.count(TaskStatus.SKIPPED) == 5, "those of 8 to 12 o'clock"


def test_a_low_battery_is_charged_before_the_next_task_and_never_empty():
    energy = EnergySettings(drive_hours=0.1, stand_hours=0.2, charge_hours=0.05)
    robot = ideal_robot()
    robot._settings = type(robot._settings)(energy, 0.0, 0.0, 0.0)
    bench = Bench(robot=robot, where=site(energy=energy))
    tasks = [bench.send("patrol desk hall kitchen 2 times") for _ in range(8)]
    bench.run_until(lambda: all(task.id in bench.ended for task in tasks), 20_000.0)
    assert any(isinstance(order, DockRobot) for order in bench.orders)
    assert robot.empty_at is None
    assert {task.status for task in bench.ended.values()} == {TaskStatus.COMPLETED}


def test_a_low_battery_without_a_dock_is_noted_once():
    energy = EnergySettings(stand_hours=1.0)
    robot = ideal_robot(pose=Pose2(3.0, 3.0))
    robot.charge = 0.21
    robot._settings = type(robot._settings)(energy, 0.0, 0.0, 0.0)
    bench = Bench(robot=robot, where=site(has_dock=False, energy=energy))
    bench.send("go desk")
    bench.run(120.0)
    notes = [entry.text for entry in bench.log if entry.kind == "battery"]
    assert len(notes) == 1 and "there is no dock" in notes[0]


def test_an_idle_robot_waits_in_its_dock():
    bench = Bench(robot=ideal_robot(pose=Pose2(3.0, 3.0)))
    bench.run(290.0)
    assert not bench.orders
    bench.run(60.0)
    assert bench.robot.is_docked
    assert bench.service.state(bench.now)["activity"] == "charging"


def test_a_clock_that_jumps_back_starts_nothing_twice():
    bench = Bench(where=site(timezone.utc))
    bench.send("go desk", repeat="*/10 * * * *")
    bench.run(700.0)
    ended = len(bench.ended)
    bench.now -= 650.0
    bench.run(600.0)
    assert len(bench.ended) == ended
    assert any(entry.kind == "clock" for entry in bench.log)


def test_state_reports_what_the_robot_does():
    bench = Bench()
    task = bench.send("deliver cup from kitchen to desk")
    bench.run_until(lambda: bench.service.find(task.id).is_carrying)
    state = bench.service.state(bench.now)
    assert (state["activity"], state["task"], state["carrying"]) == ("driving to desk", task.id, "cup")
    assert state["objects"] == {"cup": "on the robot"}


def test_a_request_waits_for_others_and_fails_with_them():
    bench = Bench()
    first = bench.send("go desk", id="first")
    second = bench.send("go kitchen", id="second", after=["first"], priority=9)
    third = bench.send("go hall", id="third", after=["second"])
    bench.finish(first)
    bench.service.cancel(second.id, bench.now)
    bench.finish(third)
    assert bench.ended["third"].reason == "task second was not done"
    with pytest.raises(RequestError, match="after: there is no task"):
        bench.send("go hall", after=["fourth"])


def test_the_deliveries_of_a_mission_are_requests():
    mission = load_mission(ROOT / "map/mission.yaml")
    documents = documents_of(mission, "m")
    assert [document["id"] for document in documents] == ["m-1", "m-2", "m-3", "m-4"]
    assert documents[3]["after"] == ["m-2"]
