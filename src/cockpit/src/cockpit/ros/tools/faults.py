"""Faults: inject faults into the simulated robot or its home."""

from typing import Dict

import rospy
from sim_bridge_msgs.srv import AddFault

from cockpit.errors import CockpitError
from cockpit.fault_kinds import fault_kinds
from cockpit.models.faults import FaultKindInfo, FaultRequest, RequestedFaults
from cockpit.models.tables import paragraph, table
from cockpit.ros.background import BackgroundCall
from cockpit.ros.calls import call
from cockpit.ros.tool import ToolContext

SERVICE = "/sim_bridge/add_fault"
NO_SIMULATOR = f"Faults need a simulator with the service {SERVICE}; none is running."
NONE = "(none yet)"
HEADS = ("Active fault", "Strength", "Seconds left")
USUAL_SECONDS = 5.0


class FaultsTool:
    name, title, seconds = "faults", "Faults", 0.5
    # Outlives the window, as the faults do.
    _requested = RequestedFaults()

    def __init__(self, context: ToolContext):
        self._context = context
        self._kinds: Dict[str, FaultKindInfo] = {}
        self._reading, self._calling = BackgroundCall(), BackgroundCall()

    def build(self) -> None:
        gui, guarded = self._context.gui, self._context.guarded
        self._trouble = gui.add_html(paragraph(NO_SIMULATOR), visible=False)
        self._chosen = gui.add_dropdown("Kind", (NONE,))
        self._description = gui.add_html("")
        self._strength = gui.add_number(
            "Strength", 0.0, step=0.01, hint="0 for the usual strength", visible=False
        )
        self._seconds = gui.add_number(
            "Seconds", USUAL_SECONDS, step=0.1, hint="simulated seconds; 0 for forever"
        )
        self._button = gui.add_button("Inject the fault", color="orange")
        self._answer = gui.add_html("")
        self._active = gui.add_html("")
        self._chosen.on_update(guarded(lambda _: self._show_kind()))
        self._button.on_click(guarded(lambda _: self._inject()))
        self._reading.start(fault_kinds)

    def update(self, now: float) -> None:
        for kinds in self._reading.results():
            self._kinds, self._chosen.options = kinds, tuple(kinds)
            self._show_kind()
        self._check_simulator()
        for answer in self._calling.results():
            self._answer.content = paragraph(answer)
        rows = self._requested.rows(rospy.get_time())
        self._active.content = table(HEADS, rows) if rows else ""

    def pause(self) -> None:
        """Nothing to do: the tool has no subscriptions."""

    close = pause

    def _check_simulator(self) -> None:
        simulator = self._context.graph.address(SERVICE)
        self._requested.set_simulator(simulator)
        self._trouble.visible = simulator is None
        self._button.disabled = simulator is None

    def _show_kind(self) -> None:
        kind = self._kinds.get(self._chosen.value)
        if kind is not None:
            self._description.content = paragraph(kind.sentence())
            self._strength.visible, self._strength.value = bool(kind.unit), kind.usual

    def _inject(self) -> None:
        kind = self._kinds.get(self._chosen.value)
        if kind is None:
            raise CockpitError("the kinds of faults are still being read; try again in a moment")
        request = FaultRequest(kind, self._seconds.value, self._strength.value if kind.unit else 0.0)
        self._calling.start(lambda: self._request(request))
        self._answer.content = paragraph("...")

    def _request(self, request: FaultRequest) -> str:
        """Call the simulator and return the result as text."""
        try:
            answer = call(SERVICE, AddFault, request.kind.name, request.seconds, request.strength)
        except CockpitError as error:
            return str(error)
        if not answer.success:
            return answer.message
        self._requested.add(request, rospy.get_time())
        return f"{request.kind.name} is active."


TOOL = FaultsTool
