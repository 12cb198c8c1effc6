"""Service calls between synchronized nodes; they carry the number of the caller's instant."""

import threading
from typing import Any, Callable, Collection, Dict, Mapping, Optional, Set

from rospy.impl.tcpros_service import ServiceImpl

INSTANT_HEADER = "moment"
# Services that change nothing in the simulation, whenever they are called. Time that is paused, or advances
# step by step, gives the same run.
READ_ONLY = frozenset(
    ("make_plan", "static_map", "dynamic_map", "set_logger_level", "tf2_frames")
    + ("pause_physics", "unpause_physics", "step")
)
READ_ONLY_PREFIX = "get_"
_local = threading.local()


class CallMonitor:
    """Notes each service that a node calls which is not synchronized: the call comes at a random moment.

    Args:
        members: Returns the names of the synchronized nodes; none while nothing is synchronised.
        note: Called with a text.
        harmless: Resolved names of further services that change nothing in the simulation.
    """

    def __init__(
        self,
        members: Callable[[], Collection[str]],
        note: Callable[[str], None],
        harmless: Collection[str] = (),
    ):
        self._members, self._note = members, note
        self._known: Set[str] = set(harmless)

    def check(self, service: str, caller: str) -> None:
        """Note a call, the first of each service.

        Args:
            service: Resolved name of the service.
            caller: Name of the calling node.
        """
        members, name = self._members(), service.rsplit("/", 1)[-1]
        if not members or caller in members or service in self._known:
            return
        if name not in READ_ONLY and not name.startswith(READ_ONLY_PREFIX):
            self._known.add(service)
            self._note(f"the service {service} was called by {caller}, which is not synchronized")


def call_headers(instant: int) -> Dict[str, str]:
    """Return the headers of a call at an instant; empty for 0, i.e. when the node is not synchronized."""
    return {INSTANT_HEADER: str(instant)} if instant else {}


def caller() -> str:
    """Return the synchronized node whose call this thread answers; empty if there is none."""
    return getattr(_local, "caller", "")


def delay_service_replies(wait: Callable[[int], None], monitor: Optional[CallMonitor] = None) -> None:
    """Delay each call of a synchronized node until ``wait(number of its instant)`` returns.

    Args:
        wait: Blocks until an instant.
        monitor: Checks the calls of other nodes.
    """
    handle = ServiceImpl._handle_request

    def handle_in_time(self: Any, transport: Any, request: Any) -> None:
        header: Mapping[str, str] = getattr(request, "_connection_header", None) or {}
        number = header.get(INSTANT_HEADER, "0")
        _local.caller = header.get("callerid", "") if number.isdigit() and int(number) else ""
        if _local.caller:
            wait(int(number))
        elif monitor is not None:
            monitor.check(self.resolved_name, header.get("callerid", ""))
        handle(self, transport, request)

    ServiceImpl._handle_request = handle_in_time
