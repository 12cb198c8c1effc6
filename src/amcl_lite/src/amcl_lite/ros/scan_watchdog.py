"""Warning when no scans arrive."""

import threading
import time

import rospy

SCAN_TIMEOUT_SECONDS = 15.0
# Wall time between two checks [s]: a timer in ROS time would wake with every clock message.
_CHECK_SECONDS = 1.0


class ScanWatchdog:
    """Warns repeatedly while no scan arrives on ``topic`` for ``SCAN_TIMEOUT_SECONDS``.

    Simulated time may jump, and the next scans arrive a moment later; so a scan since the last check proves
    that they come.
    """

    def __init__(self, topic: str):
        self._topic = topic
        self._last_scan = self._last_warned = self._checked_scan = rospy.Time(0)

    def start(self) -> None:
        self.on_scan()
        threading.Thread(target=self._watch, daemon=True).start()

    def on_scan(self) -> None:
        """Record the arrival of a scan."""
        self._last_scan = self._last_warned = rospy.Time.now()

    def _watch(self):
        while not rospy.is_shutdown():
            time.sleep(_CHECK_SECONDS)
            self.check(rospy.Time.now())

    def check(self, now: rospy.Time) -> None:
        """Warn if no scan has arrived for long."""
        is_silent, self._checked_scan = self._last_scan == self._checked_scan, self._last_scan
        if self._last_warned == rospy.Time(0):  # there was no clock yet
            self.on_scan()
        elif is_silent and (now - self._last_warned).to_sec() > SCAN_TIMEOUT_SECONDS:
            self._last_warned = now
            self._warn((now - self._last_scan).to_sec())

    def _warn(self, silence: float):
        rospy.logwarn(
            "No laser scan received (and thus no pose updates have been published) for %f seconds.  "
            "Verify that data is being published on the %s topic.",
            silence,
            self._topic,
        )
