"""Each consumer receives the events of its types, whatever the others do."""

import pytest

from evaluation.event_stream import EventStream, Latest
from evaluation.events import GoalEnded, GoalStatusUpdated, StateUpdated, TruthUpdated
from planar import Pose2

PICKING_UP = StateUpdated(1.0, "picking up")


def test_an_event_reaches_all_consumers_of_its_type_in_the_order_of_their_subscription():
    events, received = EventStream(), []
    events.subscribe(StateUpdated, lambda event: received.append(("judge", event)))
    events.subscribe(StateUpdated, lambda event: received.append(("recorder", event)))
    events.subscribe(TruthUpdated, pytest.fail)
    events.publish(PICKING_UP)
    assert received == [("judge", PICKING_UP), ("recorder", PICKING_UP)]


def test_an_event_of_a_derived_type_is_not_one_of_the_type_itself():
    events, status = EventStream(), Latest(GoalStatusUpdated)
    status.attach(events)
    events.publish(GoalEnded(1.0, "goal", 3, ""))
    assert status.event is None


def test_an_error_of_one_consumer_is_reported_and_keeps_events_from_no_other():
    errors = []
    events, later = EventStream(errors.append), Latest(StateUpdated)
    events.subscribe(StateUpdated, lambda event: 1 / 0)
    later.attach(events)
    events.publish(PICKING_UP)
    assert later.event is PICKING_UP
    (error,) = errors
    assert error.startswith("StateUpdated: ") and "ZeroDivisionError" in error


def test_without_a_report_errors_are_raised():
    events = EventStream()
    events.subscribe(StateUpdated, lambda event: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        events.publish(PICKING_UP)


def test_a_consumer_may_publish_an_event():
    events, truth = EventStream(), Latest(TruthUpdated)
    truth.attach(events)
    events.subscribe(StateUpdated, lambda event: events.publish(TruthUpdated(event.stamp, Pose2(3.0))))
    events.publish(PICKING_UP)
    assert truth.event == TruthUpdated(1.0, Pose2(3.0))


def test_types_without_consumers_are_known():
    events = EventStream()
    Latest(StateUpdated).attach(events)
    assert events.has_consumers_of(StateUpdated)
    assert not events.has_consumers_of(TruthUpdated)
