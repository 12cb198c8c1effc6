#!/usr/bin/env python3
"""A changed control keeps its value when the old value is published at the same time."""

import math
import unittest
from contextlib import nullcontext
from types import SimpleNamespace
from unittest.mock import patch

import rostest
from dynamic_reconfigure.msg import Config, ConfigDescription, DoubleParameter, Group, ParamDescription
from home_service_msgs.msg import Playback
from home_service_msgs.srv import SeekResponse
from waiting import wait_until

from cockpit.ros.tools.reconfigure import DESCRIPTION_TYPE, ReconfigureTool
from cockpit.ros.tools.replay import ReplayTool

TOPICS = {"/base/parameter_descriptions": DESCRIPTION_TYPE}


class RequestsTest(unittest.TestCase):
    def test_a_new_position_is_sent_although_the_player_publishes_the_old_one(self):
        feed = TopicFeed(Playback(position=0.3, length=60.0, is_paused=True))
        context = ToolContext({"/player/playback": "home_service_msgs/Playback"}, [feed])
        with patch("cockpit.ros.tools.replay.call") as called:
            called.return_value = SeekResponse(success=True)
            replay = ReplayTool(context)
            replay.build()
            replay.update(0.0)
            slider = context.gui.made["Time, s"]
            self.assertEqual(slider.value, 0.3)
            slider.value = 45.0
            feed.unread.append(Playback(position=0.4, length=60.0, is_paused=True))
            replay.update(0.1)
            slider.notify()
            replay.update(0.2)
            wait_until("a call", lambda: called.called, 5.0)
        self.assertEqual([each[0][0::2] for each in called.call_args_list], [("/player/seek", 45.0)])

    def test_a_changed_parameter_is_sent_although_the_server_publishes_the_old_value(self):
        updates = TopicFeed()
        context = ToolContext(TOPICS, [TopicFeed(described(1.5)), updates])
        with patch("cockpit.ros.tools.reconfigure.call") as called:
            called.return_value = SimpleNamespace(config=speed(1.5))
            tool = ReconfigureTool(context)
            tool.build()
            context.gui.made["Server"].value = "/base"
            tool.update(0.0)
            slider = context.gui.made["speed"]
            slider.value = 2.0
            updates.unread.append(speed(0.5))
            tool.update(0.2)
            slider.notify()
            tool.update(0.4)
            wait_until("a call", lambda: called.called, 5.0)
            self.assertEqual(called.call_args[0][2], speed(2.0))
            wait_until("the answer", lambda: tool.update(0.6) or slider.value == 1.5, 5.0)
        self.assertEqual(called.call_count, 1)

    def test_a_nan_parameter_is_not_sent(self):
        updates = TopicFeed(speed(math.nan))
        context = ToolContext(TOPICS, [TopicFeed(described(1.5)), updates])
        with patch("cockpit.ros.tools.reconfigure.call") as called:
            tool = ReconfigureTool(context)
            tool.build()
            context.gui.made["Server"].value = "/base"
            for now in (0.0, 0.2):
                tool.update(now)
            self.assertTrue(math.isnan(context.gui.made["speed"].value))
            updates.unread.append(speed(1.0))
            tool.update(0.4)
        self.assertEqual((context.gui.made["speed"].value, called.called), (1.0, False))


def speed(value):
    return Config(doubles=[DoubleParameter("speed", value)])


def described(highest):
    parameters = [ParamDescription("speed", "double", 0, "", "")]
    groups = [Group(name="Default", parameters=parameters)]
    return ConfigDescription(groups=groups, max=speed(highest), min=speed(0.0), dflt=speed(0.5))


class TopicFeed:
    def __init__(self, *messages):
        self.unread = list(messages)

    def messages(self):
        unread, self.unread = self.unread, []
        return unread

    def close(self):
        pass


class ToolContext:
    """A page without a browser, a graph without nodes."""

    def __init__(self, topics, feeds):
        feeds = iter(feeds)
        self.graph = SimpleNamespace(topics=lambda: topics, feed=lambda *_: next(feeds))
        self.gui = Gui()
        self.guarded = lambda do: do


class Gui:
    def __init__(self):
        self.made = {}

    def add_folder(self, _title):
        return nullcontext()

    def __getattr__(self, _name):
        return self._add

    def _add(self, label, *values, initial_value=None, **_):
        numbers = [value for value in values if isinstance(value, float)]
        self.made[label] = Handle(initial_value if initial_value is not None else (numbers or [None])[-1])
        return self.made[label]


class Handle:
    """``notify`` is the callback of viser, which comes after the change of the value."""

    def __init__(self, value):
        self.value, self.options, self.max, self.content = value, ("(none)",), 1.0, ""
        self._on_update = []

    def on_update(self, do):
        self._on_update.append(do)

    on_click = on_update

    def notify(self):
        for do in self._on_update:
            do(SimpleNamespace(client=self))


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "requests", RequestsTest)
