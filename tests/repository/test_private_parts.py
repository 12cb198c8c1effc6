"""Private parts of rospy, viser and websockets are used in one place each."""

import private_parts
import pytest
from private_parts import LIBRARIES, ROOT


@pytest.mark.parametrize("library", LIBRARIES, ids=lambda library: library.name)
def test_private_parts_are_used_in_one_place(library):
    found = private_parts.mentions(ROOT, library)
    outside = {name: count for name, count in found.items() if not private_parts.is_allowed(name, library)}
    assert outside == {}, f"use or extend the interface of {library.allowed[0]}"
    inside = [name for name in found if "/test" not in name]
    assert 0 < len(inside) <= library.most_files, "few files hold every access"


@pytest.mark.parametrize(
    "text",
    [
        "from rospy.impl.tcpros_base import TCPServer",
        "from rospy import core",
        "rospy.topics.get_topic_manager()",
        "publisher.impl.connections",
        "rospy.rostime._set_rostime(now)",
        "connection.callerid_pub",
    ],
)
def test_a_mention_is_found(text):
    assert LIBRARIES[0].pattern.search(text)


@pytest.mark.parametrize(
    "text",
    [
        "from rospy.numpy_msg import numpy_msg",
        "rospy.Timer(period, call)",
        "rospy.get_name()",
        "rospy.Service(name, kind, answer)",
        "message._connection_header",
        "rospy_transport.node",
    ],
)
def test_public_names_are_no_mentions(text):
    assert not LIBRARIES[0].pattern.search(text)


def test_private_parts_of_viser_are_found():
    pattern = LIBRARIES[1].pattern
    assert pattern.search("from viser import _messages") and pattern.search("gui._gui_input_handle_from_uuid")
    assert not pattern.search("viser.__version__")
