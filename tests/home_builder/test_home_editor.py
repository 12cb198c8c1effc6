#!/usr/bin/env python3
"""The editor of homes in the browser: each tool by mouse and keys, and what is saved of it."""

import math
import os
import shutil
import tempfile
import threading
import time
import unittest
from pathlib import Path

import rostest
from browser import Browser
from PIL import Image
from waiting import wait_until

from home_builder import FurniturePiece, HomePlan, Wall, load_plan
from home_builder.editor.server import EditorServer
from home_builder.editor.session import EditorSession

PICTURES = os.environ.get("EDITOR_PICTURES")
# From an empty page to a mission in the new home, at a person's pace of a click in so many seconds.
CLICK_SECONDS, MOST_SECONDS = 0.6, 300.0


class HomeEditorTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp()) / "flat"
        self.addCleanup(shutil.rmtree, self.folder.parent)
        self.browser = Browser()
        self.addCleanup(self.browser.close)

    def open(self, plan=None):
        server = EditorServer(EditorSession(self.folder, plan))
        thread = threading.Thread(target=server.serve, daemon=True)
        thread.start()
        self.addCleanup(server.close)
        self.page = self.browser.open(server.url, 1400, 860)
        self.page.wait_for("saved in", seconds=60.0)

    # -- a person's hands ----------------------------------------------------------------------------------

    def pixel(self, x, y):
        return self.page.evaluate(
            "(([left, top], box) => [box.left + left, box.top + top])"
            f"(toPage({x}, {y}), svg.getBoundingClientRect())"
        )

    def click(self, *points):
        for x, y in points:
            self.page.click_at(*self.pixel(x, y))

    def choose(self, tool):
        self.page.evaluate(f"document.querySelector('[data-tool=\"{tool}\"]').click()")

    def key(self, key, **modifiers):
        options = ", ".join([f"key: '{key}'", "bubbles: true", *(f"{name}: true" for name in modifiers)])
        self.page.evaluate(f"svg.dispatchEvent(new KeyboardEvent('keydown', {{{options}}}))")

    def write(self, field, value):
        self.page.evaluate(
            f"(input => {{ input.value = '{value}'; input.dispatchEvent(new Event('change')); }})"
            f"(document.querySelector('[data-field=\"{field}\"]'))"
        )

    def saved(self, condition, what):
        wait_until(what, lambda: condition(load_plan(self.folder / "plan.yaml")), 20.0)
        return load_plan(self.folder / "plan.yaml")

    def picture(self, name):
        if PICTURES:
            self.page.screenshot(Path(PICTURES) / f"{name}.png")

    def draw_two_rooms(self):
        self.choose("wall")
        self.click((0, 0), (8, 0), (8, 6), (0, 6), (0, 0), (4, 0), (4, 6))
        self.key("Escape")
        self.choose("door")
        self.click((4, 2))

    # -- tests --------------------------------------------------------------------------------------------

    def test_walls_snap_and_have_typed_lengths(self):
        self.open()
        self.choose("wall")
        self.click((0.02, 0.01), (5, 0.2))
        self.key("Escape")
        self.choose("wall")
        self.click((5.04, 0.03), (5.1, 3))
        plan = self.saved(lambda plan: len(plan.walls) == 2, "two walls")
        self.assertEqual(plan.walls[0].end, plan.walls[1].start)
        self.assertEqual(plan.walls[0].start, (0.0, 0.0))
        self.page.evaluate("pointer = [3, 3]")
        for key in "2.5":
            self.key(key)
        self.picture("typed_length")
        self.key("Enter")
        plan = self.saved(lambda plan: len(plan.walls) == 3, "a wall of a typed length")
        self.assertAlmostEqual(plan.walls[2].length, 2.5, places=3)

    def test_every_tool_leaves_what_was_drawn(self):
        self.open()
        self.draw_two_rooms()
        self.choose("window")
        self.click((6, 0))
        for kind, where in (("bed", (1.3, 5)), ("table", (6, 4)), ("plant", (7.4, 5.4))):
            self.choose(kind)
            self.click(where)
        self.choose("room")
        self.click((1, 1))
        self.write("name", "kitchen")
        self.choose("place")
        self.click((7, 1.5))
        self.write("name", "pickup")
        self.choose("start")
        self.click((2, 2))
        for tool in ("keep_out", "speed"):
            self.choose(tool)
            self.click((5, 5), (5.5, 5), (5.5, 5.5))
            self.key("Enter")
        plan = self.saved(lambda plan: len(plan.zones) == 2, "two zones")
        self.picture("all_tools")
        self.assertEqual(len(plan.walls), 5)
        kinds = [opening.kind for wall in plan.walls for opening in wall.openings]
        self.assertEqual(sorted(kinds), ["door", "window"])
        self.assertEqual([piece.kind for piece in plan.furniture], ["bed", "table", "plant"])
        self.assertEqual([room.name for room in plan.rooms], ["kitchen"])
        self.assertEqual([place.name for place in plan.places], ["pickup"])
        self.assertEqual([zone.kind for zone in plan.zones], ["keep_out", "speed"])
        self.assertEqual(plan.start, (2.0, 2.0))
        self.page.wait_for("kitchen: 22.8 m²")
        self.assertEqual(self.page.errors, [])

    def test_furniture_is_moved_turned_scaled_copied_and_removed(self):
        self.open()
        self.choose("sofa")
        self.click((2, 2))
        self.choose("select")
        self.page.drag(self.pixel(2, 2), self.pixel(3, 2.5))
        self.key("r")
        self.write("width", "1.5")
        plan = self.saved(lambda plan: plan.furniture and plan.furniture[0].size[0] == 1.5, "a smaller sofa")
        piece = plan.furniture[0]
        self.assertAlmostEqual(math.hypot(piece.x - 3.0, piece.y - 2.5), 0.0, delta=0.03)
        self.assertAlmostEqual(piece.yaw, math.pi / 12.0, places=3)
        self.key("d", ctrlKey=True)
        self.saved(lambda plan: len(plan.furniture) == 2, "a copy")
        self.key("Delete")
        self.saved(lambda plan: len(plan.furniture) == 1, "one sofa")
        for _ in range(2):
            self.key("z", ctrlKey=True)
        plan = self.saved(lambda plan: len(plan.furniture) == 1, "undone")
        self.key("z", ctrlKey=True, shiftKey=True)
        self.saved(lambda plan: len(plan.furniture) == 2, "redone")

    def test_ends_of_walls_and_doors_are_dragged(self):
        self.open(HomePlan("flat", (Wall((0.0, 0.0), (4.0, 0.0)),), start=(1.0, 1.0)))
        self.choose("door")
        self.click((1, 0))
        self.choose("select")
        self.page.drag(self.pixel(1, 0), self.pixel(2, 0.1))
        plan = self.saved(lambda plan: plan.walls[0].openings[0].at > 1.5, "a moved door")
        self.assertAlmostEqual(plan.walls[0].openings[0].at, 2.0, delta=0.06)
        self.click((3.5, 0))
        self.page.drag(self.pixel(4, 0), self.pixel(5, 0))
        plan = self.saved(lambda plan: plan.walls[0].length > 4.5, "a longer wall")
        self.assertAlmostEqual(plan.walls[0].end[0], 5.0, delta=0.06)

    def test_problems_are_stated_and_marked(self):
        self.open()
        self.draw_two_rooms()
        self.write("width", "7")
        self.page.wait_for("is wider than the wall: 7.00 of 6.00 m")
        self.picture("problem")
        self.assertGreater(self.page.evaluate("document.querySelectorAll('circle.problem.error').length"), 0)
        self.page.evaluate("document.getElementById('build').click()")
        self.page.wait_for("the plan has errors")
        self.assertFalse((self.folder / "home.world").exists())

    def test_nothing_is_lost_when_the_tab_closes(self):
        self.open()
        self.draw_two_rooms()
        self.saved(lambda plan: any(wall.openings for wall in plan.walls), "the door")
        self.page.close()
        self.open()
        self.assertEqual(self.page.evaluate("plan.walls.length"), 5)

    def test_a_template_gets_its_scale_by_two_clicks(self):
        self.open()
        picture = self.folder.parent / "plan.png"
        Image.new("RGB", (400, 300), "lightblue").save(picture)
        self.page.evaluate(
            "template = { data: 'data:,', width: 400, height: 300, x: 0, y: 0, scale: 0.02 }, choose('scale')"
        )
        self.click((1, 1), (3, 1))
        for key in "4.5":
            self.key(key)
        self.key("Enter")
        self.assertAlmostEqual(self.page.evaluate("template.scale"), 0.045, places=3)

    def test_an_edit_of_a_large_plan_shows_at_once(self):
        walls = tuple(
            Wall(
                (2.0 * (number % 20), 2.0 * (number // 20)), (2.0 * (number % 20) + 1.5, 2.0 * (number // 20))
            )
            for number in range(200)
        )
        pieces = tuple(
            FurniturePiece(
                "chair", 4.0 * (number % 10) + 0.7, 2.0 * (number // 10) + 1.0, 0.1, (0.4, 0.4, 0.9)
            )
            for number in range(100)
        )
        self.open(HomePlan("large", walls, pieces, start=(-2.0, -2.0)))
        times = self.page.evaluate(
            "[...Array(30)].map((_, k) => { const start = performance.now();"
            "change(() => { plan.furniture[k].x += 0.05; }); svg.getBoundingClientRect();"
            "return performance.now() - start; }).sort((a, b) => a - b)"
        )
        print(f"an edit of 200 walls and 100 pieces: quickest {times[0]:.1f} ms, median {times[15]:.1f} ms")
        self.assertLess(times[0], 100.0)  # the quickest: others are interrupted by other programs

    def test_a_home_is_drawn_and_its_mission_succeeds_in_five_minutes(self):
        self.open()
        started = time.monotonic()
        actions = [
            lambda: self.choose("wall"),
            *(lambda p=p: self.click(p) for p in ((0, 0), (8, 0), (8, 6), (0, 6), (0, 0), (4, 0), (4, 6))),
            lambda: self.key("Escape"),
            lambda: self.choose("door"),
            lambda: self.click((4, 3)),
            *(
                action
                for kind, where in (("bed", (1.3, 5)), ("table", (6, 4.8)), ("sofa", (6, 0.7)))
                for action in (lambda kind=kind: self.choose(kind), lambda where=where: self.click(where))
            ),
            lambda: self.choose("room"),
            lambda: self.click((1, 1)),
            lambda: self.write("name", "bedroom"),
            lambda: self.choose("room"),
            lambda: self.click((5, 3)),
            lambda: self.write("name", "kitchen"),
            lambda: self.choose("start"),
            lambda: self.click((2, 2)),
        ]
        for action in actions:
            action()
            time.sleep(CLICK_SECONDS)
        self.saved(lambda plan: plan.start == (2.0, 2.0), "the start")
        self.page.evaluate("document.getElementById('try').click()")
        self.page.wait_for("1 of 1 succeeded", seconds=240.0)
        seconds = time.monotonic() - started
        print(f"from an empty page to SUCCESS: {seconds:.0f} s")
        self.picture("success")
        self.assertLess(seconds, MOST_SECONDS)


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "home_editor", HomeEditorTest)
