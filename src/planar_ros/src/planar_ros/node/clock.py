"""Waiting in ROS time, for nodes that a simulation in lock-step waits for in turn."""

from typing import Optional

import rospy

# So that a shutdown is noticed at once.
LONGEST_WAIT_SECONDS = 0.2


def sleep_until(due: rospy.Time, since: Optional[rospy.Time] = None) -> rospy.Time:
    """Waits until ROS time has come to ``due``; returns the time then.

    ``since``: a time that has been, by default now; an earlier one is a jump back.

    Unlike rospy.sleep it misses no message of the clock, and waits for a point in time, not for a span: when
    the simulation waits for this node, the clock stands still, and one step too many would never come.
    Raises ROSTimeMovedBackwardsException and ROSInterruptException as rospy.sleep does.
    """
    if rospy.rostime.is_wallclock():
        rospy.sleep(due - rospy.Time.now())
        return rospy.Time.now()
    changed, start = rospy.rostime.get_rostime_cond(), rospy.Time.now() if since is None else since
    with changed:
        while True:
            now = rospy.Time.now()
            if now < start:
                raise rospy.ROSTimeMovedBackwardsException((start - now).to_sec())
            if now >= due and now != rospy.Time(0):
                return now
            if rospy.is_shutdown():
                raise rospy.ROSInterruptException("shutdown while waiting for the clock")
            changed.wait(LONGEST_WAIT_SECONDS)
