"""Plugins that violate their contracts."""

import time

import numpy as np

from move_base_lite import Layer, Trajectory
from planar import Twist2


class Faulty:
    """A local planner that stands still."""

    def __init__(self, settings, period):
        self.calls = 0

    def follow(self, context, plan, limits):
        self.calls += 1
        return self.trajectory(context, plan, Twist2())

    def trajectory(self, context, plan, command):
        return Trajectory(command, context.base_in_local.as_array()[None, :], 0.0)


class Raises(Faulty):
    def trajectory(self, context, plan, command):
        raise ZeroDivisionError("division by zero")


class RaisesInConstructor(Faulty):
    def __init__(self, settings, period):
        raise OSError("no weights.npz")


class ReturnsNan(Faulty):
    def trajectory(self, context, plan, command):
        return super().trajectory(context, plan, Twist2(np.nan, 0.0))


class ReturnsNothing(Faulty):
    def trajectory(self, context, plan, command):
        return None


class ExceedsLimits(Faulty):
    def trajectory(self, context, plan, command):
        return super().trajectory(context, plan, Twist2(100.0, 0.0))


class ModifiesCosts(Faulty):
    def trajectory(self, context, plan, command):
        context.costmap.costs[:] = 0
        return super().trajectory(context, plan, command)


class TakesTooLong(Faulty):
    def trajectory(self, context, plan, command):
        if self.calls > 1:
            time.sleep(1.2)
        return super().trajectory(context, plan, command)


class NoFollow:
    def __init__(self, settings, period):
        pass


class TooFewArguments:
    def __init__(self, settings, period):
        pass

    def follow(self, context):
        pass


class WrongSettings(Faulty):
    Settings = dict


class BadPlan:
    def __init__(self, settings):
        pass

    def plan(self, request):
        return np.array([request.start_xy, (np.nan, 0.0)])


class BadRecovery:
    def __init__(self, settings):
        pass

    def step(self, context):
        raise KeyError("no such key")


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
