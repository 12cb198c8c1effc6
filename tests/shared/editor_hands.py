"""A person at the editor of homes: the mouse and the keys of a page."""

import time
from typing import Iterator

from browser import Tab
from waiting import wait_until

# Keys that are no characters, with their codes in browsers.
CODES = {"Escape": 27, "Enter": 13, "Delete": 46, "Backspace": 8}
CTRL, SHIFT = 2, 8


class EditorHands:
    """Uses the editor as a person does.

    Args:
        page: The page of the editor.
        pace: Time between two actions [s].
    """

    def __init__(self, page: Tab, pace: float = 0.0):
        self.page, self._pace = page, pace

    def pixel(self, x: float, y: float):
        """Return where a point of the plan is on the page."""
        return self.page.evaluate(
            "(([left, top], box) => [box.left + left, box.top + top])"
            f"(toPage({x}, {y}), svg.getBoundingClientRect())"
        )

    def choose(self, tool: str) -> None:
        """Click the button of a tool or of a kind of furniture."""
        self._click_element(f"document.querySelector('[data-tool=\"{tool}\"]')")

    def press_button(self, name: str) -> None:
        """Click another button, by its id."""
        self._click_element(f"document.getElementById('{name}')")

    def click(self, *points, modifiers: int = 0) -> None:
        """Click points of the plan [m]."""
        for x, y in points:
            self.page.drag(self.pixel(x, y), self.pixel(x, y), modifiers=modifiers)
            self._pause()

    def drag(self, start, end, modifiers: int = 0) -> None:
        """Drag from one point of the plan to another [m]."""
        self.page.drag(self.pixel(*start), self.pixel(*end), modifiers=modifiers)
        self._pause()

    def move_to(self, x: float, y: float) -> None:
        """Move the mouse to a point of the plan [m]."""
        self.page.move_mouse(*self.pixel(x, y))

    def key(self, key: str, modifiers: int = 0) -> None:
        """Press a key: a character, or one of CODES."""
        self.page.press_key(key, CODES.get(key), modifiers)
        self._pause()

    def type(self, text: str) -> None:
        """Type a text, and Enter."""
        for character in text:
            self.page.press_key(character)
        self.key("Enter")

    def name(self, text: str) -> None:
        """Type the name of what was just added, once its field has the focus."""
        has_focus = "document.activeElement.dataset.field === 'name'"
        wait_until("the field of the name", lambda: self.page.evaluate(has_focus))
        self.type(text)

    def write(self, field: str, value: str) -> None:
        """Replace the value of a field."""
        self._click_element(f"document.querySelector('[data-field=\"{field}\"]')")
        self.page.evaluate("document.activeElement.select()")
        self.type(value)

    def upload(self, path) -> None:
        """Choose a picture as the template."""
        self.page.choose_file("#template", path)
        self._pause()

    def _click_element(self, element: str) -> None:
        x, y = self.page.evaluate(
            f"((one) => {{ one.scrollIntoView({{block: 'nearest'}}); const box = one.getBoundingClientRect();"
            f"return [box.x + box.width / 2, box.y + box.height / 2]; }})({element})"
        )
        self.page.click_at(x, y)
        self._pause()

    def _pause(self) -> None:
        time.sleep(self._pace)


WALLS = ((0, 0), (8, 0), (8, 6), (0, 6), (0, 0), (4, 0), (4, 6))
FURNITURE = (("bed", (1.3, 5)), ("table", (6, 4.8)), ("sofa", (6, 0.7)), ("plant", (7.5, 1.5)))


def draw_home(hands: EditorHands) -> Iterator[None]:
    """Draw a home of two rooms with a door, windows, furniture, names and a start; yields after each step."""
    hands.choose("wall")
    for corner in WALLS:
        hands.click(corner)
        yield
    hands.key("Escape")
    for tool, where in (("door", (4, 3)), ("window", (2, 0)), ("window", (6, 6)), *FURNITURE):
        hands.choose(tool)
        hands.click(where)
        yield
    for name, where in (("bedroom", (1, 2)), ("kitchen", (5, 2))):
        hands.choose("room")
        hands.click(where)
        hands.name(name)
        yield
    hands.choose("start")
    hands.drag((2, 2), (2, 2.6))
    hands.page.wait_for("saved", "bedroom: ", "kitchen: ")
    yield
