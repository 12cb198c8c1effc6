"""Faults: something is let go wrong with the simulated robot or its home."""

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
NOBODY = f"No simulator here lets anything go wrong: nobody offers {SERVICE}."
NONE = "(none yet)"
HEADS = ("Goes wrong now", "Strength", "Seconds left")
USUAL_SECONDS = 5.0


class FaultsTool:
    name, title, seconds, width = "faults", "Faults", 0.5, 440
    # Outlives the window, as what has been asked for does.
    _asked = RequestedFaults()

    def __init__(self, context: ToolContext):
        self._context = context
        self._kinds: Dict[str, FaultKindInfo] = {}
        self._reading, self._calling = BackgroundCall(), BackgroundCall()

    def build(self) -> None:
        gui, guarded = self._context.gui, self._context.guarded
        self._trouble = gui.add_html(paragraph(NOBODY), visible=False)
        self._chosen = gui.add_dropdown("Kind", (NONE,))
        self._says = gui.add_html("")
        self._strength = gui.add_number("Strength", 0.0, step=0.01, hint="0: the usual one", visible=False)
        self._seconds = gui.add_number("Seconds", USUAL_SECONDS, step=0.1, hint="simulated ones; 0: for ever")
        self._button = gui.add_button("Let it go wrong", color="orange")
        self._answer = gui.add_html("")
        self._lasting = gui.add_html("")
        self._chosen.on_update(guarded(lambda _: self._show_kind()))
        self._button.on_click(guarded(lambda _: self._let_go_wrong()))
        self._reading.start(fault_kinds)

    def update(self, now: float) -> None:
        for kinds in self._reading.results():
            self._kinds, self._chosen.options = kinds, tuple(kinds)
            self._show_kind()
        self._look_for_simulator()
        for answer in self._calling.results():
            self._answer.content = paragraph(answer)
        rows = self._asked.rows(rospy.get_time())
        self._lasting.content = table(HEADS, rows) if rows else ""

    def pause(self) -> None:
        """It listens to nothing."""

    close = pause

    def _look_for_simulator(self) -> None:
        simulator = self._context.graph.address(SERVICE)
        self._asked.set_simulator(simulator)
        self._trouble.visible = simulator is None
        self._button.disabled = simulator is None

    def _show_kind(self) -> None:
        kind = self._kinds.get(self._chosen.value)
        if kind is not None:
            self._says.content = paragraph(kind.sentence())
            self._strength.visible, self._strength.value = bool(kind.unit), kind.usual

    def _let_go_wrong(self) -> None:
        kind = self._kinds.get(self._chosen.value)
        if kind is None:
            raise CockpitError("which kinds of faults there are is still being read")
        wish = FaultRequest(kind, self._seconds.value, self._strength.value if kind.unit else 0.0)
        self._calling.start(lambda: self._ask(wish))
        self._answer.content = paragraph("...")

    def _ask(self, wish: FaultRequest) -> str:
        """What has come of it."""
        try:
            answer = call(SERVICE, AddFault, wish.kind.name, wish.seconds, wish.strength)
        except CockpitError as error:
            return str(error)
        if not answer.success:
            return answer.message
        self._asked.add(wish, rospy.get_time())
        return f"{wish.kind.name} has begun."


TOOL = FaultsTool
