#!/usr/bin/env python3
"""Follow waypoints, one of which lies in a wall, and print which were missed."""

from home_service import Commander

WAYPOINTS = [(3.0, 0.3, 0.0), (-5.5, 3.8, 0.0), (0.0, 0.0, 3.14)]
IN_THE_BED = 1

robot = Commander("patrol")
if not robot.is_ready(timeout=60.0):
    raise SystemExit(f"error: still waiting for {', '.join(robot.waiting_for)}")
robot.follow_waypoints(WAYPOINTS, timeout=120.0)
outcome = robot.wait()
print(f"{outcome.result.value}: {outcome.reason}; missed: {list(outcome.missed)}", flush=True)
raise SystemExit(0 if list(outcome.missed) == [IN_THE_BED] else 1)
