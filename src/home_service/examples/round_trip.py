#!/usr/bin/env python3
"""Drive to a place and back, printing the remaining distance."""

import time

from home_service import Commander

PLACE, START = (2.0, 3.0, 0.0), (0.0, 0.0, 0.0)

robot = Commander("round_trip")
if not robot.is_ready(timeout=60.0):
    raise SystemExit(f"error: still waiting for {', '.join(robot.waiting_for)}")
for pose in (PLACE, START):
    robot.go_to(*pose)
    while not robot.is_done():
        feedback = robot.feedback()
        if feedback.left is not None:
            print(f"{feedback.left:.1f} m to go after {feedback.seconds:.0f} s", flush=True)
        time.sleep(1.0)
    outcome = robot.outcome()
    print(f"{pose}: {outcome.result.value}: {outcome.reason}", flush=True)
    if not outcome.success:
        raise SystemExit(1)
