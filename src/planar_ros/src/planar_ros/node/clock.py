"""Waiting in ROS time for nodes that a simulation waits for in lock-step."""

from typing import Optional

import rospy

# Interval at which a shutdown is detected.
LONGEST_WAIT_SECONDS = 0.2


def sleep_until(due: rospy.Time, since: Optional[rospy.Time] = None) -> rospy.Time:
    """Wait until ROS time reaches a time.

    Unlike rospy.sleep it handles every clock message and waits for a point in time instead of a duration:
    while the simulation waits for this node, the clock stands still, and a wait that is one step too long
    would never end.

    Args:
        due: Time to wait for.
        since: Earlier reading of the clock, by default now; an earlier time than this is a jump back.

    Returns:
        ROS time at the end.

    Raises:
        rospy.ROSTimeMovedBackwardsException: If time jumps back.
        rospy.ROSInterruptException: On shutdown.
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
