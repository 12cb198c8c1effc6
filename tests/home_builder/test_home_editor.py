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
from editor_hands import CTRL, SHIFT, EditorHands, draw_home
from PIL import Image, ImageDraw
from waiting import wait_until

from home_builder import FurniturePiece, HomePlan, Opening, Place, Wall, load_plan
from home_builder.editor.server import EditorServer
from home_builder.editor.session import EditorSession

PICTURES = os.environ.get("EDITOR_PICTURES")
# From an empty page to a mission in the new home, at a person's pace of an action in so many seconds.
PACE_SECONDS, MOST_SECONDS = 0.6, 300.0
SOFA = FurniturePiece("sofa", 2.0, 2.0, 0.0, (2.0, 0.9, 0.8))
ROOM = tuple(
    Wall(start, end)
    for start, end in (((0, 0), (6, 0)), ((6, 0), (6, 5)), ((6, 5), (0, 5)), ((0, 5), (0, 0)))
)


class HomeEditorTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp()) / "flat"
        self.addCleanup(shutil.rmtree, self.folder.parent)
        self.browser = Browser()
        self.addCleanup(self.browser.close)

    def open(self, plan=None, pace=0.0):
        server = EditorServer(EditorSession(self.folder, plan))
        thread = threading.Thread(target=server.serve, daemon=True)
        thread.start()
        self.addCleanup(server.close)
        self.url = server.url
        self.page = self.browser.open(server.url, 1400, 860)
        self.page.wait_for("saved in", seconds=60.0)
        self.hands = EditorHands(self.page, pace)
        return self.hands

    def saved(self, condition, what):
        wait_until(what, lambda: condition(load_plan(self.folder / "plan.yaml")), 20.0)
        return load_plan(self.folder / "plan.yaml")

    def picture(self, name):
        if PICTURES:
            self.page.screenshot(Path(PICTURES) / f"{name}.png")

    def draw_two_rooms(self):
        self.hands.choose("wall")
        self.hands.click((0, 0), (8, 0), (8, 6), (0, 6), (0, 0), (4, 0), (4, 6))
        self.hands.key("Escape")
        self.hands.choose("door")
        self.hands.click((4, 3))

    # -- drawing ------------------------------------------------------------------------------------------

    def test_walls_snap_and_have_typed_lengths(self):
        hands = self.open()
        hands.choose("wall")
        hands.click((0.02, 0.01), (5, 0.2))
        hands.key("Escape")
        hands.choose("wall")
        hands.click((5.04, 0.03), (5.1, 3))
        plan = self.saved(lambda plan: len(plan.walls) == 2, "two walls")
        self.assertEqual(plan.walls[0].end, plan.walls[1].start)
        self.assertEqual(plan.walls[0].start, (0.0, 0.0))
        hands.move_to(3, 3)
        for key in "2.5":
            hands.key(key)
        self.picture("typed_length")
        hands.key("Enter")
        plan = self.saved(lambda plan: len(plan.walls) == 3, "a wall of a typed length")
        self.assertAlmostEqual(plan.walls[2].length, 2.5, places=3)

    def test_the_next_walls_have_the_thickness_and_height_that_are_set(self):
        hands = self.open()
        hands.choose("wall")
        hands.write("thickness", "0.24")
        hands.write("height", "3")
        hands.click((0, 0), (3, 0))
        plan = self.saved(lambda plan: plan.walls, "a wall")
        self.assertEqual((plan.walls[0].thickness, plan.walls[0].height), (0.24, 3.0))

    def test_every_tool_leaves_what_was_drawn(self):
        hands = self.open()
        self.draw_two_rooms()
        hands.choose("window")
        hands.click((6, 0))
        for kind, where in (("bed", (1.3, 5)), ("table", (6, 4)), ("plant", (7.4, 5.4))):
            hands.choose(kind)
            hands.click(where)
        hands.choose("room")
        hands.click((1, 1))
        hands.name("kitchen")
        hands.choose("place")
        hands.drag((7, 1.5), (7, 2.5))
        hands.name("pickup")
        hands.choose("start")
        hands.drag((2, 2), (1.0, 2.02))
        for tool in ("keep_out", "speed"):
            hands.choose(tool)
            hands.click((5, 5), (5.5, 5), (5.5, 5.5))
            hands.key("Enter")
        plan = self.saved(lambda plan: len(plan.zones) == 2, "two zones")
        self.page.wait_for("kitchen: 22.8 m²")
        self.picture("all_tools")
        self.assertEqual(len(plan.walls), 5)
        kinds = [opening.kind for wall in plan.walls for opening in wall.openings]
        self.assertEqual(sorted(kinds), ["door", "window"])
        self.assertEqual([piece.kind for piece in plan.furniture], ["bed", "table", "plant"])
        self.assertEqual([room.name for room in plan.rooms], ["kitchen"])
        self.assertEqual([(place.name, round(place.yaw, 3)) for place in plan.places], [("pickup", 1.571)])
        self.assertEqual([zone.kind for zone in plan.zones], ["keep_out", "speed"])
        self.assertEqual(plan.start, (2.0, 2.0))
        self.assertAlmostEqual(abs(plan.start_yaw), math.pi, places=3)
        self.assertEqual(self.page.errors, [])

    def test_a_room_that_has_a_name_gets_no_second_one(self):
        hands = self.open(HomePlan("flat", ROOM, start=(3.0, 1.0)))
        self.page.wait_for("room 1")
        for name, where in (("kitchen", (1, 1)), ("study", (5, 4))):
            hands.choose("room")
            hands.click(where)
            hands.name(name)
            plan = self.saved(lambda plan, name=name: plan.rooms and plan.rooms[0].name == name, name)
        self.assertEqual(len(plan.rooms), 1)

    # -- changing -----------------------------------------------------------------------------------------

    def test_furniture_is_moved_turned_scaled_copied_and_removed(self):
        hands = self.open()
        hands.choose("sofa")
        hands.click((2, 2))
        hands.choose("select")
        hands.drag((2, 2), (3, 2.5))
        hands.key("r")
        hands.write("width", "1.5")
        plan = self.saved(lambda plan: plan.furniture and plan.furniture[0].size[0] == 1.5, "a smaller sofa")
        piece = plan.furniture[0]
        self.assertAlmostEqual(math.hypot(piece.x - 3.0, piece.y - 2.5), 0.0, delta=0.03)
        self.assertAlmostEqual(piece.yaw, math.pi / 12.0, places=3)
        hands.key("d", CTRL)
        self.saved(lambda plan: len(plan.furniture) == 2, "a copy")
        hands.key("Delete")
        self.saved(lambda plan: len(plan.furniture) == 1, "one sofa")
        for _ in range(2):
            hands.key("z", CTRL)
        self.saved(lambda plan: len(plan.furniture) == 1, "undone")
        hands.key("z", CTRL | SHIFT)
        self.saved(lambda plan: len(plan.furniture) == 2, "redone")

    def test_furniture_is_scaled_and_turned_by_its_handles(self):
        hands = self.open(HomePlan("flat", furniture=(SOFA,)))
        hands.click((2, 2))
        hands.drag((3, 2.45), (4, 3.05))
        plan = self.saved(lambda plan: plan.furniture[0].size[0] > 2.5, "a larger sofa")
        piece = plan.furniture[0]
        self.assertAlmostEqual(piece.size[0], 3.0, delta=0.06)
        self.assertAlmostEqual(piece.size[1], 1.5, delta=0.06)
        self.assertAlmostEqual(piece.x - piece.size[0] / 2.0, 1.0, places=3)  # the other corner stays
        self.picture("handles")
        hands.drag((piece.x, piece.y + piece.size[1] / 2.0 + 0.3), (piece.x - 2, piece.y))
        plan = self.saved(lambda plan: plan.furniture[0].yaw, "a turned sofa")
        self.assertAlmostEqual(plan.furniture[0].yaw, math.pi / 2.0, places=3)

    def test_several_items_are_selected_moved_copied_cut_and_pasted(self):
        chair = FurniturePiece("chair", 4.0, 2.0, 0.0, (0.5, 0.5, 0.9))
        hands = self.open(HomePlan("flat", ROOM, (SOFA, chair), start=(3.0, 4.0)))
        hands.click((2, 2))
        hands.click((4, 2), modifiers=SHIFT)
        hands.drag((4, 2), (4, 3))
        plan = self.saved(lambda plan: plan.furniture[0].y > 2.5, "both moved")
        self.assertEqual([piece.y for piece in plan.furniture], [3.0, 3.0])
        hands.key("c", CTRL)
        hands.move_to(3, 1)
        hands.key("v", CTRL)
        plan = self.saved(lambda plan: len(plan.furniture) == 4, "both pasted")
        self.assertEqual([(piece.x, piece.y) for piece in plan.furniture[2:]], [(2.0, 1.0), (4.0, 1.0)])
        hands.key("x", CTRL)
        self.saved(lambda plan: len(plan.furniture) == 2, "both cut")
        hands.click((3, -0.6))
        hands.drag((0.5, 2.4), (5.5, 3.6), modifiers=SHIFT)
        self.assertEqual(self.page.evaluate("selection"), ["furniture/0", "furniture/1"])
        hands.key("a", CTRL)
        self.assertEqual(self.page.evaluate("selection.length"), 6)
        hands.key("Delete")
        self.saved(lambda plan: not plan.walls and not plan.furniture, "an empty plan")
        hands.key("z", CTRL)
        self.saved(lambda plan: len(plan.walls) == 4 and len(plan.furniture) == 2, "all of it again")

    def test_ends_of_walls_and_doors_are_dragged(self):
        hands = self.open(HomePlan("flat", (Wall((0.0, 0.0), (4.0, 0.0)),), start=(1.0, 1.0)))
        hands.choose("door")
        hands.click((1, 0))
        hands.choose("select")
        hands.drag((1, 0), (2, 0.1))
        plan = self.saved(lambda plan: plan.walls[0].openings[0].at > 1.5, "a moved door")
        self.assertAlmostEqual(plan.walls[0].openings[0].at, 2.0, delta=0.06)
        hands.click((3.5, 0))
        hands.drag((4, 0), (5, 0))
        plan = self.saved(lambda plan: plan.walls[0].length > 4.5, "a longer wall")
        self.assertAlmostEqual(plan.walls[0].end[0], 5.0, delta=0.06)

    def test_start_places_and_corners_of_zones_have_handles(self):
        places = (Place("dock", 4.0, 1.0),)
        hands = self.open(HomePlan("flat", ROOM, places=places, start=(2.0, 1.0)))
        hands.click((2, 1))
        hands.drag((2.5, 1), (2, 1.6))
        hands.click((4, 1))
        hands.drag((4.5, 1), (3.5, 1))
        plan = self.saved(lambda plan: plan.places[0].yaw, "a turned dock")
        self.assertAlmostEqual(plan.start_yaw, math.pi / 2.0, places=3)
        self.assertAlmostEqual(abs(plan.places[0].yaw), math.pi, places=3)
        hands.choose("keep_out")
        hands.click((1, 3), (2, 3), (2, 4))
        hands.key("Enter")
        hands.choose("select")
        hands.click((1.8, 3.3))
        hands.drag((2, 4), (3, 4.5))
        plan = self.saved(lambda plan: plan.zones and plan.zones[0].corners[2][0] > 2.5, "a larger zone")
        self.assertEqual(plan.zones[0].corners[2], (3.0, 4.5))

    # -- the template -------------------------------------------------------------------------------------

    def floor_plan(self, name="plan.png", scale=50):
        """A floor plan of two rooms of 4 m by 5 m, with a door, a pixel being 1 / scale m."""
        path = self.folder.parent / name
        image = Image.new("L", (10 * scale, 7 * scale), 255)
        draw = ImageDraw.Draw(image)
        for box in ((0.9, 0.9, 9.1, 1.1), (0.9, 5.9, 9.1, 6.1), (0.9, 0.9, 1.1, 6.1), (8.9, 0.9, 9.1, 6.1)):
            draw.rectangle([each * scale for each in box], fill=0)
        for box in ((4.95, 1, 5.05, 2.5), (4.95, 3.4, 5.05, 6)):
            draw.rectangle([each * scale for each in box], fill=0)
        image.save(path)
        return path

    def test_a_template_gets_its_scale_by_two_clicks_and_is_kept(self):
        hands = self.open()
        hands.upload(self.floor_plan())
        plan = self.saved(lambda plan: plan.template, "the template")
        before = plan.template
        hands.click((1, 1), (3, 1))
        hands.type("4.5")
        plan = self.saved(lambda plan: plan.template.scale != before.scale, "its scale")
        self.assertAlmostEqual(plan.template.scale / before.scale, 4.5 / 2.0, delta=0.02)
        self.assertAlmostEqual(1.0 - plan.template.x, (1.0 - before.x) * 2.25, delta=0.05)  # this point stays
        hands.press_button("move")
        hands.drag((2, 2), (3, 2))
        moved = self.saved(lambda now: now.template.x != plan.template.x, "it is moved").template
        self.assertAlmostEqual(moved.x, plan.template.x + 1.0, delta=0.05)
        self.page.close()
        self.open()
        wait_until("the picture", lambda: self.page.evaluate("document.querySelector('image') !== null"))
        self.assertEqual(self.page.evaluate("plan.template.scale"), moved.scale)
        self.assertEqual(
            self.page.evaluate("fetch('/' + plan.template.file).then(answer => answer.status)"), 200
        )
        self.picture("template")
        self.hands.press_button("clear")
        self.saved(lambda plan: plan.template is None, "it is removed")
        self.hands.key("z", CTRL)
        self.saved(lambda plan: plan.template == moved, "undone")

    def test_walls_are_found_in_a_template(self):
        hands = self.open()
        hands.upload(self.floor_plan())
        plan = self.saved(lambda plan: plan.template, "the template")
        x, y = plan.template.x, plan.template.y
        hands.click((x + 1, y + 1), (x + 9, y + 1))
        hands.type("8")
        hands.press_button("trace")
        self.page.wait_for("found 5 walls")
        plan = self.saved(lambda plan: len(plan.walls) == 5, "the walls")
        self.picture("found_walls")
        doors = [opening.width for wall in plan.walls for opening in wall.openings]
        self.assertEqual([round(width, 1) for width in doors], [0.9])
        self.page.wait_for("room 2")

    def test_what_is_no_template_is_stated_on_the_page(self):
        hands = self.open()
        letter = self.folder.parent / "letter.png"
        letter.write_text("dear")
        for path, complaint in (
            (letter, "the template is not a readable picture (unknown format)"),
            (self.huge(), "the template has 20000 x 10000 pixels, more than 60 million"),
        ):
            hands.upload(path)
            self.page.wait_for(complaint)
        hands.press_button("scale")
        self.page.wait_for("choose a picture first")
        hands.upload(self.floor_plan())
        self.page.wait_for("Click two points of the template")
        hands.click((1, 1), (3, 1))
        hands.type("0")
        self.page.wait_for("type a length above 0 m")

    def huge(self):
        path = self.folder.parent / "huge.png"
        Image.new("1", (20_000, 10_000), 1).save(path)
        return path

    # -- saving and running -------------------------------------------------------------------------------

    def test_problems_are_stated_and_marked(self):
        hands = self.open()
        self.draw_two_rooms()
        hands.write("width", "7")
        self.page.wait_for("is wider than the wall: 7.00 of 6.00 m")
        self.picture("problem")
        marks = self.page.evaluate("document.querySelectorAll('circle.problem.error').length")
        self.assertGreater(marks, 0)
        hands.press_button("build")
        self.page.wait_for("the plan has errors")
        self.assertFalse((self.folder / "home.world").exists())

    def test_nothing_is_lost_when_the_tab_closes(self):
        self.open()
        self.draw_two_rooms()
        self.saved(lambda plan: any(wall.openings for wall in plan.walls), "the door")
        self.page.close()
        self.open()
        self.assertEqual(self.page.evaluate("plan.walls.length"), 5)

    def test_nothing_is_lost_when_two_tabs_draw_the_same_home(self):
        hands = self.open()
        other = EditorHands(self.browser.open(self.url, 1400, 860))
        other.page.wait_for("saved in", seconds=60.0)
        hands.choose("bed")
        hands.click((2, 2))
        self.saved(lambda plan: len(plan.furniture) == 1, "the bed")
        other.choose("sofa")
        other.click((5, 5))
        other.page.wait_for("was changed elsewhere", "reload the page")
        kinds = [
            [piece.kind for piece in load_plan(self.folder / name).furniture]
            for name in ("plan.yaml", "plan_refused.yaml")
        ]
        self.assertEqual(kinds, [["bed"], ["sofa"]])

    def test_a_home_is_drawn_and_its_mission_succeeds_in_five_minutes(self):
        hands = self.open(pace=PACE_SECONDS)
        started = time.monotonic()
        for _ in draw_home(hands):
            pass
        hands.press_button("try")
        self.page.wait_for("1 of 1 succeeded", seconds=240.0)
        seconds = time.monotonic() - started
        print(f"from an empty page to SUCCESS: {seconds:.0f} s")
        self.picture("success")
        self.assertLess(seconds, MOST_SECONDS)

    def test_the_robot_is_driven_in_the_home_that_is_drawn(self):
        door = Opening("door", 2.5, 0.9)
        walls = (*ROOM, Wall((3.0, 0.0), (3.0, 5.0), openings=(door,)))
        hands = self.open(HomePlan("flat", walls, start=(1.0, 1.0)))
        hands.press_button("drive")
        self.page.wait_for("Open the robot's page", seconds=120.0)
        url = self.page.evaluate("document.querySelector('#link a').href")
        cockpit = self.browser.open(url, 1400, 860)
        cockpit.wait_for("Drive", "/scan", "/map", seconds=120.0)
        cockpit.click("Home")
        cockpit.wait_for("Edit the home")
        wait_until("its folder", lambda: str(cockpit.value_of("Folder")).endswith("flat"), 30.0)


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "home_editor", HomeEditorTest)
