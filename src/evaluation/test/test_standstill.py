from gazebo_msgs.srv import GetPhysicsPropertiesResponse

from evaluation.ros import standstill
from evaluation.ros.standstill import why_clock_stopped
from planar_ros.calls.services import ServiceError


def answering(monkeypatch, is_paused):
    answer = GetPhysicsPropertiesResponse(pause=is_paused)
    monkeypatch.setattr(standstill, "call_service", lambda *_: answer)


def test_nodes_that_the_simulator_waits_for_are_named(monkeypatch):
    answering(monkeypatch, is_paused=False)
    assert why_clock_stopped(["amcl", "move_base"]) == "the simulator waits for amcl, move_base"


def test_a_pause_is_reported_even_if_nodes_were_waited_for(monkeypatch):
    answering(monkeypatch, is_paused=True)
    assert why_clock_stopped(["amcl"]) == "the simulation is paused"


def test_a_simulator_that_does_not_answer_is_named(monkeypatch):
    def silence(*_):
        raise ServiceError("no answer within 3 s")

    monkeypatch.setattr(standstill, "call_service", silence)
    assert why_clock_stopped([]) == "the simulator does not answer (no answer within 3 s)"
