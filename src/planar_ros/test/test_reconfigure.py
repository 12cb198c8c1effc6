from types import SimpleNamespace

import rospy
from dynamic_reconfigure.encoding import encode_config

from planar.config.parameters import DynamicParameter
from planar_ros.node import reconfigure


def test_a_call_that_comes_while_the_server_is_made_is_not_taken_for_its_own(monkeypatch):
    """The master may tell of the service before its maker goes on."""
    asked = []

    def service(_name, _kind, handler):
        handler(SimpleNamespace(config=encode_config({"gain": 5.0})))

    nobody = SimpleNamespace(publish=lambda message: None)
    monkeypatch.setattr(rospy, "Publisher", lambda *_, **__: nobody)
    monkeypatch.setattr(rospy, "Service", service)
    monkeypatch.setattr(rospy, "get_name", lambda: "/node")
    monkeypatch.setattr(reconfigure._Server, "_copy_to_parameter_server", lambda _: None)
    tunable = DynamicParameter("gain", 1.0, "what is multiplied by", 0.0, 10.0)
    reconfigure.ReconfigureServer(
        [tunable], {"gain": 2.0}, lambda values: asked.append(dict(values)) or values
    )
    assert asked == [{"gain": 5.0}]
