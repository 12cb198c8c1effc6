"""Warns when scans stay away."""

import rospy

SCAN_ALARM_SECONDS = 15.0


class ScanAlarm:
    """Says so, again and again, while no scan has come on ``topic`` for ``SCAN_ALARM_SECONDS``."""

    def __init__(self, topic: str):
        self._topic = topic
        self._last_scan = rospy.Time(0)

    def start(self) -> None:
        rospy.Timer(rospy.Duration(SCAN_ALARM_SECONDS), self._check, reset=True)  # time may jump back

    def hear(self) -> None:
        """A scan has come."""
        self._last_scan = rospy.Time.now()

    def _check(self, event):
        silence = (rospy.Time.now() - self._last_scan).to_sec()
        if silence > SCAN_ALARM_SECONDS:
            rospy.logwarn(
                "No laser scan received (and thus no pose updates have been published) for %f seconds.  "
                "Verify that data is being published on the %s topic.",
                silence,
                self._topic,
            )
