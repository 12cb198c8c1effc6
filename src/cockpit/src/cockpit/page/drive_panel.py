"""The Drive tab: goals, poses and points, driving by hand, simulated time, missions, doors."""

from typing import Any, Callable, Dict, Mapping, Protocol, Sequence, Tuple

from cockpit.models.tables import paragraph
from cockpit.page.toolbar import DROP_BOX, MOVE_MODEL

# The buttons and keys of turtlebot_teleop; the page has no "," key and uses m instead.
BUTTONS = (("U", "u"), ("I", "i"), ("O", "o"), ("J", "j"), ("K", "k"), ("L", "l"), ("M", ","))
ARROWS = {"U": "forward left", "I": "forward", "O": "forward right", "J": "turn left", "K": "stop"}
ARROWS.update({"L": "turn right", "M": "back"})
HOLD_HZ = 10.0
NO_SUBSCRIBER, NO_MODEL, NO_PLACE = "(no subscriber yet)", "(no model yet)", "(no place yet)"
# Name of the robot without a namespace.
NO_NAMESPACE = "(no namespace)"
SPEEDS = ("as fast as possible", "0.5 x", "1 x", "2 x", "5 x")
FACTORS = (0.0, 0.5, 1.0, 2.0, 5.0)


class DriveCommands(Protocol):
    """The actions of the panel; their exceptions are reported on the page."""

    def choose_mode(self, mode: str) -> None: ...

    def press(self, key: str, client: int) -> None: ...

    def pause(self, is_paused: bool) -> None: ...

    def step(self) -> None: ...

    def reset(self) -> None: ...

    def set_speed(self, factor: float) -> None: ...

    def cancel(self) -> None: ...

    def deliver(self) -> None: ...

    def cancel_mission(self) -> None: ...

    def swing(self) -> None: ...


class DrivePanel:
    """Creates the controls of the Drive tab.

    Args:
        gui: The gui of viser.
        tab: The tab's context.
        driver: Carries out the actions.
        guarded: Wraps callbacks of controls so that exceptions are reported on the page.
    """

    def __init__(self, gui, tab, driver: DriveCommands, guarded: Callable[[Callable], Callable]):
        self._gui, self._driver, self._guarded = gui, driver, guarded
        self._namespaces: Dict[str, str] = {NO_NAMESPACE: "/"}
        with tab:
            self._build_robot()
            self._build_mission()
            self._build_teleop()
            self._build_time()
            self._build_world()
        self._build_keys()

    def offer_world(self, models: Sequence[str], joints: Sequence[str]) -> None:
        """Set the choices of models and joints.

        Args:
            models: Models that can be moved.
            joints: Joints of doors and drawers.
        """
        _offer(self.model, models)
        _offer(self.joint, joints)
        self._joints.visible = bool(joints)

    def offer(self, robots: Sequence[str], topics: Sequence[str], places: Sequence[str]) -> None:
        """Set the choices of robots, topics and places.

        Args:
            robots: Namespaces with a goal topic.
            topics: Velocity topics with a subscriber.
            places: Places of deliveries.
        """
        if robots:
            self._namespaces = {robot.strip("/") or NO_NAMESPACE: robot for robot in robots}
        _offer(self.robot, tuple(self._namespaces))
        self.robot.visible = len(self._namespaces) > 1
        _offer(self.topic, topics)
        is_first = NO_PLACE in self.destination.options
        for end in (self.source, self.destination):
            _offer(end, places)
        if is_first and len(places) > 1:
            self.destination.value = places[1]

    @property
    def namespace(self) -> str:
        """Namespace of the selected robot, with slashes around it."""
        return self._namespaces.get(self.robot.value, "/")

    def show_refusal(self, reason: str) -> None:
        """Show why a mission was refused, until the next one."""
        self.mission.content = paragraph(f"The mission was refused: {reason}")

    def _build_robot(self) -> None:
        self.robot = self._gui.add_dropdown("Robot", (NO_NAMESPACE,), visible=False)
        cancel = self._gui.add_button("Cancel the goal", color="gray")
        cancel.on_click(self._guarded(lambda _: self._driver.cancel()))

    def _build_teleop(self) -> None:
        gui = self._gui
        with gui.add_folder("Drive by hand"):
            gui.add_html(paragraph("Hold a button or its key: u i o j k l, m is back. Release it to stop."))
            self.topic = gui.add_dropdown("Velocities to", (NO_SUBSCRIBER,))
            for label, key in BUTTONS:
                button = gui.add_button(f"{label}  {ARROWS[label]}")
                hold = self._guarded(lambda event, key=key: self._driver.press(key, event.client_id))
                button.on_hold(hold, callback_hz=HOLD_HZ)

    def _build_mission(self) -> None:
        gui, driver, guarded = self._gui, self._driver, self._guarded
        with gui.add_folder("Mission"):
            self.mission = gui.add_html(paragraph("No mission yet. Enter an object and its places below."))
            self.object = gui.add_text("Object", "parcel")
            self.source = gui.add_dropdown("From", (NO_PLACE,))
            self.destination = gui.add_dropdown("To", (NO_PLACE,))
            start, end = gui.add_button("Deliver it"), gui.add_button("Cancel the mission", color="gray")
            start.on_click(guarded(lambda _: driver.deliver()))
            end.on_click(guarded(lambda _: driver.cancel_mission()))

    def _build_world(self) -> None:
        gui, driver, guarded = self._gui, self._driver, self._guarded
        with gui.add_folder("Models"):
            drop = gui.add_button(DROP_BOX, color="gray")
            self.model = gui.add_dropdown("Model", (NO_MODEL,))
            move = gui.add_button(MOVE_MODEL, color="gray")
        drop.on_click(guarded(lambda _: driver.choose_mode(DROP_BOX)))
        move.on_click(guarded(lambda _: driver.choose_mode(MOVE_MODEL)))
        self._joints = self._gui.add_folder("Doors and drawers", visible=False)
        with self._joints:
            self.joint = self._gui.add_dropdown("Of", (NO_MODEL,))
            self.opened = self._gui.add_slider("Open, %", 0, 100, 5, 0)
            self.opened.on_update(self._guarded(lambda _: self._driver.swing()))

    def _build_keys(self) -> None:
        for label, key in BUTTONS:
            command = self._gui.add_command(f"Drive: {ARROWS[label]}", hotkey=label)
            press = self._guarded(lambda event, key=key: self._driver.press(key, event.client_id))
            command.on_trigger(press)

    def _build_time(self) -> None:
        gui, driver = self._gui, self._driver
        with gui.add_folder("Simulated time", expand_by_default=False):
            self.speed = gui.add_dropdown("Speed", SPEEDS, initial_value="1 x")
            pause, resume = gui.add_button("Pause"), gui.add_button("Resume")
            step, reset = gui.add_button("One step"), gui.add_button("Reset the world", color="orange")
        factors: Mapping[str, float] = dict(zip(SPEEDS, FACTORS))
        self.speed.on_update(self._guarded(lambda _: driver.set_speed(factors[self.speed.value])))
        does: Tuple[Tuple[Any, Callable[[], None]], ...] = (
            (pause, lambda: driver.pause(True)),
            (resume, lambda: driver.pause(False)),
            (step, driver.step),
            (reset, driver.reset),
        )
        for button, do in does:
            button.on_click(self._guarded(lambda _, do=do: do()))


def _offer(dropdown: Any, options: Sequence[str]) -> None:
    offered = tuple(options) or dropdown.options
    if dropdown.options != offered:
        dropdown.options = offered
