#!/usr/bin/env python3
"""Start to drive, cancel, turn round, back up, and clear the costmaps."""

import math

import rospy

from home_service import Commander, Result

robot = Commander("change_of_mind")
if not robot.is_ready(timeout=60.0):
    raise SystemExit(f"error: still waiting for {', '.join(robot.waiting_for)}")

robot.go_to(2.0, 3.0)
rospy.sleep(2.0)  # of simulated time
robot.cancel()
outcomes = [robot.wait()]
robot.spin(math.pi)
outcomes.append(robot.wait())
robot.back_up(0.3)
outcomes.append(robot.wait())
robot.clear_costmaps()
here = robot.pose
robot.set_initial_pose(here.x, here.y, here.yaw)
for outcome in outcomes:
    print(f"{outcome.result.value}: {outcome.reason}", flush=True)
expected = [Result.CANCELLED, Result.SUCCEEDED, Result.SUCCEEDED]
raise SystemExit(0 if [outcome.result for outcome in outcomes] == expected else 1)
