"""Warns when scans stay away."""

import threading
import time

import rospy

SCAN_ALARM_SECONDS = 15.0
# Wall seconds between two looks: a timer of ROS time would wake with every message of the clock.
_LOOK_SECONDS = 1.0


class ScanAlarm:
    """Says so, again and again, while no scan has come on ``topic`` for ``SCAN_ALARM_SECONDS``."""

    def __init__(self, topic: str):
        self._topic = topic
        self._last_scan = self._last_told = rospy.Time(0)

    def start(self) -> None:
        self.hear()
        threading.Thread(target=self._watch, daemon=True).start()

    def hear(self) -> None:
        """A scan has come."""
        self._last_scan = self._last_told = rospy.Time.now()

    def _watch(self):
        while not rospy.is_shutdown():
            time.sleep(_LOOK_SECONDS)
            now = rospy.Time.now()
            if self._last_told == rospy.Time(0):  # there was no clock yet
                self.hear()
            elif (now - self._last_told).to_sec() > SCAN_ALARM_SECONDS:
                self._last_told = now
                self._tell((now - self._last_scan).to_sec())

    def _tell(self, silence: float):
        rospy.logwarn(
            "No laser scan received (and thus no pose updates have been published) for %f seconds.  "
            "Verify that data is being published on the %s topic.",
            silence,
            self._topic,
        )
