"""What browsers may send."""

import math

import pytest

from cockpit.errors import RefusedError
from cockpit.inbound import RateLimiter, check

UPDATE = {"type": "GuiUpdateMessage", "uuid": "a", "updates": {"value": 1.5}}


def test_what_the_page_sends_is_let_through():
    check(UPDATE)
    check({"type": "ViewerCameraMessage", "position": [1.0, 2, 3]})


@pytest.mark.parametrize(
    "message",
    [
        None,
        [],
        "text",
        {},
        {"type": "ShareUrlRequest"},
        {"type": "FileTransferStartUpload"},
        {"type": "SetCameraPositionMessage"},
        {"type": 3},
        {**UPDATE, "updates": {"update_cb": []}},
        {**UPDATE, "updates": [1]},
        {**UPDATE, "updates": {"value": math.nan}},
        {**UPDATE, "updates": {"value": [1.0, [math.inf]]}},
        {"type": "ViewerCameraMessage", "position": [[[[[[[[[[1.0]]]]]]]]]]},
    ],
)
def test_anything_else_is_refused(message):
    with pytest.raises(RefusedError):
        check(message)


def test_so_many_messages_a_second_and_no_more():
    limiter = RateLimiter(rate=10.0, burst=3.0)
    assert [limiter.allow(100.0) for _ in range(5)] == [True, True, True, False, False]
    assert [limiter.allow(100.2) for _ in range(3)] == [True, True, False]
