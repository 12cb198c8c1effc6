"""Plugins that do what plugins must not."""

import time

import numpy as np

from move_base_lite import ControllerSettings, Layer, Trajectory
from planar import Twist2


class Faulty:
    """A local planner that stands still."""

    def __init__(self, settings, period):
        self.calls = 0

    def follow(self, context, plan, limits):
        self.calls += 1
        return self.answer(context, plan, Twist2())

    def answer(self, context, plan, command):
        return Trajectory(command, context.base_in_local.as_array()[None, :], 0.0)


class Raises(Faulty):
    def answer(self, context, plan, command):
        raise ZeroDivisionError("division by zero")


class RaisesWhenMade(Faulty):
    def __init__(self, settings, period):
        raise OSError("no weights.npz")


class AnswersNan(Faulty):
    def answer(self, context, plan, command):
        return super().answer(context, plan, Twist2(np.nan, 0.0))


class AnswersNothing(Faulty):
    def answer(self, context, plan, command):
        return None


class Rushes(Faulty):
    def answer(self, context, plan, command):
        return super().answer(context, plan, Twist2(100.0, 0.0))


class Scribbles(Faulty):
    def answer(self, context, plan, command):
        context.costmap.costs[:] = 0
        return super().answer(context, plan, command)


class Dawdles(Faulty):
    def answer(self, context, plan, command):
        if self.calls > 1:
            time.sleep(1.2)
        return super().answer(context, plan, command)


class NoFollow:
    def __init__(self, settings, period):
        pass


class FollowsLess:
    def __init__(self, settings, period):
        pass

    def follow(self, context):
        pass


class StrangeSettings(Faulty):
    Settings = dict


class OwnSettings(Faulty):
    Settings = ControllerSettings


class BadPlan:
    def __init__(self, settings):
        pass

    def plan(self, costs, window, start_xy, goal_xy, tolerance=0.0):
        return np.array([start_xy, (np.nan, 0.0)])


class BadRecovery:
    def __init__(self, settings):
        pass

    def step(self, context):
        raise KeyError("no such thing")


class BadLayer(Layer):
    def __init__(self, settings, site):
        self._updates = 0

    def update(self, placement):
        self._updates += 1
        if self._updates > 20:
            raise IndexError("index 400 is out of bounds")
        return super().update(placement)

    def apply(self, costs, window, bounds):
        pass
