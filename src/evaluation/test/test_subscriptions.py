"""One subscription a topic feeds all observers of a process."""

from types import SimpleNamespace

import pytest

from evaluation.ros import subscriptions
from evaluation.ros.subscriptions import subscribe, subscribing_together

LATCHED, UNLATCHED = {"callerid": "/add_markers", "latching": "1"}, {"callerid": "/add_markers"}


def message(text, header=UNLATCHED):
    return SimpleNamespace(text=text, _connection_header=header)


@pytest.fixture
def ros(monkeypatch):
    """rospy whose publishers send their latched messages at once, to the first subscription only."""
    state = SimpleNamespace(latched={}, opened=[], receive={})

    def open_subscription(topic, kind, callback, **_):
        state.opened.append(topic)
        state.receive[topic] = callback
        for each in state.latched.pop(topic, ()):
            callback(each)

    monkeypatch.setattr(subscriptions, "_topics", {})
    monkeypatch.setattr(subscriptions.rospy, "Subscriber", open_subscription)
    monkeypatch.setattr(subscriptions.rospy, "resolve_name", lambda name: f"/{name.lstrip('/')}")
    monkeypatch.setattr(subscriptions.rospy, "logerr", lambda *_: None)
    return state


def texts(into):
    return lambda message: into.append(message.text)


def test_all_observers_that_subscribe_together_receive_the_first_messages(ros):
    ros.latched["/visualization_marker"] = [message("at pickup", LATCHED), message("hidden", LATCHED)]
    recorder, referee = [], []
    with subscribing_together():
        subscribe("visualization_marker", object, texts(recorder))
        subscribe("/visualization_marker", object, texts(referee))
        assert ros.opened == []
    assert recorder == referee == ["at pickup", "hidden"]
    assert ros.opened == ["/visualization_marker"]


def test_a_later_observer_receives_the_last_latched_message_and_all_that_follow(ros):
    first, later = [], []
    subscribe("state", object, texts(first))
    ros.receive["/state"](message("going", LATCHED))
    ros.receive["/state"](message("picking up", LATCHED))
    subscribe("state", object, texts(later))
    ros.receive["/state"](message("delivered", LATCHED))
    assert first == ["going", "picking up", "delivered"]
    assert later == ["picking up", "delivered"]
    assert ros.opened == ["/state"]


def test_a_message_that_is_not_latched_is_not_repeated(ros):
    later = []
    subscribe("truth", object, texts([]))
    ros.receive["/truth"](message("here"))
    subscribe("truth", object, texts(later))
    assert later == []


def test_an_error_of_one_observer_does_not_keep_messages_from_the_others(ros):
    received = []
    with subscribing_together():
        subscribe("state", object, lambda message: 1 / 0)
        subscribe("state", object, texts(received))
    ros.receive["/state"](message("delivered"))
    assert received == ["delivered"]


def test_subscriptions_are_opened_though_an_observer_cannot_start(ros):
    with pytest.raises(ZeroDivisionError), subscribing_together():
        subscribe("state", object, texts([]))
        raise ZeroDivisionError
    subscribe("state", object, texts([]))
    assert ros.opened == ["/state"]
