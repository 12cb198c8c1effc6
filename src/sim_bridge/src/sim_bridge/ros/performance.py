"""Performance of the simulation: real-time factor, rates of topics, dropped messages."""

import time
from typing import Callable, Dict, Iterable

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from gazebo_msgs.msg import PerformanceMetrics, SensorPerformanceMetric
from std_msgs.msg import Float64

from sim_bridge.ros.publishers import CountingPublisher

# Time between two reports [wall s].
REPORT_PERIOD = 1.0


class Performance:
    """Publishes ~real_time_factor, /gazebo/performance_metrics and /diagnostics once a wall second."""

    def __init__(self):
        self._factor = rospy.Publisher("~real_time_factor", Float64, queue_size=10)
        self._metrics = rospy.Publisher("/gazebo/performance_metrics", PerformanceMetrics, queue_size=10)
        self._diagnostics = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=10)
        self._wall, self._stamp = time.monotonic(), 0.0
        self._published: Dict[str, int] = {}

    def report(self, stamp: float, publishers_of: Callable[[], Iterable[CountingPublisher]]) -> None:
        """Publish a report if it is due; to be called after each step.

        Args:
            stamp: Simulated time [s].
            publishers_of: Returns all publishers of robots.
        """
        elapsed = time.monotonic() - self._wall
        if elapsed < REPORT_PERIOD:
            return
        simulated = max(stamp - self._stamp, 0.0)
        self._wall, self._stamp = time.monotonic(), stamp
        publishers = list(publishers_of())
        self._factor.publish(simulated / elapsed)
        self._diagnostics.publish(_diagnostics(stamp, simulated / elapsed, publishers))
        message = PerformanceMetrics(real_time_factor=simulated / elapsed)
        message.header.stamp = rospy.Time.from_sec(stamp)
        for publisher in publishers:
            count = publisher.published - self._published.get(publisher.name, 0)
            self._published[publisher.name] = publisher.published
            if publisher.get_num_connections():
                rate = count / simulated if simulated else 0.0
                message.sensors.append(SensorPerformanceMetric(publisher.name, rate, count / elapsed, 0.0))
        self._metrics.publish(message)


def _diagnostics(stamp: float, factor: float, publishers) -> DiagnosticArray:
    lost = {publisher.name: publisher.dropped for publisher in publishers if publisher.dropped}
    status = DiagnosticStatus(
        level=DiagnosticStatus.WARN if lost else DiagnosticStatus.OK,
        name="sim_bridge: simulation",
        message=f"messages lost on {', '.join(sorted(lost))}" if lost else f"{factor:.1f} times real time",
        hardware_id="None",
        values=[
            KeyValue("real_time_factor", f"{factor:.3f}"),
            KeyValue("dropped_messages", str(sum(lost.values()))),
            *(KeyValue(f"dropped {name}", str(count)) for name, count in sorted(lost.items())),
        ],
    )
    message = DiagnosticArray(status=[status])
    message.header.stamp = rospy.Time.from_sec(stamp)
    return message
