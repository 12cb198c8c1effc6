"""Messages as people write them."""

import pytest
from geometry_msgs.msg import PoseStamped
from std_msgs.msg import String, UInt8
from std_srvs.srv import SetBoolRequest, TriggerRequest

from cockpit.errors import CockpitError
from cockpit.ros.message_yaml import filled, message_class, service_class, template

MERGED_OFTEN = "k0: &k0 {a: 1}\n" + "".join(
    f"k{i}: &k{i} {{<<: [*k{i - 1}, *k{i - 1}]}}\n" for i in range(1, 40)
)


def test_a_template_has_the_default_values():
    assert filled(PoseStamped, template(PoseStamped)) == PoseStamped()
    assert template(TriggerRequest) == ""
    assert filled(TriggerRequest, "") == TriggerRequest()


def test_fields_that_are_not_named_stay_as_they_are():
    message = filled(PoseStamped, "{header: {frame_id: map}, pose: {position: {x: 1.5}}}")
    assert (message.header.frame_id, message.pose.position.x) == ("map", 1.5)
    assert message.pose.orientation.w == 0.0
    assert filled(SetBoolRequest, "data: true").data is True


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        (String, "data: ["),
        (String, "data: [1]"),
        (String, "nothing: 1"),
        (String, "hello"),
        (String, "!!python/object/apply:os.system [true]"),
        (UInt8, "data: 300"),
        (PoseStamped, "pose: {position: {x: far}}"),
        (String, "data: " + "x" * 30_000),
        (String, MERGED_OFTEN),
    ],
)
def test_text_that_is_no_such_message_is_an_error(kind, text):
    with pytest.raises(CockpitError):
        filled(kind, text)


def test_types_that_are_not_installed_are_an_error():
    assert message_class("std_msgs/String") is String
    with pytest.raises(CockpitError, match="type nowhere_msgs/Odd is not installed"):
        message_class("nowhere_msgs/Odd")
    with pytest.raises(CockpitError):
        service_class("nonsense")
