from types import SimpleNamespace

import rospy
from dynamic_reconfigure.encoding import encode_config

from planar.config.parameters import DynamicParameter
from planar_ros.node import parameters


def test_a_request_that_arrives_while_the_server_is_created_is_handled_as_a_request(monkeypatch):
    """Clients may learn of the service before rospy.Service returns."""
    requested = []

    def service(_name, _kind, handler):
        handler(SimpleNamespace(config=encode_config({"gain": 5.0})))

    publisher = SimpleNamespace(publish=lambda message: None)
    monkeypatch.setattr(rospy, "Publisher", lambda *_, **__: publisher)
    monkeypatch.setattr(rospy, "Service", service)
    monkeypatch.setattr(rospy, "get_name", lambda: "/node")
    monkeypatch.setattr(parameters._Server, "_copy_to_parameter_server", lambda _: None)
    tunable = DynamicParameter("gain", 1.0, "what is multiplied by", 0.0, 10.0)
    parameters.ReconfigureServer(
        [tunable], {"gain": 2.0}, lambda values: requested.append(dict(values)) or values
    )
    assert requested == [{"gain": 5.0}]
