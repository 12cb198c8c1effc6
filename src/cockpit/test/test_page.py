"""What the page offers and how exactly it draws, with the real server of viser."""

from unittest.mock import Mock

import numpy as np
import pytest

from cockpit.drawing import LayerUpdate, PlacedShape, PointCloudShape
from cockpit.page.drive_panel import NO_NAMESPACE, DrivePanel
from cockpit.page.scene_renderer import SceneRenderer
from cockpit.page.server import Page
from cockpit.page.toolbar import MOVE_CAMERA, MOVE_MODEL, TOOLS, Toolbar
from cockpit.page.window_column import WindowColumn


@pytest.fixture(scope="module")
def page():
    page = Page("127.0.0.1", 0)
    yield page
    page.close()


@pytest.fixture
def panel(page):
    return DrivePanel(page.gui, page.gui.add_folder("Drive"), Mock(), lambda do: do)


def test_a_delivery_starts_and_ends_at_two_places(panel):
    panel.offer(["/"], [], [])
    panel.offer(["/"], [], ["pickup", "dropoff", "kitchen"])
    assert (panel.source.value, panel.destination.value) == ("pickup", "dropoff")
    panel.destination.value = "kitchen"
    panel.offer(["/"], [], ["pickup", "dropoff", "kitchen", "desk"])
    assert (panel.source.value, panel.destination.value) == ("pickup", "kitchen")


def test_a_home_with_one_place_offers_it_twice(panel):
    panel.offer(["/"], [], ["pickup"])
    assert (panel.source.value, panel.destination.value) == ("pickup", "pickup")


def test_robots_are_selected_by_name_if_there_are_several(panel):
    panel.offer(["/"], [], [])
    assert (panel.robot.visible, panel.namespace) == (False, "/")
    panel.offer(["/alice/", "/bob/"], [], [])
    assert (panel.robot.visible, panel.robot.options) == (True, ("alice", "bob"))
    assert panel.namespace == "/alice/"
    panel.robot.value = "bob"
    panel.offer(["/", "/alice/", "/bob/"], [], [])
    assert panel.robot.options == (NO_NAMESPACE, "alice", "bob")
    assert panel.namespace == "/bob/"


def test_the_toolbar_fills_the_button_of_the_selected_tool(page):
    modes = []
    toolbar = Toolbar(page.gui, modes.append, lambda do: do)
    for number, tool in enumerate(TOOLS, 1):
        toolbar.select(tool)
        assert f'data-selected="{number}"' in toolbar.mark.content
    toolbar.select(MOVE_MODEL)
    assert 'data-selected="0"' in toolbar.mark.content
    toolbar.select(MOVE_CAMERA)
    assert modes == [*TOOLS, MOVE_MODEL, MOVE_CAMERA]
    assert toolbar.mode == MOVE_CAMERA


def test_clouds_are_drawn_at_full_precision(page):
    renderer = SceneRenderer(page.scene)
    for shift in (0.0, 0.01):  # the first one is created, the next ones are updated
        points = np.array([[100.0 + shift, -100.013, 0.001]])
        update = LayerUpdate((PlacedShape("cloud", "", PointCloudShape(points, (0, 0, 0))),))
        renderer.show("points", update)
        shown = page.scene.get_handle_by_name("/layers/points/cloud/shape").points
        np.testing.assert_allclose(shown, points, atol=1e-5)


class Panel:
    """A panel of viser, which takes half of the height of the one above it; the others keep theirs."""

    heights = {}

    def dock_right(self):
        self.heights[self] = 1.0

    def dock_below(self, anchor):
        self.heights[self] = self.heights[anchor] = self.heights[anchor] / 2.0

    def remove(self):
        del self.heights[self]

    def share(self):
        return self.heights[self] / sum(self.heights.values())

    add_tab = set_width = Mock()


def test_windows_and_the_main_panel_keep_their_height_while_others_come_and_go():
    main = Panel()
    column = WindowColumn(Mock(main_panel=main, add_panel=Panel))
    first = column.open("first")
    assert (main.share(), first.panel.share()) == (0.5, 0.5)
    for _ in range(10):
        second = column.open("second")
        assert min(main.share(), first.panel.share(), second.panel.share()) >= 0.25
        column.remove(second)
