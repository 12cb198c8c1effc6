"""Calls of services between nodes in step: they carry the number of the caller's moment."""

import threading
from typing import Any, Callable, Dict, Mapping

from rospy.impl.tcpros_service import ServiceImpl

HEADER = "moment"
_local = threading.local()


def call_headers(moment: int) -> Dict[str, str]:
    """What a node's call has to carry at this moment; nothing if it is not in step (0)."""
    return {HEADER: str(moment)} if moment else {}


def caller() -> str:
    """The node in step that has made the call which this thread answers; "" if none has."""
    return getattr(_local, "caller", "")


def delay_service_replies(wait: Callable[[int], None]) -> None:
    """From now on a call of a node in step is answered when ``wait(number of its moment)`` returns."""
    handle = ServiceImpl._handle_request

    def handle_in_time(self: Any, transport: Any, request: Any) -> None:
        header: Mapping[str, str] = getattr(request, "_connection_header", None) or {}
        number = header.get(HEADER, "0")
        _local.caller = header.get("callerid", "") if number.isdigit() and int(number) else ""
        if _local.caller:
            wait(int(number))
        handle(self, transport, request)

    ServiceImpl._handle_request = handle_in_time
